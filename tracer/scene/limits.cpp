#include "tracer/scene/limits.h"

namespace raywalk {

std::string how_to_raise(const Limits& limits, std::uint64_t Limits::*value) {
    std::string text = "the limit is " + std::to_string(limits.*value);
    for (const LimitOption& option : limit_options)
        if (option.value == value) text += "; raise it with " + std::string(option.name) + " N";
    return text;
}

}  // namespace raywalk
