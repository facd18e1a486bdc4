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

// The lines under a message, "wrong", about the word `bad` after `before`.
std::string shown(const std::string& before, const std::string& bad) {
    Diagnostic diagnostic = error_at({"x", 1, before.size() + 1, bad.size()}, "wrong");
    quote_line(diagnostic, before + bad + " after");
    return to_string(diagnostic)
        .substr(std::string("x:1:1: error: wrong").size() + std::to_string(before.size() + 1).size() - 1);
}

TEST(Messages, TheCaretCountsTheColumnsThatCharactersTake) {
    EXPECT_EQ(shown("\u7d20\u6750 ", "bad"), "\n  \u7d20\u6750 bad after\n       ^~~");           // two columns each
    EXPECT_EQ(shown("\uff21\ud55c ", "bad"), "\n  \uff21\ud55c bad after\n       ^~~");           // full width, Hangul
    EXPECT_EQ(shown("e\u0301\u0323 ", "bad"), "\n  e\u0301\u0323 bad after\n    ^~~");            // two marks on one e
    EXPECT_EQ(shown("\u0e17\u0e35\u0e48 ", "bad"), "\n  \u0e17\u0e35\u0e48 bad after\n    ^~~");  // Thai
    EXPECT_EQ(shown("\U0001F4A1\t\u7d20 ", "bad"), "\n  \U0001F4A1\t\u7d20 bad after\n    \t   ^~~");
    EXPECT_EQ(shown("a ", "\u7d20\u6750"), "\n  a \u7d20\u6750 after\n    ^~~~");          // waves under the whole word
    EXPECT_EQ(shown("\u00e9 ", "\uff76\uff9e"), "\n  \u00e9 \uff76\uff9e after\n    ^~");  // half width
    EXPECT_EQ(shown("a", "\u0301"), "\n  a\u0301 after\n   ^");  // there is a caret under a mark, too
}

}  // namespace
}  // namespace raywalk
