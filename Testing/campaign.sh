#!/bin/bash
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs the command on random volumes with random settings; many runs are stopped early. CGAL judges
# every written surface: levels, snapshots and labels. Not part of CI: thousands of seeds take an hour.
# Faults that it finds become tests.

set -eo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../CMake/debian.sh"

usage()
{
  cat << 'USAGE'
Usage: bash Testing/campaign.sh [OPTION]... SEEDS [FIRST]
Runs SEEDS seeds from FIRST (default 1). Prints a line for each seed with an exception or more than
20 s of processor time and keeps its files in build/campaign/SEED. The file `command` there is the
command line, to be run in that folder. `campaign.sh 1 SEED` always keeps the files.
  --labels   small label maps, also judged against their voxels and against each other
  --jobs N   number of parallel runs (default: one per processor)
  --help     print this text
Exit status: 0 if all surfaces are closed, manifold, oriented outward and free of intersections, and
files, messages and exit statuses agree.
USAGE
}

jobs=
program=$build/vtk/bin/volumic
labels=
numbers=()
take_option()
{
  case $1 in
    --jobs)
      need_number "$@"
      jobs=$2
      ;;
    --labels) labels=--labels ;;
    *)
      [[ $1 =~ ^[0-9]+$ && ${#numbers[@]} -lt 2 ]] || return 1
      numbers+=("$1")
      ;;
  esac
}
parse_options "$@"
[ ${#numbers[@]} -gt 0 ] || fail "The number of seeds is missing. See --help."

build_campaign() { cmake --build "$build/vtk" --target VolumicPythonStubs JudgeFiles -j "$(job_count)"; }

check_system
plan_steps 3
mapfile -t needed < <(vtk_packages)
install_packages "${tool_packages[@]}" "${test_packages[@]}" "${needed[@]}"
run_step "Configuring for VTK" configure-vtk configure_vtk -DVOLUMIC_BUILD_TESTING=ON
run_step "Building the command and the judge" build-campaign build_campaign
mkdir -p "$build/campaign"
nice "$(vtk_python)" "$root/Testing/Campaign/campaign.py" --program "$program" \
  --judge "$build/vtk/bin/JudgeFiles" --folder "$build/campaign" --seeds "${numbers[0]}" \
  --first "${numbers[1]:-1}" --jobs "${jobs:-$(nproc)}" $labels
