#!/bin/bash
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Builds the benchmarks and runs them: the pyramid on the skull CT of Debian's invesalius-examples
# and on a generated volume, then the surface on the skull, with the judge's verdict. The machine
# should have nothing else to do.

set -eo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../../CMake/debian.sh"

usage()
{
  cat << 'USAGE'
Usage: bash Testing/Benchmarks/run.sh [OPTION]...
  --with-itk           install ITK (large), to be compared with too; used anyway where it is there
  --generate SIZE      voxels along the axes of the generated volume (default 512; 0: leave it out)
  --repetitions N      per program and volume (default 15 on the skull, 5 on the generated volume)
  --help               this text
Tables are printed; every repetition is left in build/benchmarks/*.json, the surface in surface.vtp.
USAGE
}

generated_size=512
repetitions=
packages=("${tool_packages[@]}" libbenchmark-dev libcgal-dev invesalius-examples)
while [ $# -gt 0 ]; do
  case $1 in
    --with-itk) packages+=(libinsighttoolkit5-dev) ;;
    --generate | --repetitions)
      [[ ${2:-} =~ ^[0-9]+$ ]] || fail "$1 needs a number"
      if [ "$1" = --generate ]; then generated_size=$2; else repetitions=$2; fi
      shift
      ;;
    -h | --help)
      usage
      exit 0
      ;;
    *)
      usage >&2
      fail "Unknown option: $1"
      ;;
  esac
  shift
done

results=$build/benchmarks
mkdir -p "$results"

check_system
plan_steps 4
mapfile -t needed < <(vtk_packages)
install_packages "${packages[@]}" "${needed[@]}"
build_vtk_flavour -DVOLUMIC_BUILD_BENCHMARKS=ON
run_step "Reading the skull CT" benchmark-skull \
  "$(vtk_python)" "$root/Examples/Python/read_volume.py" \
  /usr/share/doc/invesalius-examples/examples/Cranium.inv3 "$results/skull.vti"

sed -n 's/^model name[^:]*: /Processor: /p' /proc/cpuinfo | sort -u
"$build/vtk/bin/BenchmarkImagePyramid" --volume "$results/skull.vti" \
  --repetitions "${repetitions:-15}" --benchmark_out="$results/pyramid-skull.json"
if [ "$generated_size" -gt 0 ]; then
  "$build/vtk/bin/BenchmarkImagePyramid" --generate "$generated_size" \
    --repetitions "${repetitions:-5}" --benchmark_out="$results/pyramid-generated.json"
fi
say ""
"$build/vtk/bin/MeasureSurface" --volume "$results/skull.vti" --iso 226.5 --peer \
  --output "$results/surface.vtp"
