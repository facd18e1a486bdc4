#include "tracer/files/mesh/obj_origin.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <cstddef>
#include <glm/common.hpp>
#include <limits>
#include <system_error>

#include "tracer/files/blank.h"

namespace raywalk {

namespace {

constexpr double far = 16;  // extents of the box

// Reads "v X Y Z" at the start of a line, as it is most often written.
bool read_vertex(std::string_view line, glm::dvec3& vertex) {
    if (!line.starts_with("v ")) return false;
    const char* p = line.data() + 1;
    const char* end = line.data() + line.size();
    for (int axis = 0; axis < 3; ++axis) {
        while (p < end && is_blank(*p)) ++p;
        const auto [after, error] = fast_float::from_chars(p, end, vertex[axis]);
        if (error != std::errc{}) return false;
        p = after;
    }
    return true;
}

// The first vertex that begins a line of the text.
bool find_vertex(std::string_view text, glm::dvec3& vertex) {
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find('\n'));
        if (read_vertex(line, vertex)) return true;
        text.remove_prefix(std::min(line.size() + 1, text.size()));
    }
    return false;
}

}  // namespace

glm::dvec3 origin_for(const glm::dvec3& lower, const glm::dvec3& upper) {
    const glm::dvec3 size = upper - lower;
    const double extent = std::max({size.x, size.y, size.z});
    bool is_far = false;
    for (int axis = 0; axis < 3; ++axis) is_far = is_far || std::max(lower[axis], -upper[axis]) > far * extent;
    return is_far ? glm::dvec3(glm::vec3((lower + upper) / 2.0)) : glm::dvec3(0);
}

glm::dvec3 likely_origin(std::string_view text) {
    constexpr std::size_t places = 32, stretch = 4096;  // bytes looked at from each place
    glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper = -lower;
    for (std::size_t i = 0; i < places; ++i) {
        const std::string_view here = text.substr(text.size() / places * i, stretch);
        glm::dvec3 vertex(0);
        const std::size_t line = i == 0 ? 0 : std::min(here.find('\n'), here.size());
        if (!find_vertex(here.substr(line == 0 ? 0 : std::min(line + 1, here.size())), vertex)) continue;
        lower = glm::min(lower, vertex);
        upper = glm::max(upper, vertex);
    }
    if (!(upper.x - lower.x >= 0) || upper == lower) return glm::dvec3(0);  // nothing to judge by
    return origin_for(lower, upper);
}

}  // namespace raywalk
