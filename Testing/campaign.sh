#!/bin/bash
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# A campaign: the command on random volumes with random settings, many of them stopped on their way.
# CGAL judges every surface that it writes: each level, each snapshot, each label. No test of CI, as
# thousands of seeds take an hour; what it finds becomes a test.

set -eo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../CMake/debian.sh"

usage()
{
  cat << 'USAGE'
Usage: bash Testing/campaign.sh [OPTION]... SEEDS [FIRST]
SEEDS runs from seed FIRST on (1). A line is printed for each with an exception, or with more than
20 s of processor time, whose files stay in build/campaign/SEED; its file `command` is the command
line, to be run there. `campaign.sh 1 SEED` keeps the files whatever comes out.
  --labels   small maps of labels, also judged against their voxels and against each other
  --jobs N   runs at a time (default: one for each processor)
  --sweeps   all but the smallest levels evolve block by block, as only those of many voxels do: a
             copy of the sources with other bounds is built for it
  --help     this text
Exit status: 0 when all surfaces are closed, manifold, oriented outward and free of intersections,
and files, words and exit statuses agree.
USAGE
}

jobs=
program=$build/vtk/bin/volumic
sweeps= # the folder of the copy
labels=
numbers=()
take_option()
{
  case $1 in
    --jobs)
      need_number "$@"
      jobs=$2
      ;;
    --sweeps) sweeps=$build/campaign-sweeps ;;
    --labels) labels=--labels ;;
    *)
      [[ $1 =~ ^[0-9]+$ && ${#numbers[@]} -lt 2 ]] || return 1
      numbers+=("$1")
      ;;
  esac
}
parse_options "$@"
[ ${#numbers[@]} -gt 0 ] || fail "How many seeds? Try --help."

build_campaign() { cmake --build "$build/vtk" --target volumic JudgeFiles -j "$(job_count)"; }

# No option of the command does this: the bounds are no user's choice.
build_sweeps()
{
  local vtk_options bound
  local options=$sweeps/sources/Filters/Core/Evolution/SurfaceOptions.h
  find_vtk
  mkdir -p "$sweeps/sources"
  tar -C "$root" --exclude=./build --exclude=./.git -cf - . | tar -C "$sweeps/sources" -xf -
  for bound in "MostVoxels = 1000" "MostVertices = 200" "BlockSide = 16."; do
    grep -q " ${bound%% *} = " "$options" || fail "There is no ${bound%% *} in $options."
    sed -i "s/ ${bound%% *} = [^;]*;/ $bound;/" "$options"
  done
  cmake -S "$sweeps/sources" -B "$sweeps/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DVOLUMIC_BUILD_TOOL=ON -DVOLUMIC_WRAP_PYTHON=OFF "${vtk_options[@]}"
  cmake --build "$sweeps/build" --target volumic -j "$(job_count)"
}

check_system
plan_steps "$([ -n "$sweeps" ] && echo 4 || echo 3)"
mapfile -t needed < <(vtk_packages)
install_packages "${tool_packages[@]}" "${test_packages[@]}" "${needed[@]}"
run_step "Configuring for VTK" configure-vtk configure_vtk -DVOLUMIC_BUILD_TESTING=ON
run_step "Building the command and the judge" build-campaign build_campaign
if [ -n "$sweeps" ]; then
  run_step "Building what evolves in sweeps" build-campaign-sweeps build_sweeps
  program=$sweeps/build/bin/volumic
fi
mkdir -p "$build/campaign"
nice "$(vtk_python)" "$root/Testing/Campaign/campaign.py" --program "$program" \
  --judge "$build/vtk/bin/JudgeFiles" --folder "$build/campaign" --seeds "${numbers[0]}" \
  --first "${numbers[1]:-1}" --jobs "${jobs:-$(nproc)}" $labels
