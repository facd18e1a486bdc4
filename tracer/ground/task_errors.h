// Exceptions must not leave an OpenMP task: they are kept and thrown again where the parallel region ends.
#pragma once

#include <atomic>
#include <exception>
#include <mutex>

namespace raywalk {

class TaskErrors {
  public:
    // Runs the work, unless an earlier task failed, and keeps what it throws.
    template <class Work>
    void guard(Work work) {
        if (failed_.load(std::memory_order_relaxed)) return;
        try {
            work();
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (!error_) error_ = std::current_exception();
            failed_.store(true, std::memory_order_relaxed);
        }
    }
    void rethrow() const {
        if (error_) std::rethrow_exception(error_);
    }

  private:
    std::atomic<bool> failed_{false};
    std::mutex mutex_;
    std::exception_ptr error_;
};

}  // namespace raywalk
