#!/usr/bin/env bash
# decimesh beside everything that can be installed: time, memory and error, as docs/benchmarks.md with plots.
#
#     scripts/benchmarks.sh [--quick] [--out DIR] [--resume] [FILE...]
#
# --quick: one small mesh, one run: whether it works, not how fast; goes to build/benchmarks/quick. --resume: keeps
# the rows that an interrupted run has left, and measures the others. --out: another place than docs. FILEs, of
# any format that decimesh knows, are measured on besides.
#
# Needs cargo and Python with venv. What Debian has to give is installed where it may be; a library that cannot be
# installed is a row that says so.
set -euo pipefail
# Files are named from where the command is given.
arguments=()
for argument in "$@"; do
    case $argument in
        -*) arguments+=("$argument") ;;
        *) arguments+=("$(realpath -m -- "$argument")") ;;
    esac
done
cd "$(dirname "${BASH_SOURCE[0]}")/.."
exec </dev/null

# What is measured on and the libraries of C++; then what the wheels load from the system, to draw and to show.
packages=(cmake ninja-build g++ doctest-dev python3 python3-venv
    libcgal-dev libcgal-demo libeigen3-dev libopenmesh-dev
    libgl1 libglu1-mesa libopengl0 libegl1 libgomp1 libusb-1.0-0 libx11-6 libxrender1)
if command -v dpkg-query >/dev/null && ! dpkg-query -W "${packages[@]}" >/dev/null 2>&1; then
    if [ "$(id -u)" -eq 0 ]; then
        apt-get update -q >&2
        apt-get install -y -q --no-install-recommends "${packages[@]}" >&2
    else
        echo "some may be missing: as root, apt-get install ${packages[*]}" >&2
    fi
fi

work=$PWD/build/benchmarks
target=${CARGO_TARGET_DIR:-$PWD/target}

python=$work/venv/bin/python
requirements=benches/benchmarks/requirements.txt
if ! cmp -s "$requirements" "$work/venv/installed.txt"; then
    python3 -m venv "$work/venv"
    # All at once, or else one by one: whatever can be had.
    if ! "$python" -m pip install -q -r "$requirements" >&2; then
        grep -v '^#' "$requirements" | while read -r requirement; do
            "$python" -m pip install -q "$requirement" >&2 || echo "cannot be installed: $requirement" >&2
        done
    fi
    cp "$requirements" "$work/venv/installed.txt"
fi

cargo build --locked --release -p decimesh-cli >&2
# In a place of its own: cargo would make the library anew for each of the two, since the command has other features.
cmake -G Ninja -S . -B "$work/cmake" -DCMAKE_BUILD_TYPE=Release -DDECIMESH_BUILD_EXAMPLES=OFF \
    -DDECIMESH_BUILD_PEERS=ON -DDECIMESH_CARGO_TARGET_DIR="$work/cargo" >&2
cmake --build "$work/cmake" --target peers >&2

PYTHONPATH=benches exec "$python" -m benchmarks --root "$PWD" --decimesh "$target/release/decimesh" \
    --peers "$work/cmake/cpp-tests/comparisons/peers" "${arguments[@]}"
