#include <string>

#include "app/command_line/option_table.h"

namespace raywalk {

namespace {

constexpr std::size_t columns = 80, help_column = 26;

constexpr std::string_view usage =
    R"(raywalk: walk through a ray-traced scene, or render it

usage:
  raywalk SCENE                 walk through the scene in a window
  raywalk SCENE -render OUT     render a picture, write it to the file OUT

the walk:
  W S A D        a small step forward, back, left, right (hold to go on)
  arrow keys     turn up, down, left, right (hold to go on)
  T              orthographic or perspective projection
  [ ]            darker, brighter
  Q, Escape      quit
)";

constexpr std::string_view ending = R"(
examples:
  raywalk scenes/cornell_box.scene
  raywalk scenes/cornell_box.scene -render box.png
  raywalk scenes/cornell_box.scene -render box.exr --size 1920x1080 --spp 64
  raywalk scenes/cornell_box.scene -render left.png --keys '8w 5L'
  raywalk scenes/cornell_box.scene --capture end.png --keys '8w 5L' \
          --frames 'walk-%04d.png'

exit codes: 0 done, 1 failed, 2 wrong command line, 3 wrong scene, mesh or
image, 4 no display or no Vulkan device to walk with, 130 interrupted (the part
of the picture that was ready is saved)
)";

struct Heading {
    OptionGroup group;
    std::string_view title;
};
constexpr Heading headings[] = {
    {OptionGroup::mode, "what to do"},
    {OptionGroup::picture, "the picture"},
    {OptionGroup::walking, "walking by script"},
    {OptionGroup::output, "messages"},
    {OptionGroup::speed, "speed"},
    {OptionGroup::limits, "limits, against hostile scenes"},
};

// `text` in lines that start at help_column and end before `columns`; the first goes on after `left`.
std::string two_columns(std::string left, std::string_view text) {
    std::string result;
    std::string line = std::move(left);
    if (line.size() + 2 > help_column) {
        result = line + "\n";
        line.clear();
    }
    line.resize(help_column, ' ');
    bool empty = true;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(' '), text.size());
        if (!empty && line.size() + 1 + end > columns) {
            result += line + "\n";
            line.assign(help_column, ' ');
            empty = true;
        }
        if (!empty) line += ' ';
        line += text.substr(0, end);
        empty = false;
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return result + line + "\n";
}

}  // namespace

std::string help_text() {
    std::string text(usage);
    for (const Heading& heading : headings) {
        text += "\n" + std::string(heading.title) + ":\n";
        for (const OptionSpec& option : option_table()) {
            if (option.group != heading.group) continue;
            std::string left = "  ";
            if (!option.short_name.empty()) left += std::string(option.short_name) + ", ";
            left += option.name;
            if (!option.value.empty()) left += " " + std::string(option.value);
            text += two_columns(std::move(left), option.help);
        }
    }
    return text + std::string(ending);
}

}  // namespace raywalk
