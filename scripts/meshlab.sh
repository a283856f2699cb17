#!/usr/bin/env bash
# Builds MeshLab's plugin (plugins/meshlab/) against an installed decimesh and runs its tests: in MeshLab's own
# meshlabserver, under Xvfb, in a copy of its tree. What Debian has to give is installed where it may be; MeshLab's
# sources, which have the headers, are fetched from where apt fetches packages.
#
#   scripts/meshlab.sh [--prefix PREFIX] [--command FILE] [--out DIR] [--cache DIR] [--pictures]
#
#   --prefix PREFIX  decimesh is installed there; without it, it is built, and installed beside the plugin
#   --command FILE   the decimesh command of the same version, which makes meshes to test with, and whose results are
#                    compared with the plugin's; without it, it is built
#   --out DIR        leave the plugin there (libfilter_decimesh.so); without it, nothing is left
#   --cache DIR      where MeshLab's sources are, or are to be left; otherwise a directory of the user's cache
#   --pictures       write the pictures of docs/meshlab.md anew
#
# The tests in MeshLab take the statue of `decimesh demo`, or, if MESH is set in the environment, that PLY file of some
# ten thousand triangles and more: docs/meshlab.md shows the Stanford bunny.
#
# Needs cargo, unless a prefix and a command are given.
set -euo pipefail

prefix=
command=
out=
pictures=
cache=${XDG_CACHE_HOME:-$HOME/.cache}/decimesh
while [ $# -gt 0 ]; do
    case $1 in
    --prefix) prefix=$(realpath "$2"); shift 2 ;;
    --command) command=$(realpath "$2"); shift 2 ;;
    --out) mkdir -p "$2"; out=$(realpath "$2"); shift 2 ;;
    --cache) cache=$2; shift 2 ;;
    --pictures) pictures=yes; shift ;;
    *) echo "meshlab: there is no option $1" >&2; exit 2 ;;
    esac
done
mkdir -p "$cache"
cache=$(realpath "$cache")
if [ -n "${MESH:-}" ]; then
    MESH=$(realpath "$MESH")
    export MESH
fi

name=meshlab
. "$(dirname "${BASH_SOURCE[0]}")/outside.sh"
out=${out:-$work/meshlab}

need_packages meshlab g++ cmake ninja-build doctest-dev python3 dpkg-dev \
    qtbase5-dev libqt5opengl5-dev libeigen3-dev libglew-dev \
    xvfb xauth libgl1-mesa-dri

# MeshLab's sources, of the version that is installed. apt is asked for sources from where it has packages from, in a
# configuration and a state of its own: the machine's stay as they are.
fetch_sources() {
    local version=$1 apt=$work/apt
    mkdir -p "$apt/lists/partial" "$apt/cache/archives/partial" "$apt/none"
    apt-get indextargets --format 'deb-src $(REPO_URI) $(RELEASE) $(COMPONENT)' \
        'Created-By: Packages' 'Origin: Debian' | sort -u >"$apt/sources.list"
    local apart=(-q -o "Dir::Etc::SourceList=$apt/sources.list" -o "Dir::Etc::SourceParts=$apt/none"
        -o "Dir::State::Lists=$apt/lists" -o "Dir::Cache=$apt/cache" -o "APT::Sandbox::User=$(id -un)")
    quietly apt-get "${apart[@]}" update
    (cd "$apt" && quietly apt-get "${apart[@]}" source --download-only "meshlab=$version")
    quietly dpkg-source -x "$apt"/meshlab_*.dsc "$apt/meshlab"
    # Whole or not at all, for the next run takes what is there.
    rm -rf "$sources.new"
    cp -r "$apt/meshlab" "$sources.new"
    mv "$sources.new" "$sources"
}

version=$(dpkg-query -W -f '${source:Version}' meshlab)
sources=$cache/meshlab-$version
if [ ! -d "$sources" ]; then
    say "fetching the sources of MeshLab $version"
    fetch_sources "$version"
fi

if [ -z "$prefix" ]; then
    prefix=$out/decimesh
    install_decimesh "$prefix"
fi
[ -n "$command" ] || build_command

say "building the plugin"
build plugins/meshlab "$out" "-DCMAKE_PREFIX_PATH=$prefix" \
    "-DMESHLAB_SOURCE=$sources" "-DMESHLAB_PLUGIN_DECIMESH_COMMAND=$command" -DCMAKE_COMPILE_WARNING_AS_ERROR=ON
run_tests "$out"

if [ -n "$pictures" ]; then
    mkdir -p docs/images
    cp "$out"/tests/meshlab-*.png docs/images/
    say "the pictures are in docs/images"
fi
say "all well in $SECONDS s"
