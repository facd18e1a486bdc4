// Axis-aligned boxes.
#pragma once

#include <array>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>

namespace raywalk {

// A box [lower, upper] per axis; empty while lower > upper, as it starts.
struct Bounds {
    glm::vec3 lower{std::numeric_limits<float>::infinity()};
    glm::vec3 upper{-std::numeric_limits<float>::infinity()};

    void extend(const glm::vec3& point) {
        lower = glm::min(lower, point);
        upper = glm::max(upper, point);
    }
    void extend(const Bounds& other) {
        lower = glm::min(lower, other.lower);
        upper = glm::max(upper, other.upper);
    }
    [[nodiscard]] bool empty() const { return lower.x > upper.x || lower.y > upper.y || lower.z > upper.z; }
    [[nodiscard]] glm::vec3 size() const { return upper - lower; }
    // Half the surface area; 0 for an empty box. The SAH needs only ratios of areas.
    [[nodiscard]] float half_area() const {
        if (empty()) return 0;
        const glm::vec3 d = size();
        return d.x * d.y + d.y * d.z + d.z * d.x;
    }
    friend bool operator==(const Bounds&, const Bounds&) = default;
};

}  // namespace raywalk
