#include "tests/bench/agreement.h"

#include <cmath>

namespace raywalk::bench {

Agreement compare(const RaySet& set, const HitArrays& a, const HitArrays& b) {
    const bool any_hit = traits_of(set.kind).any_hit;
    Agreement agreement;
    for (std::size_t i = 0; i < set.rays.size(); ++i) {
        if (!(set.rays.t_max[i] > set.rays.t_min[i])) continue;
        ++agreement.rays;
        const bool hit_a = a.id[i] >= 0, hit_b = b.id[i] >= 0;
        bool same = hit_a == hit_b;
        if (same && hit_a && !any_hit)
            same = std::fabs(a.t[i] - b.t[i]) <= tolerated_distance * std::fmax(1.0f, std::fabs(a.t[i]));
        if (!same) ++agreement.different;
    }
    return agreement;
}

}  // namespace raywalk::bench
