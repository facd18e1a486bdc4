#!/usr/bin/env bash
# Are the tests sharp? Plants each fault of faults.sh in a copy of the sources, builds the test executable that has to
# catch it, and runs the named tests: they pass without the fault and fail with it. tests/mutations/run.sh [WORD]: only
# faults whose description holds WORD. Works in build/mutations; ends with code 1 where a fault survives, or no longer
# finds its place in the sources.
set -euo pipefail
cd "$(dirname "$0")/../.."
wanted=${1:-}
work=$PWD/build/mutations
tree=$work/tree
mkdir -p "$tree"

# A copy that only touches what changed, so that a second run builds little.
git ls-files -z | while IFS= read -r -d '' file; do
    cmp -s "$file" "$tree/$file" || install -D "$file" "$tree/$file"
done
# One lane at a time and no optimisation: what is compiled anew takes longer to compile than to run.
cmake -S "$tree" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE= -DCMAKE_CXX_FLAGS=-O0 -DRAYWALK_UNITY=ON \
    -DRAYWALK_INSTRUCTION_SETS=scalar >"$work/configure.log"

descriptions=() files=() olds=() news=() executables=() filters=()
fault() { # fault DESCRIPTION FILE OLD NEW EXECUTABLE TESTS
    [[ $1 == *"$wanted"* ]] || return 0
    descriptions+=("$1") files+=("$2") olds+=("$3") news+=("$4") executables+=("$5") filters+=("$6")
}
source tests/mutations/faults.sh
count=${#files[@]}

build() { ninja -C "$work/build" "$@" >"$work/build.log" 2>&1 || { tail -20 "$work/build.log"; return 1; }; }
# passes EXECUTABLE TESTS SECONDS: a fault may also show as a crash, or as a run without end. Without one they may take long
# where fuzzers and lint have the cores.
passes() { timeout "$3" "$work/build/$1" --gtest_filter="$2" --gtest_brief=1 >"$work/test.log" 2>&1; }

build $(printf '%s\n' "${executables[@]}" | sort -u)
declare -A seen=()
for ((i = 0; i < count; ++i)); do
    [[ -z ${seen[${executables[i]} ${filters[i]}]:-} ]] || continue
    seen[${executables[i]} ${filters[i]}]=yes
    passes "${executables[i]}" "${filters[i]}" 600 || { cat "$work/test.log"; echo "${filters[i]} fails without a fault"; exit 1; }
    grep -q 'PASSED.* [1-9][0-9]* test' "$work/test.log" || { echo "no test is called ${filters[i]}"; exit 1; }
done

failed=0
for ((i = 0; i < count; ++i)); do
    text=$(cat "$tree/${files[i]}" || true)  # a file that is gone holds nothing
    rest=${text#*"${olds[i]}"}
    outcome=caught
    if [[ $rest == "$text" || $rest == *"${olds[i]}"* ]]; then
        outcome="NOT APPLIED, its place is not in ${files[i]} just once"
    else
        printf '%s\n' "${text%%"${olds[i]}"*}${news[i]}$rest" >"$tree/${files[i]}"
        if ! build "${executables[i]}"; then
            outcome="NOT BUILT"
        elif passes "${executables[i]}" "${filters[i]}" 120; then
            outcome="SURVIVED ${filters[i]}"
        fi
        cp "${files[i]}" "$tree/${files[i]}"
    fi
    [[ $outcome == caught ]] || failed=$((failed + 1))
    printf '%3d s  %s: %s\n' $SECONDS "${descriptions[i]}" "$outcome"
done
echo "$((count - failed)) of $count faults caught"
[[ $failed -eq 0 && $count -gt 0 ]]
