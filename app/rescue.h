// A saved picture within a second of an interrupt, however long one step of the work takes.
#pragma once

#include <functional>
#include <thread>

namespace raywalk {

// While one lives, work goes on that looks for interrupts now and then. Where it has not returned a quarter of a second
// after an interrupt, `save` is called on another thread and the program ends with what it returns as its exit code,
// without waiting for the work: one tile of a scene with very many lights or overlapping faces may take minutes.
// `save` must not touch what the work changes meanwhile (Renderer::close_film).
class Rescue {
  public:
    explicit Rescue(std::function<int()> save);
    // The work has returned. Where the rescue has begun, it ends the program before this returns.
    ~Rescue();
    Rescue(const Rescue&) = delete;
    Rescue& operator=(const Rescue&) = delete;

  private:
    void watch(const std::stop_token& stop) const;

    std::function<int()> save_;
    std::jthread thread_;
};

}  // namespace raywalk
