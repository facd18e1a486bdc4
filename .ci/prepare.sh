# Sourced by run.sh, test.sh and bench.sh: what a fresh Debian 12 machine needs, installed and built. Silent about what is
# already there. The caller sets `root`, the folder of the project. All talk goes to stderr.

build_packages=(g++ cmake ninja-build pkg-config libvulkan-dev libglfw3-dev libx11-dev libglm-dev glslang-tools libopenimageio-dev
    libpng-dev libjpeg-dev libhwy-dev libfast-float-dev nlohmann-json3-dev libcli11-dev)
test_packages=(libgtest-dev libgmock-dev libxtst-dev vulkan-validationlayers xvfb xauth xdotool x11-utils x11-xkb-utils procps imagemagick
    openimageio-tools)
bench_packages=(libembree-dev libtinyobjloader-dev libassimp-dev)
full_test_packages=(clang llvm libomp-dev clang-format clang-tidy gcovr)

say() { printf '%s\n' "$*" >&2; }

as_root() {
    if [[ $(id -u) -eq 0 ]]; then "$@"; else sudo "$@"; fi
}

# Installs those of the named Debian packages that are missing.
need_packages() {
    if ! command -v dpkg-query >/dev/null; then
        say "This is no Debian machine, so nothing is installed. Needed, by their Debian names: $*"
        return
    fi
    local installed missing=() package
    installed=" $(dpkg-query -W -f '${Package}/${db:Status-Status} ' "$@" 2>/dev/null || true)"
    for package in "$@"; do
        [[ $installed == *" $package/installed "* ]] || missing+=("$package")
    done
    [[ ${#missing[@]} -gt 0 ]] || return 0
    if [[ $(id -u) -ne 0 ]] && ! command -v sudo >/dev/null; then
        say "Missing packages, and no sudo to install them with. Run as root:"
        say "    apt-get update && apt-get install --no-install-recommends ${missing[*]}"
        return 1
    fi
    say "Installing ${missing[*]}"
    as_root apt-get update -qq >&2
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >&2
}

# Names Mesa's drivers, a software one among them, where the machine has no Vulkan driver at all.
vulkan_driver_package() {
    local driver
    for driver in {/usr/share,/usr/local/share,/etc}/vulkan/icd.d/*.json; do
        [[ -e $driver ]] && return
    done
    [[ -n ${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-} ]] || echo mesa-vulkan-drivers
}

# Whether PRESET is configured, here and not in a folder that the project was moved or copied from.
is_configured() {
    local folder=$root/build/$1
    [[ -f $folder/build.ninja ]] && grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$folder/CMakeCache.txt"
}

# configure PRESET [NAME=VALUE...]: where it is not configured yet, or with other values.
configure() {
    local preset=$1 setting same=yes fresh=(--fresh)
    shift
    if is_configured "$preset"; then
        fresh=()
        for setting in "$@"; do
            grep -qE "^${setting%%=*}:[A-Z]+=${setting#*=}\$" "$root/build/$preset/CMakeCache.txt" || same=no
        done
        [[ $same == yes ]] && return
    fi
    (cd "$root" && cmake ${fresh[@]+"${fresh[@]}"} --preset "$preset" "${@/#/-D}") >&2
}

# build PRESET [TARGET...]
build() {
    local folder=$root/build/$1
    shift
    [[ $(ninja -C "$folder" -n "$@" 2>&1) == *"no work to do"* ]] && return
    ninja -C "$folder" "$@" >&2
}

# Mesa complains where no session made this folder.
provide_runtime_folder() {
    [[ -d ${XDG_RUNTIME_DIR:-} ]] && return
    export XDG_RUNTIME_DIR=$root/build/runtime
    mkdir -p "$XDG_RUNTIME_DIR" && chmod 700 "$XDG_RUNTIME_DIR"
}
