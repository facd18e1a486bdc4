#!/usr/bin/env bash
# ./bench.sh [--quick] [--json FILE] [--mesh FILE]... [--only PART]...: measures Raywalk against Embree, tinyobjloader and
# assimp, which it installs where they are missing. Markdown goes to stdout and, after a whole run, into docs/benchmark.md
# between its marks; the plot of growth goes beside its pictures. Exit code 1: a hit or a picture of ours is wrong.
set -euo pipefail
root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")" && pwd)
source "$root/.ci/prepare.sh"

whole=yes
for option in "$@"; do
    case $option in --quick | --only | --scene | --profile | --isa | --help | -h) whole=no ;; esac
done

need_packages "${build_packages[@]}" "${bench_packages[@]}"
is_configured bench || configure bench
build bench raywalk_bench raywalk scene_files

bench=$root/build/bench/raywalk_bench
if [[ $whole == no ]]; then
    exec "$bench" "$@"
fi
"$bench" --plot "$root/scenes/pictures/growth.svg" "$@" | tee "$root/build/bench/benchmark.md"

# Only the lines between the marks are ours.
document=$root/docs/benchmark.md
if grep -q '^<!-- benchmark -->$' "$document" 2>/dev/null && grep -q '^<!-- end of benchmark -->$' "$document"; then
    awk -v table="$root/build/bench/benchmark.md" '
        /^<!-- benchmark -->$/ { print; while ((getline line < table) > 0) print line; inside = 1; next }
        /^<!-- end of benchmark -->$/ { inside = 0 }
        !inside' "$document" >"$document.new"
    mv "$document.new" "$document"
    say "docs/benchmark.md holds the new figures."
fi
