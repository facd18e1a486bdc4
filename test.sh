#!/usr/bin/env bash
# ./test.sh [--full]: builds Raywalk and its tests, installing what is missing, and runs them.
#   (nothing)   the quick suite: a few minutes on two cores, the build not counted
#   --full      everything: warnings as errors, the long tests, format, lint, the suite under sanitizers, coverage,
#               deliberate faults, fuzzing; about 25 minutes on two cores
# Ends with one line per stage and their count; the exit code is 0 where nothing failed.
set -uo pipefail
root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")" && pwd)
source "$root/.ci/prepare.sh"

full=no
case "${1:-}" in
    "") ;;
    --full) full=yes ;;
    *) sed -n '2,6s/^# //p' "$root/test.sh"; [[ $1 == --help || $1 == -h ]] && exit 0; exit 2 ;;
esac

jobs=$(nproc)
results=()
failed=0

# stage NAME COMMAND...: runs the command with nothing on stdin, and remembers how it went and how long it took.
stage() {
    local name=$1 begin=$SECONDS outcome=passed
    shift
    say "== $name"
    "$@" </dev/null || { outcome=FAILED; failed=$((failed + 1)); }
    results+=("$(printf '%-7s %5d s  %s' "$outcome" $((SECONDS - begin)) "$name")")
}

suite() {  # suite PRESET [CTEST OPTIONS...]
    local preset=$1
    shift
    ctest --test-dir "$root/build/$preset" --output-on-failure --no-tests=error -j "$jobs" "$@"
}

build_with_tests() { configure "$@" RAYWALK_TESTS=ON RAYWALK_UNITY=ON && build "$1"; }
build_sanitized() { configure "$1" && "$root/tests/sanitized.sh" "$root/build/$1" --only-build >&2; }

sources() { git -C "$root" ls-files -z -- '*.h' '*.cpp' '*.inl'; }
check_format() { (cd "$root" && sources | xargs -0 -r clang-format --dry-run --Werror); }
# Many sources at a time, since headers take most of the time; that they are .cpp files which include .cpp files is no
# mistake then. It is enough to know how they would be compiled, and to have the shaders' headers.
lint() {
    configure lint && configure fuzz && cmake --build "$root/build/lint" --target shader_headers || return
    local preset
    for preset in lint fuzz; do
        grep -o '"file": "[^"]*"' "$root/build/$preset/compile_commands.json" | cut -d'"' -f4 | sort -u |
            sed "s|^|$preset |"
    done | xargs -d '\n' -r -n 1 -P "$jobs" bash -c \
        'clang-tidy -p "$0/build/${1%% *}" --quiet --checks=-bugprone-suspicious-include --warnings-as-errors="*" "${1#* }"' \
        "$root" 2> >(grep -v 'warnings generated' >&2)
}

outcome_of() {  # outcome_of PROCESS LOG: waits for what was started in the background, shows what it said
    local outcome=0
    wait "$1" || outcome=$?
    cat "$2"
    return "$outcome"
}

vulkan_driver=$(vulkan_driver_package)
packages=("${build_packages[@]}" "${test_packages[@]}" ${vulkan_driver:+"$vulkan_driver"})
[[ $full == yes ]] && packages+=("${full_test_packages[@]}" "${bench_packages[@]}")
need_packages "${packages[@]}" || exit 1
provide_runtime_folder

if [[ $full == no ]]; then
    stage "build" build_with_tests release
    [[ $failed -ne 0 ]] || stage "quick suite" suite release -LE long
else
    stage "format" check_format
    stage "build, warnings are errors" build_with_tests release RAYWALK_WERROR=ON
    stage "whole suite" suite release
    stage "build for address and undefined-behaviour sanitizers" build_sanitized asan
    stage "suite under these" "$root/tests/sanitized.sh" "$root/build/asan"
    stage "coverage" "$root/tests/coverage.sh" "$root/build/asan" 95
    stage "build for the thread sanitizer" build_sanitized tsan
    stage "suite under it" "$root/tests/sanitized.sh" "$root/build/tsan"
    # Faults are planted and built one by one, which keeps one core busy; fuzzers and lint share the others' time.
    faults_log=$root/build/faults.log
    "$root/tests/mutations/run.sh" </dev/null >"$faults_log" 2>&1 &
    faults=$!
    stage "fuzzing, a minute for each target, while faults are planted" "$root/tests/fuzz/run.sh" 60
    stage "lint, while faults are planted" lint
    stage "deliberate faults, the rest of them" outcome_of "$faults" "$faults_log"
fi

printf '\n'
printf '%s\n' "${results[@]}"
printf '%d passed, %d failed\n' $((${#results[@]} - failed)) "$failed"
[[ $failed -eq 0 ]]
