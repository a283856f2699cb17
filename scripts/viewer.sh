#!/usr/bin/env bash
# Builds the viewer (examples/viewer) against an installed decimesh and runs its tests, in a window that nobody sees:
# Xvfb, with Mesa's own rasterizer. What Debian has to give is installed where it may be.
#
#   scripts/viewer.sh [--prefix PREFIX] [--command FILE] [--out DIR] [--pictures]
#
#   --prefix PREFIX  decimesh is installed there; without it, it is built, and installed beside the viewer
#   --command FILE   the decimesh command of the same version: results are compared with its own, and it makes the
#                    statue that docs/viewer.md shows. Without it, it is built, or, where there is a prefix, done without
#   --out DIR        leave the viewer there, with the pictures of all tests; without it, nothing is left
#   --pictures       write the pictures of docs/viewer.md anew
#
# Without a prefix it needs cargo.
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

prefix=
command=
out=$work/viewer
pictures=
while [ $# -gt 0 ]; do
    case $1 in
    --prefix) prefix=$(realpath "$2"); shift 2 ;;
    --command) command=$(realpath "$2"); shift 2 ;;
    --out) mkdir -p "$2"; out=$(realpath "$2"); shift 2 ;;
    --pictures) pictures=yes; shift ;;
    *) echo "viewer: there is no option $1" >&2; exit 2 ;;
    esac
done

cd "$(dirname "${BASH_SOURCE[0]}")/.."
target=${CARGO_TARGET_DIR:-$PWD/target}

say() {
    echo "viewer: $*"
}

quietly() {
    "$@" >"$work/log" 2>&1 || { cat "$work/log" >&2; say "failed: $*" >&2; exit 1; }
}

packages=(g++ cmake ninja-build pkg-config doctest-dev
    libglfw3-dev libimgui-dev libglm-dev libepoxy-dev libgl-dev libpng-dev
    xvfb xauth libgl1-mesa-dri)
if command -v dpkg-query >/dev/null && ! dpkg-query -W "${packages[@]}" >/dev/null 2>&1; then
    say "installing what Debian has"
    quietly apt-get update -q
    DEBIAN_FRONTEND=noninteractive quietly apt-get install -y -q --no-install-recommends "${packages[@]}"
fi

if [ -z "$prefix" ]; then
    say "building and installing decimesh"
    prefix=$out/decimesh
    quietly cmake -S . -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_LIBDIR=lib \
        -DDECIMESH_BUILD_TESTS=OFF -DDECIMESH_BUILD_EXAMPLES=OFF "-DDECIMESH_CARGO_TARGET_DIR=$target"
    quietly cmake --build "$work/build"
    quietly cmake --install "$work/build" --prefix "$prefix"
    if [ -z "$command" ]; then
        quietly cargo build --locked --release -p decimesh-cli --target-dir "$target"
        command=$target/release/decimesh
    fi
fi

say "building the viewer"
quietly cmake -S examples/viewer -B "$out" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    "-DCMAKE_PREFIX_PATH=$prefix" "-DVIEWER_DECIMESH_COMMAND=$command" -DCMAKE_COMPILE_WARNING_AS_ERROR=ON
quietly cmake --build "$out"

say "its tests"
quietly ctest --test-dir "$out" --output-on-failure --no-tests=error -j 2
grep 'tests passed' "$work/log"

if [ -n "$pictures" ]; then
    [ -n "$command" ] || { say "pictures need --command" >&2; exit 1; }
    mkdir -p docs/images
    cp "$out"/tests/pictures/viewer-*.png docs/images/
    say "the pictures are in docs/images"
fi
say "all well in $SECONDS s"
