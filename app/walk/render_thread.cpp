#include "app/walk/render_thread.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "app/display/frame_writer.h"
#include "tracer/rendering/resolve.h"

namespace raywalk {
namespace {

// Seconds for which a frame goes on although a newer view waits.
constexpr double patience_of_moving_frame = 0.1;   // frames that are always given up show nothing
constexpr double patience_of_opening_frame = 0.5;  // the exposure of the whole walk hangs on it
constexpr double no_patience = 0;

// Fewer samples may agree by chance.
constexpr std::uint32_t first_compared_samples = 16;

constexpr double first_sample_interval = 0.04;  // seconds between frames that show tiles as they come
// Seconds between frames of a standing view: the longer it stands, the less a sample changes.
constexpr double shortest_interval = 1.0 / 30, longest_interval = 0.25, interval_growth = 0.1;

double seconds_between(auto from, auto to) { return std::chrono::duration<double>(to - from).count(); }

}  // namespace

RenderThread::RenderThread(Renderer& renderer, FrameExchange& exchange, Setup setup, const View& view)
    : renderer_(renderer),
      exchange_(exchange),
      setup_(std::move(setup)),
      goal_{.view = view},
      exposure_factor_(setup_.exposure_factor) {
    thread_ = std::thread([this] { run(); });
}

RenderThread::~RenderThread() { stop(); }

void RenderThread::stop() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
        stopping_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

std::uint64_t RenderThread::show(const View& view, bool moving) {
    const std::lock_guard lock(mutex_);
    if (goal_.view == view && goal_.moving == moving) return goal_.id;
    if (!(goal_.view == view)) {
        goal_.view = view;
        goal_id_ = ++goal_.id;
    }
    goal_.moving = moving;
    changed_.notify_all();
    return goal_.id;
}

void RenderThread::expose(float factor) {
    const std::lock_guard lock(mutex_);
    exposure_factor_ = factor;
    ++goal_.exposure_id;
    changed_.notify_all();
}

void RenderThread::rest(bool resting) {
    if (resting_.exchange(resting) == resting) return;
    const std::lock_guard lock(mutex_);
    changed_.notify_all();
}

std::exception_ptr RenderThread::failure() const {
    const std::lock_guard lock(mutex_);
    return failure_;
}

void RenderThread::run() {
    try {
        open(current_goal());
        while (const auto goal = next_goal()) {
            if (goal->exposure_id != shown_exposure_id_) resolve_again(*goal);
            if (goal->id != shown_id_)
                trace_preview(*goal);
            else if (goal->moving || finished(*goal))
                continue;
            else if (!(renderer_.view() == goal->view) || renderer_.samples() == 0) {
                if (trace_first_sample(*goal, no_patience)) publish(*goal);
            } else
                trace_more_samples(*goal);
        }
    } catch (...) {
        {
            const std::lock_guard lock(mutex_);
            failure_ = std::current_exception();
        }
        setup_.frame_ready();
    }
}

RenderThread::Goal RenderThread::current_goal() const {
    const std::lock_guard lock(mutex_);
    return goal_;
}

// Waits for something to do; none when the thread is to end.
std::optional<RenderThread::Goal> RenderThread::next_goal() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] {
        if (stop_) return true;
        return !resting_ && (goal_.id != shown_id_ || goal_.exposure_id != shown_exposure_id_ ||
                             (!goal_.moving && !finished(goal_)));
    });
    if (stop_) return {};
    return goal_;
}

bool RenderThread::finished(const Goal& goal) const {
    return renderer_.view() == goal.view && (still_ || renderer_.samples() >= setup_.sample_limit);
}

float RenderThread::exposure() const { return setup_.exposure.value_or(opening_exposure_) * exposure_factor_; }

View RenderThread::scaled(const View& view) const {
    View small = view;
    const glm::ivec2 size = pacing_.size({view.width, view.height});
    small.width = size.x;
    small.height = size.y;
    return small;
}

// Brings every tile to `samples`. Given up, then false, when this thread is to end or to rest, or when a newer view
// waits and `patience` seconds are over.
bool RenderThread::trace(const Goal& goal, std::uint32_t samples, double patience,
                         const std::function<void(int)>& tile_done) {
    std::atomic<bool> cancel = false;
    std::atomic<int> tiles = 0;
    const auto start = Clock::now();
    const std::uint32_t had = renderer_.samples();
    const bool whole = renderer_.render_until(samples, cancel, [&](int tile) {
        tiles.fetch_add(1, std::memory_order_relaxed);
        if (tile_done) tile_done(tile);
        if (stopping_.load(std::memory_order_relaxed) || resting_.load(std::memory_order_relaxed) ||
            (goal_id_.load(std::memory_order_relaxed) != goal.id && seconds_between(start, Clock::now()) >= patience))
            cancel.store(true, std::memory_order_relaxed);
    });
    const double seconds = seconds_between(start, Clock::now());
    traced_seconds_ += seconds;
    pacing_.measured(static_cast<double>(tiles) * tile_pixels * (samples - had), seconds,
                     {goal.view.width, goal.view.height});
    last_trace_seconds_ = seconds;
    return whole;
}

