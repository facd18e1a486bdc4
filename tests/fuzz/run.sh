#!/usr/bin/env bash
# Builds the fuzzers and runs each for SECONDS (default 60): tests/fuzz/run.sh [SECONDS] [NAME...]
# New inputs go to build/fuzz/corpus, findings to build/fuzz/findings; a finding ends with exit code 1.
# A finding is reproduced with: build/fuzz/fuzz_NAME FINDING
set -euo pipefail
cd "$(dirname "$0")/../.."
seconds=${1:-60}
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

mkdir -p build/fuzz/findings
export ASAN_OPTIONS=allocator_may_return_null=0
failed=0
for name in "${names[@]}"; do
    mkdir -p "build/fuzz/corpus/$name"
    dictionary=tests/fuzz/$name.dict
    log=build/fuzz/$name.log
    echo "fuzz $name for $seconds s"
    # A single input may not take more than 256 MB at once, or 10 s.
    if ! "build/fuzz/fuzz_$name" -max_total_time="$seconds" -timeout=10 -malloc_limit_mb=256 -rss_limit_mb=2048 \
        -max_len=16384 -print_final_stats=1 -artifact_prefix="build/fuzz/findings/$name-" \
        $([ -f "$dictionary" ] && echo "-dict=$dictionary") \
        "build/fuzz/corpus/$name" "tests/fuzz/corpus/$name" >"$log" 2>&1; then
        echo "  FINDING, see $log:"
        grep -aE "ERROR|SUMMARY|broken promise|Test unit written" "$log" | head -8 | sed 's/^/  /' || true
        failed=1
    fi
    grep -aE "stat::number_of_executed_units|cov:" "$log" | tail -2 | sed 's/^/  /' || true
done
exit $failed
