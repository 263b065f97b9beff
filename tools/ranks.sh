#!/usr/bin/env bash
# The program on several ranks: builds the member `ranks/` and runs it, where there is an MPI. It installs nothing but OpenMPI by apt, and
# that only as root on Debian. Where no MPI can be had it says so in one line, and that is no failure.
set -euo pipefail
cd "$(dirname "$0")/.."

has_mpi() { command -v "${MPICC:-mpicc}" >/dev/null && command -v mpirun >/dev/null; }
has_mpi || tools/apt.sh openmpi-bin libopenmpi-dev || true
if ! has_mpi; then
    echo "skipped: runs on several ranks (mpicc or mpirun is not there and could not be installed)"
    exit 0
fi

# Where several MPIs are installed, that of mpirun: the build would take the one that pkg-config names first.
export MPICC="${MPICC:-mpicc}"
# Both packages are named, so that crates get the features that they have in `cargo test`: none is built twice.
cargo test --release --quiet -p dgmpm -p dgmpm-ranks --test arguments
cargo build --release -p dgmpm -p dgmpm-ranks --bin dgmpm --bin dgmpm-mpi --example panics
target=$(dirname "$(DGMPM='' tools/program.sh)")

# What a container, root, and more ranks than processors need of OpenMPI; other MPIs do not look at it. docs/ranks.md explains each.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
export OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_btl=self,vader OMPI_MCA_btl_vader_single_copy_mechanism=none
"${PYTHON:-python3}" tools/ranks.py "$target" "$@"
