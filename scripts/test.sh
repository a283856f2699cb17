#!/usr/bin/env bash
# Everything that must hold before a change goes in: formatting, lints, documentation, the bare core,
# all tests of Rust, C and C++, the comparisons with CGAL and OpenMesh, the package as other projects use
# it, and the command as a user meets it. Each step says how long it took; the first that fails ends the
# run, with its name.
#
# Needs Rust with rustfmt and clippy. What Debian has to give is installed where it may be.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
exec </dev/null

export RUSTDOCFLAGS="-D warnings"
# The same random cases in each run, so that what fails is the change's doing. `cargo test` by itself
# draws new ones each time.
export PROPTEST_RNG_SEED=${PROPTEST_RNG_SEED:-20261122}
# Without OpenMesh its tests pass by saying that they are skipped; not here.
export DECIMESH_REQUIRE_OPENMESH=1

# cmake drives cargo, and everybody builds in one place.
target=${CARGO_TARGET_DIR:-$PWD/target}
work=$(mktemp -d)
current="preparation"
on_exit() {
    local status=$?
    rm -rf "$work"
    if [ "$status" -ne 0 ]; then
        echo "FAILED: $current" >&2
    fi
}
trap on_exit EXIT

step() {
    current=$1
    shift
    local start=$SECONDS
    echo "== $current"
    "$@"
    echo "== $current: $((SECONDS - start)) s"
}

# What Debian has to give. Machines that have it already, or are no Debian, are left alone.
tools() {
    local packages=(g++ clang libclang-rt-14-dev cmake ninja-build make pkg-config binutils
        python3 doctest-dev valgrind abigail-tools
        libopenmesh-dev libcgal-dev libcgal-demo libeigen3-dev)
    if command -v dpkg-query >/dev/null && ! dpkg-query -W "${packages[@]}" >/dev/null 2>&1; then
        apt-get update -q
        DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${packages[@]}"
    fi
    c++ --version
    clang++ --version
    cmake --version
    cargo --version
}

# The workspace's own code alone is held to no warnings: the lints of dependencies are theirs.
lint() {
    cargo clippy --locked --workspace --all-targets --all-features -- -D warnings
}

# Without files, measurement and the C ABI, as an engine in Rust would link it. A warning here is code that
# only those use.
bare_core() {
    cargo clippy --locked --no-default-features -- -D warnings
}

# The command first: its pages lie where the library's of the same name go.
documentation() {
    cargo doc --locked --no-deps -p decimesh-cli
    cargo doc --locked --no-deps --all-features -p decimesh
}

# As the tests built them: by itself, cargo would build their dependencies once more.
rust_examples() {
    local example
    for example in buffers levels cancel nested; do
        "$target/debug/examples/$example"
    done
}

# A user's first hour: the picture, a smaller mesh, how far it is from the large one, what is in it.
command_line() {
    local demo=$work/demo
    decimesh() { cargo run --locked --quiet --release -p decimesh-cli -- "$@"; }
    decimesh demo "$demo" --triangles 50000 --width 600 --quiet
    [ -n "$(find "$demo" -name '*.png' -size +1k)" ]
    decimesh simplify "$demo/statue.ply" "$work/small.obj" --triangles 2000 --verify --quiet
    decimesh compare "$demo/statue.ply" "$work/small.obj" --samples 20000 --quiet
    decimesh info "$work/small.obj"
}

# Of Python's own library alone: what measures and draws is seen to work by scripts/benchmarks.sh --quick.
benchmarks_report() {
    PYTHONPATH=benches PYTHONDONTWRITEBYTECODE=1 python3 -m unittest discover -t benches -s benches/benchmarks/tests
}

# build PRESET [CMAKE-ARGUMENT...]
build() {
    local preset=$1
    shift
    cmake --preset "$preset" -DDECIMESH_CARGO_TARGET_DIR="$target" "$@"
    cmake --build --preset "$preset"
}

c_and_cpp() {
    build release -DDECIMESH_REQUIRE_PEERS=ON
    ctest --preset release -j 2 "$@"
}

# With clang, so that both compilers see the headers and the tests.
sanitizers() {
    build asan -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++
    ctest --preset asan -j 2 -L 'quick|examples'
}

memcheck() {
    valgrind --quiet --error-exitcode=1 --leak-check=full --errors-for-leak-kinds=definite \
        --suppressions=cpp-tests/valgrind.supp build/release/cpp-tests/decimesh-tests --test-suite=quick
}

step "tools" tools
step "formatting" cargo fmt --all --check
step "lints" lint
step "lints of the bare core" bare_core
step "documentation" documentation
step "release build of the command" cargo build --locked --release -p decimesh-cli
step "the command on a mesh of its own" command_line
step "tests of Rust" cargo test --locked --workspace
step "examples in Rust" rust_examples
step "the report of the benchmarks" benchmarks_report
step "tests, examples and comparisons in C and C++" c_and_cpp
step "the C ABI against its record" scripts/abi.sh
step "programs that use decimesh from outside" scripts/consumers.sh
# With the command as it was built above: cargo would build library and command anew, each for the other's sake.
step "the viewer" scripts/viewer.sh --command "$target/release/decimesh"
step "the MeshLab plugin" scripts/meshlab.sh --command "$target/release/decimesh"
step "C and C++ under sanitizers" sanitizers
step "C and C++ under valgrind" memcheck
echo "all checks passed in $SECONDS s"
