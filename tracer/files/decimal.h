// Decimal numbers of a text, eight digits at a time: one 64-bit word holds eight characters, of which the first in
// memory is the lowest byte (x86). At least 32 characters that are no digits must follow the text in memory.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace raywalk {

inline constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

inline std::uint64_t eight_characters(const char* p) {
    std::uint64_t characters;
    std::memcpy(&characters, p, sizeof characters);
    return characters;
}

// How many of eight characters are digits, up to the first that is none. Only bytes above that one may be misjudged,
// by a carry out of it.
inline int leading_digits(std::uint64_t characters) {
    const std::uint64_t others = (characters + 0x4646464646464646) | (characters - 0x3030303030303030);
    return std::countr_zero(others & 0x8080808080808080) / 8;
}

// The number that the first `count` (1 to 8) of eight characters write: pairs, then fours, then all of them at once
// (Lemire, "Quickly parsing eight digits", 2018).
inline std::uint64_t number_of_digits(std::uint64_t characters, int count) {
    characters = (characters << (64 - 8 * count)) & 0x0F0F0F0F0F0F0F0F;
    const std::uint64_t pairs = characters * 10 + (characters >> 8);
    constexpr std::uint64_t even = 0x000000FF000000FF;
    return ((pairs & even) * (100 + (1'000'000ull << 32)) + ((pairs >> 16) & even) * (1 + (10'000ull << 32))) >> 32;
}

// The whole number of 1 to 7 digits at p, and where it ends; nullptr if another count of digits stands there.
inline const char* read_short_whole(const char* p, std::uint32_t& value) {
    const std::uint64_t characters = eight_characters(p);
    const int count = leading_digits(characters);
    if (count == 0 || count == 8) return nullptr;
    value = static_cast<std::uint32_t>(number_of_digits(characters, count));
    return p + count;
}

inline constexpr std::uint64_t whole_power_of_ten[] = {1,       10,        100,        1'000,      10'000,
                                                       100'000, 1'000'000, 10'000'000, 100'000'000};
// All that double precision holds exactly.
inline constexpr double power_of_ten[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                          1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

// The float or double nearest to the number at p, [+-]digits[.digits][e[+-]digits], and where it ends. nullptr if there
// is none, or if it has so many digits, or so large an exponent, or lies so near the middle of two floats that only
// more precision can tell (fast_float has it).
template <class Real>
inline const char* read_decimal(const char* p, Real& value) {
    const bool negative = *p == '-';
    p += negative || *p == '+';

    std::uint64_t characters = eight_characters(p);
    const int whole = leading_digits(characters);
    if (whole == 8) return nullptr;
    std::uint64_t digits = whole == 0 ? 0 : number_of_digits(characters, whole);
    p += whole;
    int decimals = 0;
    if (*p == '.') {
        ++p;
        while (is_digit(*p)) {
            characters = eight_characters(p);
            const int count = leading_digits(characters);
            decimals += count;
            if (whole + decimals > 18) return nullptr;  // more than 63 bits hold
            digits = digits * whole_power_of_ten[count] + number_of_digits(characters, count);
            p += count;
        }
    }
    if (whole + decimals == 0) return nullptr;

    int exponent = -decimals;
    if (*p == 'e' || *p == 'E') {
        ++p;
        const bool down = *p == '-';
        p += down || *p == '+';
        std::uint32_t written = 0;
        p = read_short_whole(p, written);
        if (p == nullptr || written > 99) return nullptr;
        exponent += down ? -static_cast<int>(written) : static_cast<int>(written);
    }
    // Between 1e-22 and 1e38, or 0: a normal number in both precisions.
    if (exponent < -22 || exponent > 18) return nullptr;
    const auto read = static_cast<double>(static_cast<std::int64_t>(digits));
    const double scaled = exponent < 0 ? read / power_of_ten[-exponent] : read * power_of_ten[exponent];
    if constexpr (std::is_same_v<Real, double>) {
        if (digits >> 53 != 0) return nullptr;
        value = negative ? -scaled : scaled;  // rounded once
        return p;
    }
    // Rounded twice (once if digits < 2^53), `scaled` is off by less than two units in its last place. The number
    // itself then lies on the same side of every middle of two floats, so that both round to one float, unless `scaled`
    // is this close to such a middle: a one followed by 28 zeros in the 29 bits that a float lacks.
    constexpr std::uint64_t lacking = (1u << 29) - 1, middle = 1u << 28;
    const std::uint64_t rest = std::bit_cast<std::uint64_t>(scaled) & lacking;
    if (rest - (middle - 4) <= 8) return nullptr;
    const auto magnitude = static_cast<Real>(scaled);
    value = negative ? -magnitude : magnitude;
    return p;
}

}  // namespace raywalk
