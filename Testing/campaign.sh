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
  --help     this text
Exit status: 0 when all surfaces are closed, manifold, oriented outward and free of intersections,
and files, words and exit statuses agree.
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
[ ${#numbers[@]} -gt 0 ] || fail "How many seeds? Try --help."

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
