#include "tracer/files/mesh/obj_words.h"

#include <algorithm>
#include <iterator>

#include "tracer/files/decimal.h"

namespace raywalk {

namespace {

constexpr std::string_view number_words[] = {
    "l",    "p",    "vp", "fo",  "cstype", "deg",   "bmat",  "step", "curv", "curv2", "surf", "parm", "trim",
    "hole", "scrv", "sp", "end", "con",    "ctech", "stech", "cdp",  "cdc",  "res",   "bsp",  "bzp",
};
constexpr std::string_view name_words[] = {
    "g",   "o",        "s",        "usemtl", "mtllib", "mg",     "bevel",     "lod",
    "csh", "c_interp", "d_interp", "call",   "usemap", "maplib", "trace_obj", "shadow_obj",
};

template <std::size_t count>
bool is_among(const std::string_view (&words)[count], std::string_view word) {
    return std::ranges::find(words, word) != std::end(words);
}

}  // namespace

bool is_number_statement(std::string_view word) { return is_among(number_words, word); }
bool is_name_statement(std::string_view word) { return is_among(name_words, word); }

std::string_view value_at(const char* at) {
    const char* stop = at;
    const auto starts_comment = [&] { return *stop == '#' && (stop == at || is_digit(stop[-1]) || stop[-1] == '/'); };
    while (!ends_word(*stop) && *stop != '\\' && !starts_comment()) ++stop;
    return {at, static_cast<std::size_t>(stop - at)};
}

WrittenIndex read_index(std::string_view text) {
    WrittenIndex index;
    const std::size_t sign = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
    index.negative = sign == 1 && text[0] == '-';
    std::size_t at = sign;
    for (; at < text.size() && is_digit(text[at]); ++at)
        index.value = index.value * 10 + static_cast<std::uint64_t>(text[at] - '0');
    if (at - sign > 19) index.value = ~std::uint64_t{0};  // it may have wrapped around
    if (at > sign) index.length = at;
    return index;
}

void unify_line_ends(char* text, std::size_t size) {
    for (std::size_t i = 0; i < size;) {
        if (text[i] != '\r') {
            ++i;
            continue;
        }
        std::size_t end = i;
        while (end < size && text[end] == '\r') ++end;
        if (text[end] != '\n') std::fill(text + i, text + end, '\n');
        i = end;
    }
}

}  // namespace raywalk
