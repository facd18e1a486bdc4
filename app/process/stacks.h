// Room for the stacks of all threads.
#pragma once

namespace raywalk {

// Sees to at least 1 MB for each thread, whatever the limit of the shell and OMP_STACKSIZE say, as both count only when
// a program starts: true where it has to start again for that. Throws a WorkError where it may not have as much.
bool make_room_for_stacks();

}  // namespace raywalk
