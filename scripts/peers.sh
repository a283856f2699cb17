#!/usr/bin/env bash
# decimesh beside CGAL, OpenMesh and meshoptimizer on five meshes of Debian's libcgal-demo, and on any that
# are given: time, memory and error, as Markdown on the standard output.
#
#     scripts/peers.sh [--quick] [--rounds N] [--share R] [FILE...]
#
# --quick: one mesh, one round: whether it works, not how fast. --share: what to leave of the triangles, 0.1
# by default. Files are OFF, PLY, STL or OBJ, of oriented manifolds. Needs cargo; what Debian has to give is
# installed where it may be.
set -euo pipefail
# Files are named from where the command is given.
arguments=()
for argument in "$@"; do
    if [ -e "$argument" ]; then
        argument=$(realpath -- "$argument")
    fi
    arguments+=("$argument")
done
cd "$(dirname "${BASH_SOURCE[0]}")/.."
exec </dev/null

packages=(cmake ninja-build g++ doctest-dev libcgal-dev libcgal-demo libeigen3-dev libopenmesh-dev)
if command -v dpkg-query >/dev/null && ! dpkg-query -W "${packages[@]}" >/dev/null 2>&1; then
    if [ "$(id -u)" -ne 0 ]; then
        echo "missing: as root, apt-get install ${packages[*]}" >&2
        exit 1
    fi
    apt-get update -q >&2
    apt-get install -y -q --no-install-recommends "${packages[@]}" >&2
fi

build=build/peers
cmake -G Ninja -S . -B "$build" -DCMAKE_BUILD_TYPE=Release -DDECIMESH_REQUIRE_PEERS=ON \
    -DDECIMESH_BUILD_EXAMPLES=OFF -DDECIMESH_CARGO_TARGET_DIR="$PWD/target" >&2
cmake --build "$build" --target peers >&2
exec "$build/cpp-tests/comparisons/peers" "${arguments[@]}"
