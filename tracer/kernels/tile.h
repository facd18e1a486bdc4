// The doors of shading, one set per instruction set: what Kernels::trace_tile and resolve_tile call.
// Included once per target by Highway's foreach_target.h, hence the guard that toggles.

#if defined(RAYWALK_KERNELS_TILE_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYWALK_KERNELS_TILE_H
#undef RAYWALK_KERNELS_TILE_H
#else
#define RAYWALK_KERNELS_TILE_H
#endif

#include "tracer/kernels/kernels.h"

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

void trace_tile(const TileJob& job, TileScratch& scratch, FilmTile& tile, RayCounts& counts);
void resolve_tile(const FilmTile& tile, float scale, int columns, int rows, std::uint32_t* out, int row_stride);

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();

#endif  // RAYWALK_KERNELS_TILE_H
