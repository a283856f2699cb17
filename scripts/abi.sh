#!/usr/bin/env bash
# Holds the C ABI to its committed record, which a program linked to an older decimesh relies on:
#   abi/symbols.txt    what libdecimesh.so exports: every function of the header, and nothing else
#   abi/constants.txt  the header's constants; values are never reused
#   abi/decimesh.abi   the functions' signatures and the structs' layouts (libabigail)
#
#   scripts/abi.sh [--update] [LIBRARY]
#
# LIBRARY is the shared library to look at; without it, cargo builds one. --update writes the record anew and shows
# what changed: lines may come, but none may change or go before the major version does.
#
# Needs a C compiler, binutils and libabigail's tools.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=$PWD

update=
if [ "${1:-}" = --update ]; then
    update=yes
    shift
fi
if ! command -v abidiff >/dev/null; then
    echo "abi: abidiff is missing; Debian's package is abigail-tools" >&2
    exit 1
fi
if [ $# -gt 0 ]; then
    library=$1
else
    cargo build --locked --release --lib
    library=${CARGO_TARGET_DIR:-target}/release/libdecimesh.so
fi

export LC_ALL=C
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

exported_symbols() {
    nm --dynamic --defined-only --format=just-symbols "$library" | sort
}

# Versions are meant to change.
constants() {
    cc -E -dM -x c include/decimesh.h | sed -n 's/^#define \(DECIMESH_[A-Z0-9_]* .\)/\1/p' |
        grep -v '^DECIMESH_VERSION_' | sort
}

# The library's own debug information describes Rust's types, which differ from compiler to compiler. A C file with a
# pointer to each function has the header's types and nothing else.
types() {
    {
        echo '#include "decimesh.h"'
        sed 's/.*/__typeof__(\&&) type_of_&;/' abi/symbols.txt
    } >"$work/types.c"
    # From within, so that the record names no directory.
    (cd "$work" && cc -std=gnu11 -g -shared -fPIC "-I$root/include" -o types.so types.c)
    abidw --no-architecture --no-corpus-path --no-comp-dir-path --no-show-locs --type-id-style hash \
        --out-file "$work/decimesh.abi" "$work/types.so"
}

# Harmless changes too: a renamed field breaks no program that runs, but one that is compiled.
compare_types() {
    abidiff --harmless --no-architecture abi/decimesh.abi "$work/types.so"
}

hold() {
    local record=$1 found=$2
    if [ -n "$update" ]; then
        diff -u "$record" "$found" || true
        cp "$found" "$record"
    else
        diff -u "$record" "$found" || fail "$record does not hold"
    fi
}

fail() {
    echo "abi: $1; if it is meant, run scripts/abi.sh --update" >&2
    exit 1
}

exported_symbols >"$work/symbols.txt"
if grep -v '^decimesh_' "$work/symbols.txt"; then
    echo "abi: $library exports these, which are not decimesh_*" >&2
    exit 1
fi
hold abi/symbols.txt "$work/symbols.txt"

constants >"$work/constants.txt"
hold abi/constants.txt "$work/constants.txt"

types
if [ -n "$update" ]; then
    compare_types || true
    cp "$work/decimesh.abi" abi/decimesh.abi
else
    compare_types || fail "abi/decimesh.abi does not hold"
fi

major=$(sed -n 's/^version = "\([0-9]*\).*/\1/p' Cargo.toml | head -1)
soname=$(readelf --dynamic "$library" | sed -n 's/.*(SONAME).*\[\(.*\)\]/\1/p')
if [ "$soname" != "libdecimesh.so.$major" ]; then
    echo "abi: $library calls itself '$soname', not libdecimesh.so.$major" >&2
    exit 1
fi
if ! readelf --dynamic "$library" | grep -q NODELETE; then
    echo "abi: $library can be unloaded while its threads run; build.rs forbids that" >&2
    exit 1
fi
echo "abi: $(wc -l <abi/symbols.txt) functions, $(wc -l <abi/constants.txt) constants, soname $soname: as recorded"
