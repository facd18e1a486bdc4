#include "tests/bench/agreement.h"

#include <cmath>

#include "tests/bench/referee.h"

namespace raywalk::bench {

Agreement compare(const Geometry& geometry, const RaySet& set, const HitBlocks& theirs, const HitBlocks& ours) {
    // Each ray costs the referee a look at all shapes; more than this many disagreements are a fault without asking.
    constexpr std::size_t most_judged = 2000;
    const bool any_hit = traits_of(set.kind).any_hit;
    Agreement agreement;
    for (std::size_t i = 0; i < set.rays.size(); ++i) {
        if (!(set.rays.t_max(i) > set.rays.t_min(i))) continue;
        ++agreement.rays;
        const bool they_hit = theirs.id(i) >= 0, we_hit = ours.id(i) >= 0;
        bool same = they_hit == we_hit;
        if (same && they_hit && !any_hit)
            same = std::fabs(theirs.t(i) - ours.t(i)) <= tolerated_distance * std::fmax(1.0f, std::fabs(theirs.t(i)));
        if (same) continue;
        if (++agreement.different > most_judged) {
            ++agreement.wrong;
            continue;
        }
        const Referee referee(geometry, set, i);
        if (!referee.allows(any_hit, we_hit, ours.t(i))) ++agreement.wrong;
        if (!referee.allows(any_hit, they_hit, theirs.t(i))) ++agreement.theirs_wrong;
    }
    return agreement;
}

}  // namespace raywalk::bench
