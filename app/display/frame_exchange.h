// Frames from the thread that traces to the thread that shows: three slots that change hands, no copy and no waiting.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <utility>

namespace raywalk {

// display: width * height words 0xffRRGGBB (B8G8R8A8 in memory), rows from the top.
// radiance: the film's tiles row by row (FilmTile), then one float a tile, exposure / samples.
enum class FrameContent { display, radiance };

struct FrameInfo {
    int width = 0, height = 0;  // pixels
    FrameContent content = FrameContent::display;
    std::uint32_t samples = 0;    // a pixel; 0 for a preview of reduced size
    double trace_seconds = 0;     // what tracing it took
    bool finished = false;        // no more samples of this view will come
    std::uint64_t camera_id = 0;  // which camera it shows: counts the changes of the view
};

struct FrameSlot {
    int index = 0;  // 0..2
    std::byte* data = nullptr;
    std::size_t capacity = 0;  // bytes
    FrameInfo info;
};

// One thread writes, one thread takes. Each owns its slot alone, so neither waits for the other.
class FrameExchange {
  public:
    // `grow` gives a slot at least that many bytes; it is called by the writing thread, for the slot that it owns.
    explicit FrameExchange(std::function<void(FrameSlot&, std::size_t bytes)> grow) : grow_(std::move(grow)) {
        for (int i = 0; i < 3; ++i) slots_[i].index = i;
    }

    // Writing thread: the slot to fill, with room for `bytes`. Its old content is undefined.
    FrameSlot& begin_write(std::size_t bytes) {
        FrameSlot& slot = slots_[writing_];
        if (slot.capacity < bytes) grow_(slot, bytes);
        return slot;
    }
    // Writing thread: the slot of the last begin_write is whole. An older one that nobody took is forgotten.
    void publish() {
        const std::lock_guard lock(mutex_);
        std::swap(writing_, ready_);
        fresh_ = true;
    }

    [[nodiscard]] bool fresh() const {
        const std::lock_guard lock(mutex_);
        return fresh_;
    }
    // Showing thread: the newest frame, which stays valid until the next call; null before the first one.
    // The caller is done with the frame that it took before.
    const FrameSlot* take() {
        const std::lock_guard lock(mutex_);
        if (fresh_) {
            std::swap(ready_, shown_);
            fresh_ = false;
            any_ = true;
        }
        return any_ ? &slots_[shown_] : nullptr;
    }

  private:
    std::function<void(FrameSlot&, std::size_t)> grow_;
    std::array<FrameSlot, 3> slots_;
    mutable std::mutex mutex_;
    int writing_ = 0, ready_ = 1, shown_ = 2;
    bool fresh_ = false, any_ = false;
};

}  // namespace raywalk
