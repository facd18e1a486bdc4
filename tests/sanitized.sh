#!/usr/bin/env bash
# The suite under a sanitizer: tests/sanitized.sh BUILD_FOLDER [--only-build] builds and runs it. BUILD_FOLDER was
# configured with the preset asan or tsan; the scenes' files are those that another preset made.
# Each executable of tests runs all of its tests in one process: starting one costs more there than most tests do.
# Left out are the tests of texts and pictures that ship (house_tests), which run little of the program, and those that
# kill it (kill_tests); what preloads a library (HelperCores), which sanitizers want to be first; and, of the others, what
# runs the code of smaller tests again for minutes. Under the thread sanitizer also what has no threads: images are read
# by helper programs.
set -euo pipefail
build=$(realpath "$1")
export build
export left_out='*.BuildWorkGrowsAsNLogN:Hierarchies.OfALargeScene*:Hierarchies.HoldAMillion*:*/many_lights'
left_out+=':HelperCores.*:Widths.PicturesAreTheSameToTheEye*:DepthOfField.BlurHasTheRadius*'
# The slowest first.
executables=(files_tests command_line_tests shading_tests traversal_tests shipped_tests hierarchy_tests
    rendering_tests window_tests app_tests compiled_tests ground_tests)
ninja -C "$build" "${executables[@]}"
[[ ${2:-} != --only-build ]] || exit 0

if [[ $build == *tsan* ]]; then
    left_out+=':Image/*:ImageTest.*:CorpusTest.Images*:CommandLine.AnAbsurdNumberOfThreads*'
    # OpenImageIO's own threads, in a helper that hears none of the options above.
    left_out+=':CommandLine.AnInterruptSavesEveryFormatWhole'
    # The memory of the thread sanitizer is a file, and so falls under the limit of the size of files.
    left_out+=':CommandLine.AFileThatMayNotGrow*'
fi
export UBSAN_OPTIONS=print_stacktrace=1
# OpenMP's library keeps the teams of more threads than the last one had: allocations of its own allocator are no leaks
# of ours. To see that it is this one that asks, stacks of allocations are unwound beyond code without frame pointers.
echo 'leak:___kmp_allocate' >"$build/known_leaks"
export LSAN_OPTIONS=suppressions=$build/known_leaks:print_suppressions=0
export ASAN_OPTIONS=detect_leaks=1:fast_unwind_on_malloc=0:malloc_context_size=8
# Archer tells the thread sanitizer what barriers and tasks of OpenMP order.
archer=$(ls /usr/lib/llvm-*/lib/libarcher.so 2>/dev/null | tail -1 || true)
export OMP_TOOL_LIBRARIES=$archer TSAN_OPTIONS=ignore_noninstrumented_modules=1

run() {
    local name=$1 begin=$SECONDS log=$build/$1.log outcome=passed tests
    # The driver of Vulkan keeps memory until the end, and code that it makes while it runs cannot be unwound.
    [[ $name != window_tests ]] || ASAN_OPTIONS=detect_leaks=0
    timeout 900 "$build/$name" --gtest_filter="-$left_out" --gtest_brief=1 >"$log" 2>&1 || outcome=FAILED
    grep -q 'PASSED.* [1-9][0-9]* tests*' "$log" || outcome=FAILED
    tests=$(grep -oE '[0-9]+ tests? from' "$log" | head -1)
    printf '%-6s %4d s  %s, %s\n' $outcome $((SECONDS - begin)) "$name" "${tests% from}"
    [[ $outcome == passed ]] || { tail -60 "$log"; return 1; }
}
export -f run

cd "$build"
printf '%s\n' "${executables[@]}" | xargs -P "$(nproc)" -I '{}' bash -c 'run {}'
