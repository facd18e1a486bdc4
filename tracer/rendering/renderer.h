// Scene + view -> film, sample by sample, on all cores.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <vector>

#include "tracer/compiled/compiled_scene.h"
#include "tracer/kernels/kernels.h"
#include "tracer/picture/film.h"
#include "tracer/picture/view.h"

namespace raywalk {

class Renderer {
  public:
    // `scene` must outlive the renderer. `kernels` null: the best of this machine. `threads` 0: as many as OpenMP has.
    explicit Renderer(const CompiledScene& scene, const Kernels* kernels = nullptr, int threads = 0);

    // The only place that clears the film; does nothing when nothing changed.
    void set_view(const View& view);
    [[nodiscard]] const View& view() const { return view_; }

    // Adds samples to every tile up to `samples_per_pixel` in all, then returns true; false when `cancel` was set
    // before that (what tiles have so far stays, each sample whole; a later call goes on from there and ends with the
    // same bits). `tile_done(tile index)` is called by the tracing threads, and must not throw.
    bool render_until(std::uint32_t samples_per_pixel, const std::atomic<bool>& cancel,
                      const std::function<void(int)>& tile_done = {});

    // From any thread while render_until is on its way: from now on nothing changes the film and the counts, which hold
    // whole visits to tiles only. For a program that ends without waiting for the tracing threads; there is no way
    // back.
    void close_film();

    [[nodiscard]] const Film& film() const { return film_; }
    [[nodiscard]] std::uint32_t samples() const { return samples_; }  // that every tile has
    [[nodiscard]] const RayCounts& ray_counts() const { return counts_; }
    [[nodiscard]] int threads() const { return threads_; }
    [[nodiscard]] const Kernels& kernels() const { return *kernels_; }

  private:
    // False when `cancel` was set before the tile had all its samples.
    bool render_tile(int tile, std::uint32_t samples_per_pixel, const std::atomic<bool>& cancel, TileScratch& scratch);

    const CompiledScene* scene_;
    const Kernels* kernels_;
    int threads_;
    View view_;
    Film film_;
    std::uint32_t samples_ = 0;
    RayCounts counts_;
    std::vector<TileScratchPointer> scratch_;  // one per thread
    std::mutex commit_;                        // held while a visit's results enter film and counts
    bool is_closed_ = false;                   // under commit_
};

}  // namespace raywalk
