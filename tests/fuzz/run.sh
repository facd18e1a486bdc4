#!/usr/bin/env bash
# Builds the fuzzers and runs each for SECONDS (default 60), as many at a time as there are cores:
# tests/fuzz/run.sh [SECONDS] [NAME...]
# New inputs go to build/fuzz/corpus, findings to build/fuzz/findings; a finding ends with exit code 1.
# A finding is reproduced with: build/fuzz/fuzz_NAME FINDING
set -euo pipefail
cd "$(dirname "$0")/../.."
export seconds=${1:-60}
shift || true

cmake --preset fuzz >/dev/null
cmake --build --preset fuzz
names=("$@")
if [ ${#names[@]} -eq 0 ]; then
    for source in tests/fuzz/fuzz_*.cpp; do
        name=$(basename "$source" .cpp)
        names+=("${name#fuzz_}")
    done
fi

fuzz() { # fuzz NAME
    local name=$1 log=build/fuzz/$1.log dictionary=tests/fuzz/$1.dict outcome=0
    mkdir -p "build/fuzz/corpus/$name"
    # A single input may not take more than 256 MB at once, or 10 s.
    "build/fuzz/fuzz_$name" -max_total_time="$seconds" -timeout=10 -malloc_limit_mb=256 -rss_limit_mb=2048 \
        -max_len=16384 -print_final_stats=1 -artifact_prefix="build/fuzz/findings/$name-" \
        $([ -f "$dictionary" ] && echo "-dict=$dictionary") \
        "build/fuzz/corpus/$name" "tests/fuzz/corpus/$name" >"$log" 2>&1 || outcome=1
    echo "fuzz $name for $seconds s"
    if [ $outcome -ne 0 ]; then
        echo "  FINDING, see $log:"
        grep -aE "ERROR|SUMMARY|broken promise|Test unit written" "$log" | head -8 | sed 's/^/  /' || true
    fi
    grep -aE "stat::number_of_executed_units|cov:" "$log" | tail -2 | sed 's/^/  /' || true
    return $outcome
}
export -f fuzz
export ASAN_OPTIONS=allocator_may_return_null=0
mkdir -p build/fuzz/findings
printf '%s\n' "${names[@]}" | xargs -P "$(nproc)" -I '{}' bash -c 'fuzz {}'
