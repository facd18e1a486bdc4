// The files that a run writes: whether they can be, looked at before the work rather than after it, and how.
#pragma once

#include "app/command_line/options.h"
#include "tracer/files/image/image.h"
#include "tracer/scene/scene.h"

namespace raywalk {

// Throws WorkError where a file could not be written, UsageError where two would be the same one.
void require_writable_outputs(const Options& options);

// Throws UsageError where writing would destroy what the scene is made of.
void require_no_input(const std::filesystem::path& output, const Scene& scene);
void require_inputs_kept(const Options& options, const Scene& scene);

// How a picture is to be saved now: after an interrupt as fast as can be.
Saving saving_now();

}  // namespace raywalk
