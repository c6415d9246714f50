#!/bin/sh
# Everything from a fresh Debian or Ubuntu machine to results, in one command:
#
#   sh cmake/quickstart.sh demo    installs what is missing, builds, animates the embedded body
#   sh cmake/quickstart.sh test    the same for the test suite
#   sh cmake/quickstart.sh packages    installs only, what the test suite needs
#
# Packages are installed with apt-get, as root or through sudo, and only if one is missing. On another system the
# script names the packages and stops.
set -eu

usage() {
    echo "usage: sh cmake/quickstart.sh demo|test|packages" >&2
    exit 2
}

say() {
    printf '\n== %s\n' "$*"
}

[ "$#" -eq 1 ] || usage
task=$1
packages="g++ cmake ninja-build pkg-config libeigen3-dev libzip-dev libtinygltf-dev
    nlohmann-json3-dev libcli11-dev libcairo2-dev libsuitesparse-dev zlib1g-dev"
case "$task" in
demo) ;;
test | packages) packages="$packages doctest-dev catch2 libbenchmark-dev libtet1.5-dev" ;;
*) usage ;;
esac

# The page of results (report.html) is bundled from npm packages. Debian's npm is some 400 small packages, 54 MB with node:
# installed only where these commands are missing.
if ! command -v node >/dev/null 2>&1 || ! command -v npm >/dev/null 2>&1; then
    packages="$packages nodejs npm"
fi

cd "$(dirname "$0")/.."

install_packages() {
    if ! command -v apt-get >/dev/null 2>&1 || ! command -v dpkg-query >/dev/null 2>&1; then
        echo "This is neither Debian nor Ubuntu. Install what these packages hold, then run the CMake presets (cmake --list-presets):" >&2
        for package in $packages; do
            echo "    $package" >&2
        done
        exit 1
    fi
    missing=
    for package in $packages; do
        if ! dpkg-query -W -f '${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed; then
            missing="$missing $package"
        fi
    done
    if [ -z "$missing" ]; then
        say "All packages are installed"
        return
    fi
    as_root=
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null 2>&1; then
            echo "Missing packages, and neither root nor sudo to install them:$missing" >&2
            exit 1
        fi
        as_root=sudo
    fi
    say "Installing:$missing"
    $as_root apt-get update -q
    # shellcheck disable=SC2086
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing
}

check_cmake() {
    version=$(cmake --version | sed -n 's/^cmake version \([0-9]*\)\.\([0-9]*\).*/\1 \2/p')
    # shellcheck disable=SC2086
    set -- $version
    if [ "$1" -lt 3 ] || { [ "$1" -eq 3 ] && [ "$2" -lt 25 ]; }; then
        echo "CMake $1.$2 is too old, 3.25 is needed (Debian 12, Ubuntu 24.04 or newer have it)." >&2
        exit 1
    fi
}

install_packages
check_cmake
[ "$task" != packages ] || exit 0

build=build/quickstart
say "Configuring in $build"
if [ "$task" = demo ]; then
    cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
        -DSOFTTISSUE_BUILD_EXAMPLES=ON -DSOFTTISSUE_BUILD_TESTS=OFF -DSOFTTISSUE_BUILD_BENCHMARKS=OFF
    say "Building the soft-tissue avatar (some minutes)"
    cmake --build "$build" --target soft_tissue_avatar

    results=results/soft_tissue_avatar
    mkdir -p "$results"
    say "Animating the embedded body"
    "$build/examples/soft_tissue_avatar" --out "$results" --json "$results/report.json"
    say "Results"
    for file in "$results"/*; do
        echo "    $(pwd)/$file"
    done
else
    cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
        -DSOFTTISSUE_BUILD_EXAMPLES=ON -DSOFTTISSUE_BUILD_TESTS=ON -DSOFTTISSUE_BUILD_BENCHMARKS=ON
    say "Building tests, examples and benchmarks (several minutes)"
    cmake --build "$build" --target all softtissue_headers_alone
    say "Running the tests"
    ctest --test-dir "$build" --output-on-failure --parallel "$(nproc)"
fi
