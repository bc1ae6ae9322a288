#!/usr/bin/env bash
# Build the mooring codes that are no Python packages, bring RAFT, and run the tests that need them:
#   benchmarks/build_clients.sh FOLDER
# Needs git, make, cmake, gcc, gfortran, flex, bison, zlib, BLAS and LAPACK with their headers.
set -euo pipefail
project=$(cd "$(dirname "$0")/.." && pwd)
folder=${1:?"a folder to build in"}
mkdir -p "$folder"
cd "$folder"

# the commits that the figures of docs/export.md are of
[ -d openfast ] || git clone -q https://github.com/OpenFAST/openfast.git
git -C openfast checkout -q 2895884d
cmake -S openfast -B openfast-build -DCMAKE_BUILD_TYPE=Release -DDOUBLE_PRECISION=ON -DBUILD_TESTING=OFF
make -C openfast-build -j2 moordyn_driver

[ -d cable ] || git clone -q https://github.com/jgobat/cable.git # 3.12
make -C cable OS=nox

# RAFT brings MoorPy 1.2.1, which has no tables: an environment of its own
[ -d raft ] || python -m venv raft
raft/bin/pip install -q openraft==2.0.4 pytest pytest-xdist hypothesis "$project"
raft=$PWD/raft/bin/python

export PATH="$PWD/openfast-build/modules/moordyn:$PWD/cable/cli:$PATH"
cd "$project"
python -m pytest -q -rs tests/oracle/test_openfast.py tests/oracle/test_whoi_cable.py \
    tests/oracle/test_client_runs.py
"$raft" -m pytest -q -rs tests/oracle/test_client_runs.py -k raft
