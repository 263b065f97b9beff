#!/usr/bin/env bash
# What a fresh Debian 12 with cargo, gcc, make and python3 lacks: a few system packages and .venv.
# Does nothing, quickly, where all is there.
# usage: tools/setup.sh [packages|python]    by default both
set -euo pipefail
cd "$(dirname "$0")/.."

python=${PYTHON:-python3}
what=${1:-all}
packages=(libhdf5-dev pkg-config)
# Libraries that the wheels of gmsh and vtk load but do not bring.
packages+=(libglu1-mesa libxft2 libxcursor1 libxinerama1 libfontconfig1 libxrender1 libgl1)
# Counts instructions where a test guards them.
packages+=(valgrind)
# Debian's python3 comes without the part that makes virtual environments.
"$python" -c 'import ensurepip' 2>/dev/null || packages+=(python3-venv)

if [ "$what" = python ]; then
    :
elif command -v dpkg-query >/dev/null; then
    tools/apt.sh "${packages[@]}"
else
    echo "not a Debian system: HDF5 (>= 1.10.7, not 1.12.0) with headers, pkg-config and OpenGL libraries are taken as given" >&2
fi

stamp=.venv/requirements.installed
if [ "$what" != packages ] && ! cmp -s tools/requirements.txt "$stamp"; then
    echo "python packages: into .venv (1.1 GB, once)"
    .venv/bin/python -c '' 2>/dev/null || "$python" -m venv --clear .venv
    .venv/bin/python -m pip install --quiet --disable-pip-version-check -r tools/requirements.txt
    cp tools/requirements.txt "$stamp"
fi
