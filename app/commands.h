// What the program can be asked to do, one function each. They return the exit code and throw InputError (3),
// WorkError (1) and UsageError (2).
#pragma once

#include "app/command_line/options.h"
#include "app/loaded_scene.h"

namespace raywalk {

enum ExitCode : int {
    exit_done = 0,
    exit_failed = 1,      // disk full, out of memory, device lost
    exit_usage = 2,       // wrong command line
    exit_input = 3,       // wrong scene, mesh or image
    exit_no_display = 4,  // no display or no Vulkan device for the walk
    exit_interrupted = 130
};

int render_command(const Options& options, const LoadedScene& loaded);
int check_command(const Options& options);
int walk_command(const Options& options, LoadedScene&& loaded);
int capture_command(const Options& options, LoadedScene&& loaded);

}  // namespace raywalk
