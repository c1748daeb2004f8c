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
  --blocks   blocks of 12 delta instead of 32, so that small volumes have many, on one thread: a copy
             of the sources with this side is built for it
  --help     this text
Exit status: 0 when all surfaces are closed, manifold, oriented outward and free of intersections,
and files, words and exit statuses agree.
USAGE
}

jobs=
program=$build/vtk/bin/volumic
blocks= # the folder of the copy
labels=
numbers=()
take_option()
{
  case $1 in
    --jobs)
      need_number "$@"
      jobs=$2
      ;;
    --blocks) blocks=$build/campaign-blocks ;;
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

# No option of the command does this: the side is no user's choice.
build_blocks()
{
  local vtk_options
  local options=$blocks/sources/Filters/Core/Evolution/SurfaceOptions.h
  find_vtk
  mkdir -p "$blocks/sources"
  tar -C "$root" --exclude=./build --exclude=./.git -cf - . | tar -C "$blocks/sources" -xf -
  grep -q " BlockSide = " "$options" || fail "There is no BlockSide in $options."
  sed -i "s/ BlockSide = [^;]*;/ BlockSide = 12.;/" "$options"
  cmake -S "$blocks/sources" -B "$blocks/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DVOLUMIC_BUILD_TOOL=ON -DVOLUMIC_WRAP_PYTHON=OFF "${vtk_options[@]}"
  cmake --build "$blocks/build" --target volumic -j "$(job_count)"
}

check_system
plan_steps "$([ -n "$blocks" ] && echo 4 || echo 3)"
mapfile -t needed < <(vtk_packages)
install_packages "${tool_packages[@]}" "${test_packages[@]}" "${needed[@]}"
run_step "Configuring for VTK" configure-vtk configure_vtk -DVOLUMIC_BUILD_TESTING=ON
run_step "Building the command and the judge" build-campaign build_campaign
if [ -n "$blocks" ]; then
  run_step "Building it with small blocks" build-campaign-blocks build_blocks
  program=$blocks/build/bin/volumic
  export VTK_SMP_BACKEND_IN_USE=Sequential # Blocks that do not touch are too near to each other.
fi
mkdir -p "$build/campaign"
nice "$(vtk_python)" "$root/Testing/Campaign/campaign.py" --program "$program" \
  --judge "$build/vtk/bin/JudgeFiles" --folder "$build/campaign" --seeds "${numbers[0]}" \
  --first "${numbers[1]:-1}" --jobs "${jobs:-$(nproc)}" $labels
