#!/usr/bin/env bash
# Which lines of the tracer the tests ran: tests/coverage.sh BUILD_FOLDER [LEAST]. BUILD_FOLDER was built with --coverage
# and its tests were run. Prints the share of lines by folder, and the files below LEAST percent (default 95); ends with
# code 1 where all of tracer/ together is below. A line counts once, however many instruction sets and templates
# repeat it.
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1 least=${2:-95}
# A thread may lose another's count of a line, and gcovr wonders at what then adds up to less than none; that a line ran
# is not lost. Counters without such losses make the suite twice as slow.
gcovr --root . --filter tracer/ --gcov-executable "llvm-cov gcov" --gcov-ignore-parse-errors -j "$(nproc)" \
    --csv "$build/coverage.csv" "$build" >"$build/coverage.log" 2>&1 || { cat "$build/coverage.log" >&2; exit 1; }
awk -F, -v least="$least" '
    NR == 1 { next }
    {
        folder = $1; sub(/\/[^\/]*$/, "", folder)
        lines[folder] += $2; run[folder] += $3; all += $2; all_run += $3
        if ($3 < $2 * least / 100) few = few sprintf("    %-44s %4d of %4d lines\n", $1, $3, $2)
    }
    END {
        for (folder in lines) printf "%-24s %5.1f %% of %d lines\n", folder, 100 * run[folder] / lines[folder], lines[folder] | "sort"
        close("sort")
        if (all == 0) exit 1
        if (few != "") printf "below %d %%:\n%s", least, few
        printf "tracer: %.1f %% of %d lines\n", 100 * all_run / all, all
        exit all_run < all * least / 100
    }' "$build/coverage.csv"
