#!/usr/bin/env bash
# The suite under a sanitizer: tests/sanitized.sh BUILD_FOLDER [--only-build] builds and runs it. BUILD_FOLDER was
# configured with the preset asan or tsan; the scenes' files are those that another preset made.
# Each executable of tests runs all of its tests in one process: starting one costs more there than most tests do.
# Left out are the tests of texts and pictures that ship (house_tests), which run little of the program, and those that
# kill it (kill_tests); and, of the others, what runs the code of smaller tests again for minutes.
set -euo pipefail
build=$(realpath "$1")
export build
export left_out='*.BuildWorkGrowsAsNLogN:Hierarchies.OfALargeScene*:Hierarchies.HoldAMillion*'
# The slowest first.
executables=(shading_tests traversal_tests hierarchy_tests description_tests command_line_tests shipped_tests
    rendering_tests window_tests app_tests compiled_tests ground_tests)
ninja -C "$build" "${executables[@]}"
[[ ${2:-} != --only-build ]] || exit 0

# The memory of the thread sanitizer is a file, and so falls under the limit of the size of files.
[[ $build != *tsan* ]] || left_out+=':CommandLine.AFileThatMayNotGrow*'
export ASAN_OPTIONS=detect_leaks=1 UBSAN_OPTIONS=print_stacktrace=1
# Archer tells the thread sanitizer what barriers and tasks of OpenMP order.
archer=$(ls /usr/lib/llvm-*/lib/libarcher.so 2>/dev/null | tail -1 || true)
export OMP_TOOL_LIBRARIES=$archer TSAN_OPTIONS=ignore_noninstrumented_modules=1

run() {
    local name=$1 begin=$SECONDS log=$build/$1.log outcome=passed tests
    # The driver of Vulkan keeps memory until the end.
    [[ $name != window_tests ]] || ASAN_OPTIONS=detect_leaks=0
    "$build/$name" --gtest_filter="-$left_out" --gtest_brief=1 >"$log" 2>&1 || outcome=FAILED
    grep -q 'PASSED.* [1-9][0-9]* tests*' "$log" || outcome=FAILED
    tests=$(grep -oE '[0-9]+ tests? from' "$log" | head -1)
    printf '%-6s %4d s  %s, %s\n' $outcome $((SECONDS - begin)) "$name" "${tests% from}"
    [[ $outcome == passed ]] || { tail -60 "$log"; return 1; }
}
export -f run

cd "$build"
printf '%s\n' "${executables[@]}" | xargs -P "$(nproc)" -I '{}' bash -c 'run {}'
