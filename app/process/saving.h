// A picture that took its time is not lost for where it was to go.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>

#include "tracer/picture/film.h"

namespace raywalk {

// Memory for saving, set aside before the work takes what there is.
class SavingReserve {
  public:
    SavingReserve();
    void release() { bytes_.reset(); }

  private:
    std::unique_ptr<std::byte[]> bytes_;
};

// Runs `save`, which writes the picture to `output`. Where that fails though the work is done (a full disk, a folder
// that was taken away, a broken encoder, no memory), the radiance of the film is written as .pfm, which needs no other
// program: beside `output`, or else in $TMPDIR or /tmp. Throws WorkError all the same, which names that file.
void save_or_rescue(const std::filesystem::path& output, const Film& film, SavingReserve& reserve,
                    const std::function<void()>& save);

}  // namespace raywalk
