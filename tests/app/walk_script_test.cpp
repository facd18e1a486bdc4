#include "app/walk/walk_script.h"

#include <gtest/gtest.h>

#include "tracer/ground/error.h"

namespace raywalk {
namespace {

using enum WalkKey;

std::string script_error(std::string_view text) {
    try {
        parse_walk_script(text, "--keys");
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(WalkScript, ReadsEveryKey) {
    EXPECT_EQ(parse_walk_script("wsadUDLRt[]q", ""),
              (WalkScript{forward, back, left, right, turn_up, turn_down, turn_left, turn_right, toggle, darker,
                          brighter, quit}));
}

TEST(WalkScript, CountsStandBeforeKeysAndBlanksAnywhere) {
    EXPECT_EQ(parse_walk_script(" 3w 2 L\td\n", ""),
              (WalkScript{forward, forward, forward, turn_left, turn_left, right}));
    EXPECT_EQ(parse_walk_script("2] [", ""), (WalkScript{brighter, brighter, darker}));
    EXPECT_EQ(parse_walk_script("12w", "").size(), 12u);
    EXPECT_EQ(parse_walk_script("007w", "").size(), 7u);
    EXPECT_TRUE(parse_walk_script("", "").empty());
    EXPECT_TRUE(parse_walk_script("  ", "").empty());
}

TEST(WalkScript, MistakesNameThePlaceUnderACaret) {
    EXPECT_EQ(
        script_error("w x"),
        "--keys:1:3: error: unknown key 'x'\n  w x\n    ^ expected w s a d (move), U D L R (turn), t (projection), "
        "[ ] (darker, brighter) or q (quit), each with a count before it or without");
    EXPECT_EQ(script_error("3w 2W"), "--keys:1:5: error: unknown key 'W'\n  3w 2W\n      ^ did you mean 'w'?");
    EXPECT_EQ(script_error("u"), "--keys:1:1: error: unknown key 'u'\n  u\n  ^ did you mean 'U'?");
    EXPECT_NE(script_error("w 12").find("--keys:1:3: error: a count without a key after it"), std::string::npos);
    EXPECT_NE(script_error("0w").find("a count of 0"), std::string::npos);
    EXPECT_NE(script_error("3{").find("unknown key '{'"), std::string::npos);
    EXPECT_NE(script_error("-3w").find("unknown key '-'"), std::string::npos);
    EXPECT_NE(script_error("w↑").find("unknown key '↑'"), std::string::npos);
}

TEST(WalkScript, CountsHaveALimitThatNoSumPasses) {
    EXPECT_EQ(parse_walk_script("1000000w", "").size(), walk_script_presses);
    for (const char* text : {"1000001w", "99999999999999999999999999w", "1000000w w", "999999w 2d"})
        EXPECT_NE(script_error(text).find("more than 1000000 presses"), std::string::npos) << text;
}

}  // namespace
}  // namespace raywalk
