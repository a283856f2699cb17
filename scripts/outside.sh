# What the scripts share that build and run something outside of decimesh, against an installed one: sourced, not run,
# with `name` set to what each line that they print begins with. Leaves the shell in the repository's root.
#
#   work     a directory that goes with the script
#   target   where cargo builds

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$(dirname "${BASH_SOURCE[0]}")/.."
target=${CARGO_TARGET_DIR:-$PWD/target}

say() {
    echo "$name: $*"
}

fail() {
    say "$*" >&2
    exit 1
}

quietly() {
    "$@" >"$work/log" 2>&1 || { cat "$work/log" >&2; fail "failed: $*"; }
}

# Packages of Debian. Machines that have them already, or are no Debian, are left alone.
need_packages() {
    if command -v dpkg-query >/dev/null && ! dpkg-query -W "$@" >/dev/null 2>&1; then
        say "installing what Debian has"
        quietly apt-get update -q
        DEBIAN_FRONTEND=noninteractive quietly apt-get install -y -q --no-install-recommends "$@"
    fi
}

# Configures and builds a CMake project: SOURCE BINARY [CMAKE-ARGUMENT...]
build() {
    local source=$1 binary=$2
    shift 2
    quietly cmake -S "$source" -B "$binary" -G Ninja -DCMAKE_BUILD_TYPE=Release "$@"
    quietly cmake --build "$binary"
}

# Builds decimesh, in $work/build, and installs it in a prefix.
install_decimesh() {
    say "building and installing decimesh"
    build . "$work/build" -DDECIMESH_BUILD_TESTS=OFF -DDECIMESH_BUILD_EXAMPLES=OFF \
        -DCMAKE_INSTALL_LIBDIR=lib "-DDECIMESH_CARGO_TARGET_DIR=$target"
    quietly cmake --install "$work/build" --prefix "$1"
}

# Builds the decimesh command, and sets `command` to it.
build_command() {
    quietly cargo build --locked --release -p decimesh-cli --target-dir "$target"
    command=$target/release/decimesh
}

# Runs the tests of a CMake project.
run_tests() {
    say "its tests"
    quietly ctest --test-dir "$1" --output-on-failure --no-tests=error -j 2
    grep 'tests passed' "$work/log"
}