// The first frames, and the exposure: that of the opening view, whole and at full size, so that it depends on nothing
// but the scene and the picture's size.
void RenderThread::open(const Goal& goal) {
    trace_preview(goal);
    if (setup_.exposure) return;
    const Goal opening{.view = setup_.opening, .id = goal.id};
    bool whole = false;
    if (opening.view == goal.view) {
        whole = trace_first_sample(opening, patience_of_opening_frame);
    } else {
        renderer_.set_view(opening.view);
        whole = trace(opening, 1, patience_of_opening_frame);
    }
    opening_exposure_ = normalizing_exposure(renderer_.film());
    opened_ = true;
    if (opening.view == goal.view && whole)
        publish(opening);
    else
        shown_id_ = 0;  // what is shown has the exposure of its own preview: show it again
}

// A frame for a new view, as large as a moving camera's frame may be.
void RenderThread::trace_preview(const Goal& goal) {
    const View view = scaled(goal.view);
    renderer_.set_view(view);
    compared_.clear();
    still_ = false;
    standing_since_ = Clock::now();
    if (!trace(goal, 1, patience_of_moving_frame)) return;
    moving_frame_seconds_.push_back(last_trace_seconds_);
    if (!setup_.exposure && !opened_) opening_exposure_ = normalizing_exposure(renderer_.film());
    publish(goal);
}

// The first sample at full size. Where that takes a while, tiles show as they come, in front of the preview.
bool RenderThread::trace_first_sample(const Goal& goal, double patience) {
    const int width = goal.view.width, height = goal.view.height;
    std::vector<std::uint32_t> canvas(static_cast<std::size_t>(width) * height);
    {
        const Film& preview = renderer_.film();
        std::vector<std::uint32_t> small(static_cast<std::size_t>(preview.width) * preview.height);
        resolve_into(small, preview, renderer_.kernels(), exposure(), renderer_.threads());
        upscale(small, preview.width, preview.height, canvas, width, height);
    }
    renderer_.set_view(goal.view);

    std::mutex arrivals;
    std::vector<int> arrived;
    std::atomic_flag publishing;
    return trace(goal, 1, patience, [&](int tile) {
        {
            const std::lock_guard lock(arrivals);
            arrived.push_back(tile);
        }
        if (publishing.test_and_set(std::memory_order_acquire)) return;
        if (seconds_between(last_publish_, Clock::now()) >= first_sample_interval) {
            std::vector<int> tiles;
            {
                const std::lock_guard lock(arrivals);
                tiles.swap(arrived);
            }
            for (const int done : tiles) resolve_into(canvas, renderer_.film(), done, renderer_.kernels(), exposure());
            publish_picture(exchange_, {.trace_seconds = 0, .camera_id = goal.id}, width, height, canvas);
            last_publish_ = Clock::now();
            setup_.frame_ready();
        }
        publishing.clear(std::memory_order_release);
    });
}

void RenderThread::trace_more_samples(const Goal& goal) {
    const double interval = std::clamp(interval_growth * seconds_between(standing_since_, Clock::now()),
                                       shortest_interval, longest_interval);
    const double pass = pacing_.seconds_for({goal.view.width, goal.view.height});
    const auto passes = static_cast<std::uint32_t>(std::clamp(interval / pass, 1.0, 64.0));
    const std::uint32_t had = renderer_.samples();
    std::uint32_t target = had + std::min(passes, setup_.sample_limit - had);
    if (setup_.until_still) target = std::min(target, std::bit_floor(had) * 2);
    if (!trace(goal, target, no_patience)) return;
    if (setup_.until_still && target >= first_compared_samples && std::has_single_bit(target)) compare_with_half(goal);
    publish(goal);
}

// Whether the picture still changes: by the display values at half as many samples.
void RenderThread::compare_with_half(const Goal& goal) {
    std::vector<std::uint32_t> picture(static_cast<std::size_t>(goal.view.width) * goal.view.height);
    resolve_into(picture, renderer_.film(), renderer_.kernels(), exposure(), renderer_.threads());
    still_ = picture == compared_;
    compared_ = std::move(picture);
}

// Another exposure of what is there.
void RenderThread::resolve_again(const Goal& goal) {
    shown_exposure_id_ = goal.exposure_id;
    compared_.clear();
    still_ = false;
    if (renderer_.samples() > 0 && goal.id == shown_id_) publish(goal);
}

void RenderThread::publish(const Goal& goal) {
    const bool full = renderer_.view() == goal.view;
    publish_film(exchange_, setup_.content,
                 {.samples = full ? renderer_.samples() : 0,
                  .trace_seconds = last_trace_seconds_,
                  .finished = full && finished(goal),
                  .camera_id = goal.id},
                 renderer_.film(), renderer_.kernels(), exposure(), renderer_.threads());
    shown_id_ = goal.id;
    last_publish_ = Clock::now();
    setup_.frame_ready();
}

}  // namespace raywalk
