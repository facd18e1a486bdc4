// Tracing beside the window: the newest view, as fast as it changes, and more samples while it stands.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "app/display/frame_exchange.h"
#include "app/walk/frame_pacing.h"
#include "tracer/rendering/renderer.h"

namespace raywalk {

class RenderThread {
  public:
    struct Setup {
        View opening;                    // exposure is normalised to this picture (spec 4.8), of its own size
        std::optional<float> exposure;   // a fixed factor instead
        float exposure_factor = 1;       // multiplies either: what the user's keys made of it
        std::uint32_t sample_limit = 1;  // a pixel; then the thread sleeps
        bool until_still = false;        // or earlier, when twice the samples changed no display value
        FrameContent content = FrameContent::display;
        std::function<void()> frame_ready;  // called by this thread after each frame
    };
    // Starts with `view`. Renderer and exchange belong to this thread while it lives.
    RenderThread(Renderer& renderer, FrameExchange& exchange, Setup setup, const View& view);
    ~RenderThread();  // gives up what it is tracing

    // What to show from now on. `moving`: the next view is about to come, so a small frame soon is better than a
    // large one. Returns the id that frames of this view carry.
    std::uint64_t show(const View& view, bool moving);
    // Setup's exposure_factor from now on; costs no sample.
    void expose(float factor);

    // Traces nothing while nobody sees it.
    void rest(bool resting);

    // What this thread died of, if it did; to be thrown again by the caller's thread.
    [[nodiscard]] std::exception_ptr failure() const;
    // Seconds that each frame of reduced size or of a moving camera took to trace. After the thread has ended.
    [[nodiscard]] const std::vector<double>& moving_frame_seconds() const { return moving_frame_seconds_; }
    [[nodiscard]] double traced_seconds() const { return traced_seconds_; }
    // Ends the thread; what it has traced stays in the renderer.
    void stop();

  private:
    using Clock = std::chrono::steady_clock;
    struct Goal {
        View view;
        bool moving = false;
        std::uint64_t id = 1;
        std::uint64_t exposure_id = 0;
    };

    void run();
    [[nodiscard]] Goal current_goal() const;
    [[nodiscard]] std::optional<Goal> next_goal();
    [[nodiscard]] bool finished(const Goal& goal) const;
    void open(const Goal& goal);
    void trace_preview(const Goal& goal);
    bool trace_first_sample(const Goal& goal, double patience);
    void trace_more_samples(const Goal& goal);
    bool trace(const Goal& goal, std::uint32_t samples, double patience,
               const std::function<void(int)>& tile_done = {});
    void compare_with_half(const Goal& goal);
    void publish(const Goal& goal);
    void resolve_again(const Goal& goal);
    [[nodiscard]] View scaled(const View& view) const;
    [[nodiscard]] float exposure() const;

    Renderer& renderer_;
    FrameExchange& exchange_;
    Setup setup_;

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    Goal goal_;
    bool stop_ = false;
    std::exception_ptr failure_;
    std::atomic<std::uint64_t> goal_id_ = 1;
    std::atomic<bool> stopping_ = false, resting_ = false;
    std::atomic<float> exposure_factor_;

    // This thread's own.
    FramePacing pacing_;
    float opening_exposure_ = 1;
    bool opened_ = false;         // opening_exposure_ will not change any more
    std::uint64_t shown_id_ = 0;  // the view of the last frame published
    std::uint64_t shown_exposure_id_ = 0;
    Clock::time_point standing_since_;     // of the present view
    std::vector<std::uint32_t> compared_;  // display values at the last power of two of samples
    bool still_ = false;                   // more samples would change none of them
    Clock::time_point last_publish_;
    double last_trace_seconds_ = 0;
    std::vector<double> moving_frame_seconds_;
    std::atomic<double> traced_seconds_ = 0;

    std::thread thread_;
};

}  // namespace raywalk
