#include "tracer/files/scene_text/lexer.h"

#include <algorithm>

#include "tracer/files/blank.h"
#include "tracer/ground/utf8.h"

namespace raywalk {

namespace {

// Splits line.text into line.words.
void split(SceneLine& line) {
    line.words.clear();
    line.open_quote = false;
    const std::string_view text = line.text;
    std::size_t i = 0;
    while (line.words.size() < most_words) {
        while (i < text.size() && is_blank(text[i])) ++i;
        if (i == text.size()) return;
        const std::size_t begin = i;
        if (text[i] == '"') {
            const std::size_t close = text.find('"', begin + 1);
            line.open_quote = close == std::string_view::npos;
            const std::size_t end = line.open_quote ? text.size() : close;
            i = line.open_quote ? end : end + 1;
            line.words.push_back({text.substr(begin + 1, end - begin - 1), begin + 1, i - begin, true});
        } else {
            while (i < text.size() && !is_blank(text[i])) ++i;
            line.words.push_back({text.substr(begin, i - begin), begin + 1, i - begin, false});
        }
    }
}

}  // namespace

SceneLexer::SceneLexer(std::string_view text) : rest_(text) {}

bool SceneLexer::next(SceneLine& line) {
    while (!rest_.empty()) {
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        line.text = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        line.number = ++number_;
        if (line.number == 1 && line.text.starts_with(byte_order_mark)) line.text.remove_prefix(byte_order_mark.size());
        while (!line.text.empty() && is_blank(line.text.back())) line.text.remove_suffix(1);
        const std::size_t first = line.text.find_first_not_of(" \t\r");
        if (first == std::string_view::npos || line.text[first] == '#') continue;
        split(line);
        return true;
    }
    return false;
}

std::size_t first_foreign_byte(std::string_view text) {
    std::size_t i = 0;
    while (i < text.size()) {
        const auto byte = static_cast<unsigned char>(text[i]);
        if (byte >= 0x20 && byte < 0x7F) {
            ++i;
            continue;
        }
        const std::size_t length = utf8_length(text.substr(i));
        const bool control = byte == 0x7F || (byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r');
        if (length == 0 || control) return i;
        i += length;
    }
    return std::string_view::npos;
}

}  // namespace raywalk
