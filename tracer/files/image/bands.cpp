#include "tracer/files/image/bands.h"

#include <zlib.h>

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>

namespace raywalk {

namespace {

// Appends to a file what several threads bring, in order. A thread whose turn has not come sleeps: spinning, as
// OpenMP's `ordered` does, it would take the processor from the one that writes.
class InOrder {
  public:
    explicit InOrder(WholeFile& file) : file_(&file) {}

    // `problem`: why there are no bytes. After the first problem nothing is written any more.
    void append(int number, std::string_view bytes, std::exception_ptr problem) {
        std::unique_lock lock(mutex_);
        turn_.wait(lock, [&] { return next_ == number; });
        if (!problem_ && !problem) {
            try {
                begins_.push_back(file_->size());
                file_->append(bytes);
            } catch (...) {
                problem = std::current_exception();
            }
        }
        if (!problem_) problem_ = problem;
        ++next_;
        turn_.notify_all();
    }
    // Where each began, and where the last one ended.
    std::vector<std::uint64_t> begins() {
        if (problem_) std::rethrow_exception(problem_);
        begins_.push_back(file_->size());
        return begins_;
    }

  private:
    WholeFile* file_;
    std::mutex mutex_;
    std::condition_variable turn_;
    int next_ = 0;
    std::vector<std::uint64_t> begins_;
    std::exception_ptr problem_;
};

}  // namespace

std::vector<std::uint64_t> append_bands(WholeFile& file, int height, int rows, const EncodeBand& encode) {
    const int bands = (height + rows - 1) / rows;
    InOrder in_order(file);
    // One band after the other, so that whoever has the next turn is at work already.
#pragma omp parallel
    {
        std::string bytes;  // its memory serves all bands of a thread
#pragma omp for schedule(monotonic : dynamic, 1)
        for (int band = 0; band < bands; ++band) {
            std::exception_ptr problem;  // none may leave a parallel loop
            bytes.clear();
            try {
                encode(band * rows, std::min((band + 1) * rows, height), bytes);
            } catch (...) {
                problem = std::current_exception();
            }
            in_order.append(band, bytes, problem);
        }
    }
    return in_order.begins();
}

std::span<const float> rows_of(const FloatRows& picture, int begin, int end) {
    thread_local std::vector<float> rgb;
    rgb.resize(static_cast<std::size_t>(end - begin) * static_cast<std::size_t>(picture.width) * 3);
    picture.read(begin, end, rgb.data());
    return rgb;
}

std::string zlib_compressed(std::string_view data, int level) {
    uLongf size = compressBound(data.size());
    std::string result(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(result.data()), &size, reinterpret_cast<const Bytef*>(data.data()),
                  data.size(), level) != Z_OK)
        throw std::bad_alloc();  // nothing else can go wrong
    result.resize(size);
    return result;
}

void put_little_endian(std::string& to, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) to += static_cast<char>(value >> (8 * i));
}

void put_big_endian(std::string& to, std::uint64_t value, int bytes) {
    for (int i = bytes - 1; i >= 0; --i) to += static_cast<char>(value >> (8 * i));
}

}  // namespace raywalk
