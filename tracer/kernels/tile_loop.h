// The doors of shading, one set per instruction set: what Kernels::trace_tile and resolve_tile call.
#pragma once

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
