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

prefix=
command=
out=
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

name=viewer
. "$(dirname "${BASH_SOURCE[0]}")/outside.sh"
out=${out:-$work/viewer}

need_packages g++ cmake ninja-build pkg-config doctest-dev \
    libglfw3-dev libimgui-dev libglm-dev libepoxy-dev libgl-dev libpng-dev \
    xvfb xauth libgl1-mesa-dri

if [ -z "$prefix" ]; then
    prefix=$out/decimesh
    install_decimesh "$prefix"
    [ -n "$command" ] || build_command
fi

say "building the viewer"
build examples/viewer "$out" \
    "-DCMAKE_PREFIX_PATH=$prefix" "-DVIEWER_DECIMESH_COMMAND=$command" -DCMAKE_COMPILE_WARNING_AS_ERROR=ON
run_tests "$out"

if [ -n "$pictures" ]; then
    [ -n "$command" ] || fail "pictures need --command"
    mkdir -p docs/images
    cp "$out"/tests/pictures/viewer-*.png docs/images/
    say "the pictures are in docs/images"
fi
say "all well in $SECONDS s"
