// Files of a folder, and nothing else, whatever happens to it meanwhile.
#pragma once

#include <filesystem>

#include "tracer/ground/descriptor.h"

namespace raywalk {

// Opens `file`, a path from `folder` without "..", for reading: no link on the way is followed, so that what is opened
// lies beneath the folder. Not valid, and errno says why, where that fails; ELOOP: there is a link. One system call
// (openat2, Linux 5.6), or on older kernels one a component.
Descriptor open_beneath(const Descriptor& folder, const std::filesystem::path& file);
Descriptor open_by_components(const Descriptor& folder, const std::filesystem::path& file);  // as on older kernels

}  // namespace raywalk
