// Who is right where two tracers disagree: every shape, in double precision, without a hierarchy.
#pragma once

#include "tests/bench/ray_sets.h"

namespace raywalk::bench {

// What a ray may answer. Formulas in single precision are off by some roundings; a hit is certain if it stays one when
// ray and shape move by that much, and possible if it can become one.
class Referee {
  public:
    // `ray` of `set`, against all shapes of `geometry`.
    Referee(const Geometry& geometry, const RaySet& set, std::size_t ray);

    // Whether the answer (id < 0: no hit) is right, or within rounding of right.
    [[nodiscard]] bool allows(bool any_hit, bool hit, double distance) const;

  private:
    struct Candidate {
        double t, tolerance;  // where along the ray, and how far rounding can move it
        bool certain;
    };
    void consider(const Candidate& candidate, bool inside_surely);
    void triangle(const glm::dvec3 (&corners)[3]);
    void sphere(const glm::dvec3& center, double radius);

    glm::dvec3 origin_, direction_;
    double t_min_, t_max_;
    std::vector<Candidate> candidates_;
};

}  // namespace raywalk::bench
