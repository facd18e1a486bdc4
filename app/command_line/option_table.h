// Every option of the command line, once: what parses it and what --help says of it.
#pragma once

#include <span>
#include <string_view>

#include "app/command_line/options.h"

namespace raywalk {

enum class OptionGroup { mode, picture, walking, speed, limits, output };

// What the command line alone decides, until it is read whole.
struct CommandLine {
    Options options;
    bool help = false, version = false;
    bool travel = false, render = false, capture = false, check = false;
    bool accelerator_given = false, kd_option_given = false;
    bool quiet = false, verbose = false;
};

struct OptionSpec {
    std::string_view name;        // "--size"
    std::string_view short_name;  // "-q", may be empty
    std::string_view value;       // "WxH" as help shows it; empty for a switch
    OptionGroup group;
    std::string_view help;
    // Takes the value (empty for a switch). Throws UsageError.
    void (*apply)(CommandLine& line, const std::string& value);
    bool repeatable = false;
};

std::span<const OptionSpec> option_table();

// "usage: ...", all options, keys, examples; at most 80 columns.
std::string help_text();

}  // namespace raywalk
