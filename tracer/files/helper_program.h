// Programs of ours that handle the bytes of others, run once for each file. They are found by trust, and start with
// nothing: no environment but a fixed one, no open files but those given, small stacks, no new rights, a wall clock.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace raywalk {

// Opens the helper of this name: beside the program (as built), or in ../lib/raywalk from there (as installed), nowhere
// else. It must belong to root or to the program's owner, and be writable by nobody else, as its folder must. Returns
// its descriptor, which the caller closes. Throws WorkError.
int open_helper(const std::string& name);

// Why a file with this owner, group and mode must not be run as a helper of a program of `owner`'s; empty when it may.
std::string distrust(uid_t file_owner, gid_t file_group, mode_t mode, uid_t owner);

// A helper that runs; killed with this, should that come first.
class RunningHelper {
  public:
    // `files` become its descriptors 0, 1, 3, 4, ...; 2 is silence, as what libraries print is no message of ours. In a
    // process group of its own, so that Ctrl-C does not reach it while a picture is saved. Throws WorkError.
    RunningHelper(const std::string& name, std::vector<std::string> arguments, std::span<const int> files);
    RunningHelper(const RunningHelper&) = delete;
    RunningHelper& operator=(const RunningHelper&) = delete;
    ~RunningHelper();

    // Waits for at most `seconds` by the clock, 0: for ever, then kills it. How it ended, in words ("its decoder gave
    // up"); empty when normally. Throws WorkError where it could not start.
    std::string end(double seconds);

  private:
    pid_t pid_ = 0;
};

}  // namespace raywalk
