#include "tracer/rendering/renderer.h"

#include <omp.h>

#include <algorithm>

#include "tracer/rendering/tile_shares.h"

namespace raywalk {

namespace {

// Samples that one visit to a tile makes, between looks at `cancel`.
constexpr std::uint32_t samples_per_visit = 4;

}  // namespace

Renderer::Renderer(const CompiledScene& scene, const Kernels* kernels, int threads)
    : scene_(&scene),
      kernels_(kernels != nullptr ? kernels : select_kernels()),
      threads_(threads > 0 ? threads : omp_get_max_threads()) {
    for (int i = 0; i < threads_; ++i) scratch_.push_back(make_tile_scratch());
}

void Renderer::set_view(const View& view) {
    if (view == view_) return;
    if (view.width != film_.width || view.height != film_.height)
        film_.resize(view.width, view.height);
    else
        film_.clear();
    view_ = view;
    samples_ = 0;
    counts_ = {};
}

// A pixel's samples are added in the order 0, 1, 2, ... whatever the visits and threads: same sums, bit for bit.
bool Renderer::render_tile(int tile, std::uint32_t samples_per_pixel, const std::atomic<bool>& cancel,
                           TileScratch& scratch) {
    const TileRectangle place = tile_rectangle(film_, tile);
    FilmTile sums = film_.tiles[static_cast<std::size_t>(tile)];
    std::uint32_t& done = film_.samples[static_cast<std::size_t>(tile)];
    while (done < samples_per_pixel) {
        if (cancel.load(std::memory_order_relaxed)) return false;
        if (done == 0) sums = {};
        const TileJob job{.scene = scene_,
                          .camera = &view_.camera,
                          .settings = view_.settings,
                          .width = view_.width,
                          .height = view_.height,
                          .x = place.x,
                          .y = place.y,
                          .first_sample = done,
                          .sample_count = std::min(samples_per_pixel - done, samples_per_visit)};
        RayCounts counts;
        kernels_->trace_tile(job, scratch, sums, counts);
        const std::lock_guard lock(commit_);
        if (is_closed_) return false;
        film_.tiles[static_cast<std::size_t>(tile)] = sums;
        counts_ += counts;
        done += job.sample_count;
    }
    return true;
}

bool Renderer::render_until(std::uint32_t samples_per_pixel, const std::atomic<bool>& cancel,
                            const std::function<void(int)>& tile_done) {
    TileShares shares(static_cast<int>(film_.tiles.size()), threads_);
    std::atomic<bool> cancelled = false;

#pragma omp parallel num_threads(threads_)
    {
        const int thread = omp_get_thread_num();
        TileScratch& scratch = *scratch_[static_cast<std::size_t>(thread)];
        bool own_cancelled = false;
        for (auto tiles = shares.take(thread); tiles.begin < tiles.end && !own_cancelled; tiles = shares.take(thread))
            for (int tile = tiles.begin; tile < tiles.end && !own_cancelled; ++tile) {
                if (film_.samples[static_cast<std::size_t>(tile)] >= samples_per_pixel) continue;
                own_cancelled = !render_tile(tile, samples_per_pixel, cancel, scratch);
                if (!own_cancelled && tile_done) tile_done(tile);
            }
        if (own_cancelled) cancelled = true;
    }

    const std::lock_guard lock(commit_);
    if (is_closed_) return false;
    samples_ =
        film_.samples.empty() ? samples_per_pixel : *std::min_element(film_.samples.begin(), film_.samples.end());
    return !cancelled;
}

void Renderer::close_film() {
    const std::lock_guard lock(commit_);
    is_closed_ = true;
}

}  // namespace raywalk
