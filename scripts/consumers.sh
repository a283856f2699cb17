#!/usr/bin/env bash
# Builds and runs programs that know nothing of this repository but what a user gets: an installed prefix, found by
# CMake and by pkg-config, then the same prefix after it was moved and the build tree is gone, and the sources, added
# to a CMake project. The first thing that is not as promised ends the run.
#
# Needs cargo, CMake 3.25, Ninja, make, pkg-config, a C and a C++ compiler, and binutils.
set -euo pipefail
name=consumers
. "$(dirname "${BASH_SOURCE[0]}")/outside.sh"
root=$PWD

# Runs a program, and sees whether it loads the shared library as it should.
run() {
    local program=$1 loads=no
    if readelf --dynamic "$program" | grep -q 'NEEDED.*\[libdecimesh\.so\.[0-9]*\]'; then
        loads=yes
    fi
    case $program in
    *-shared) [ $loads = yes ] || fail "$program does not load the shared library" ;;
    *-static) [ $loads = no ] || fail "$program loads the shared library" ;;
    esac
    say "$(basename "$(dirname "$program")")/$(basename "$program"): $("$program")"
}

run_all() {
    local program
    for program in "$@"; do
        run "$program"
    done
}

# Everything that can be built from a prefix.
consume() {
    local prefix=$1 out=$2
    build cpp-tests/consumers/find_package "$out/find_package" "-DCMAKE_PREFIX_PATH=$prefix"
    run_all "$out"/find_package/{cpp-shared,cpp-static,c-shared}
    local example
    for example in "$out"/find_package/examples/{c/decimesh-example-c,cpp/decimesh-example-cpp}-*; do
        quietly "$example"
    done

    mkdir -p "$out/pkg_config"
    PKG_CONFIG_PATH=$prefix/lib/pkgconfig quietly make -C cpp-tests/consumers/pkg_config "OUT=$out/pkg_config"
    run_all "$out"/pkg_config/{c-shared,c-static,c-all-static}
}

# A prefix can be moved only if no file in it says where it, its sources or its build were.
check_relocatable() {
    local prefix=$1 place
    for place in "$work" "$root" "$target"; do
        if grep --recursive --binary-files=without-match --fixed-strings "$place" "$prefix"; then
            fail "an installed file names $place"
        fi
    done
}

# Rust's standard library must not meet another one of its kind in a program.
check_static_symbols() {
    LC_ALL=C nm --extern-only --defined-only --format=just-symbols "$1" 2>/dev/null |
        grep -v -e '^$' -e ':$' | LC_ALL=C sort >"$work/symbols"
    diff -u abi/symbols.txt "$work/symbols" || fail "$1 shows other symbols than the shared library"
}

install_decimesh "$work/prefix"
check_relocatable "$work/prefix"
check_static_symbols "$work/prefix/lib/libdecimesh.a"

say "from the installed prefix"
consume "$work/prefix" "$work/installed"

say "from the prefix moved, without the build tree"
rm -rf "$work/build" "$work/installed"
mkdir "$work/elsewhere"
mv "$work/prefix" "$work/elsewhere/moved prefix"
consume "$work/elsewhere/moved prefix" "$work/moved"

say "from the sources, by add_subdirectory"
build cpp-tests/consumers/add_subdirectory "$work/added" \
    "-DDECIMESH_SOURCE=$root" "-DDECIMESH_CARGO_TARGET_DIR=$target"
run_all "$work"/added/{cpp-shared,c-static}
say "all well in $SECONDS s"
