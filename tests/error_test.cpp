#include "tracer/ground/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace raywalk {
namespace {

using testing::HasSubstr;

// Escape, bell, C1 control (as UTF-8 and as a bare byte), right-to-left override, isolate, line separator.
const std::vector<std::string> hostile_words = {"\x1b[2J",
                                                "\a",
                                                "\xC2\x9B"
                                                "2J",
                                                "\x9B"
                                                "2J",
                                                "\xE2\x80\xAE"
                                                "x",
                                                "\xE2\x81\xA6"
                                                "x",
                                                "\xE2\x80\xA8",
                                                "\xD8\x9C"};

TEST(Messages, NothingOfAnInputSteersTheTerminal) {
    for (const std::string& word : hostile_words) {
        Diagnostic diagnostic = error_at({word, 1, 1, word.size()}, "unknown " + word, "did you mean " + word);
        quote_line(diagnostic, word);
        const std::string text = to_string(diagnostic);
        EXPECT_EQ(text.find(word), std::string::npos) << text;
        EXPECT_EQ(std::ranges::count(text, '\n'), 2) << text;
        for (const char c : text) EXPECT_TRUE(c == '\n' || (c >= 0x20 && c < 0x7F)) << static_cast<int>(c);
        EXPECT_EQ(raywalk::quoted(word), quoted_name(word));
        EXPECT_EQ(raywalk::quoted(word).find(word), std::string::npos);
    }
}

TEST(Messages, ANameIsShownWholeAndOnOneLine) {
    const std::string name(300, 'a');
    EXPECT_EQ(quoted_name(name), "'" + name + "'");
    EXPECT_EQ(quoted_name("a\nraywalk: error: b"), "'a?raywalk: error: b'");
}

TEST(Messages, TheCaretStandsUnderTheWordWhateverStandsBeforeIt) {
    for (std::string before : hostile_words) {
        before += "\xC3\xA9 ";  // two bytes, one column
        Diagnostic diagnostic = error_at({"x", 1, before.size() + 1, 3}, "wrong");
        quote_line(diagnostic, before + "bad");
        const std::string text = to_string(diagnostic);
        const std::size_t line = text.find("\n  ") + 3, caret = text.find("\n  ", line) + 3;
        const std::size_t accent = text.find("\xC3\xA9", line);
        EXPECT_EQ(text.find("bad", line) - line - 1, text.find("^~~", caret) - caret) << text << accent;
    }
}

}  // namespace
}  // namespace raywalk
