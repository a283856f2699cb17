#!/usr/bin/env bash
# Everything that must hold before a change goes in: formatting, lints, documentation, the bare core,
# all tests, and the command as a user meets it. Each step says how long it took; the first that
# fails ends the run, with its name.
#
# Needs Rust with rustfmt and clippy, and a C++ compiler (for meshoptimizer, which only benches use),
# which it installs where it may.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
exec </dev/null

export RUSTDOCFLAGS="-D warnings"
# The same random cases in each run, so that what fails is the change's doing. `cargo test` by itself
# draws new ones each time.
export PROPTEST_RNG_SEED=${PROPTEST_RNG_SEED:-20261122}

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
    if ! command -v c++ >/dev/null && command -v apt-get >/dev/null; then
        apt-get update -q
        apt-get install -y -q --no-install-recommends g++
    fi
    c++ --version
    cargo --version
}

# The workspace's own code alone is held to no warnings: the lints of dependencies are theirs.
lint() {
    cargo clippy --locked --workspace --all-targets --all-features -- -D warnings
}

# Without I/O and measurement, as an engine would link it. A warning here is code that only those use.
bare_core() {
    cargo clippy --locked --no-default-features -- -D warnings
}

# The command first: its pages lie where the library's of the same name go.
documentation() {
    cargo doc --locked --no-deps -p decimesh-cli
    cargo doc --locked --no-deps --all-features -p decimesh
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

step "tools" tools
step "formatting" cargo fmt --all --check
step "lints" lint
step "lints of the bare core" bare_core
step "documentation" documentation
step "release build of the command" cargo build --locked --release -p decimesh-cli
step "the command on a mesh of its own" command_line
step "tests" cargo test --locked --workspace
echo "all checks passed in $SECONDS s"
