// The doors into the vector kernels: one table of functions per instruction set, chosen at run time.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "tracer/compiled/compiled_scene.h"
#include "tracer/kernels/traversal/ray_blocks.h"
#include "tracer/picture/film.h"
#include "tracer/picture/view.h"

namespace raywalk {

// Rays by kind, and samples that were not finite and so were dropped.
struct RayCounts {
    std::uint64_t camera = 0, shadow = 0, reflection = 0, refraction = 0, dropped_samples = 0;
    RayCounts& operator+=(const RayCounts& other) {
        camera += other.camera, shadow += other.shadow, reflection += other.reflection;
        refraction += other.refraction, dropped_samples += other.dropped_samples;
        return *this;
    }
    friend bool operator==(const RayCounts&, const RayCounts&) = default;
};

// Samples [first_sample, first_sample + sample_count) of the tile at pixel (x, y) of a width x height picture.
struct TileJob {
    const CompiledScene* scene = nullptr;
    const Camera* camera = nullptr;
    SampleSettings settings;
    int width = 0, height = 0, x = 0, y = 0;
    std::uint32_t first_sample = 0, sample_count = 1;
};

// Per-thread queues of the kernels, reused from tile to tile: no allocation while rendering.
struct TileScratch;
struct TileScratchDeleter {
    void operator()(TileScratch*) const;
};
using TileScratchPointer = std::unique_ptr<TileScratch, TileScratchDeleter>;
TileScratchPointer make_tile_scratch();

struct Kernels {
    std::string_view name;  // "scalar", "sse4", "avx2", "avx512"
    int lanes;              // floats in one register: 1, 4, 8, 16

    // Adds the samples of the job to `tile`.
    void (*trace_tile)(const TileJob& job, TileScratch& scratch, FilmTile& tile, RayCounts& counts);
    // Display values of one tile: round(255 clamp(sum * scale)) as 0xffRRGGBB words (B8G8R8A8 in memory), clipped to
    // the picture; `row_stride` in pixels; `out` points at the tile's first pixel.
    void (*resolve_tile)(const FilmTile& tile, float scale, int columns, int rows, std::uint32_t* out, int row_stride);

    // Nearest hits of rays that share nothing.
    void (*intersect)(const CompiledScene& scene, const RayBlocks& rays, HitBlocks& hits);
    // The same for rays of one common origin (that of ray 0), traced as beams of 64.
    void (*intersect_beam)(const CompiledScene& scene, const RayBlocks& rays, HitBlocks& hits);
    // id = 0 where anything lies in (t_min, t_max), else -1.
    void (*occluded)(const CompiledScene& scene, const RayBlocks& rays, HitBlocks& hits);
    void (*occluded_beam)(const CompiledScene& scene, const RayBlocks& rays, HitBlocks& hits);
};

// Those this processor can run, best first.
std::span<const Kernels* const> available_kernels();
// The best, or the named one; null when this processor or build has none of that name.
const Kernels* select_kernels(std::optional<std::string_view> name = {});

}  // namespace raywalk
