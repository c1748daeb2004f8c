#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Examples/quickstart.sh [VOLUME [ISO]] [--output DIR]
#
# Installs what is missing, builds Volumic for VTK under build/, and makes the surface of a volume:
# by default of the CT of a skull from Debian's package invesalius-examples; else of VOLUME (.vti,
# .mha, .mhd, .nrrd, .nii, .nii.gz, .inv3 or a folder with the slices of a DICOM series), at the
# value ISO (by default Otsu's threshold). The results go to build/quickstart/ or DIR.

set -euo pipefail

usage="Usage: bash Examples/quickstart.sh [VOLUME [ISO]] [--output DIR]
VOLUME: .vti, .mha, .mhd, .nrrd, .nii, .nii.gz, .inv3 or a folder with one DICOM series"

usage() { say "$usage"; }

script_folder=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=../CMake/debian.sh
. "$script_folder/../CMake/debian.sh"

output=$build/quickstart
inputs=()
take_option()
{
  case $1 in
    --output)
      need_value "a folder. $usage" "$@"
      output=$2
      ;;
    --output=*) output=${1#--output=} ;;
    -[!0-9.]*) fail "Unknown option $1. $usage" ;;
    *) inputs+=("$1") ;;
  esac
}
parse_options "$@"
[ "${#inputs[@]}" -le 2 ] || fail "Too many arguments. $usage"
if [ "${#inputs[@]}" -ge 1 ] && [ ! -e "${inputs[0]}" ]; then
  fail "${inputs[0]}: no such file or folder."
fi
if [ "${#inputs[@]}" -eq 2 ] \
  && ! [[ ${inputs[1]} =~ ^[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?$ ]]; then
  fail "The iso-value '${inputs[1]}' is not a number. $usage"
fi

check_system
mapfile -t packages < <(vtk_packages)
packages+=("${tool_packages[@]}" xvfb xauth libgl1-mesa-dri)
if [ "${#inputs[@]}" -eq 0 ]; then
  plan_steps $((3 + $(skull_steps)))
  mapfile -t -O "${#packages[@]}" packages < <(skull_packages)
else
  plan_steps 3
fi
install_packages "${packages[@]}"
if [ "${#inputs[@]}" -eq 0 ]; then
  prepare_skull
fi
build_vtk_flavour -DVOLUMIC_BUILD_TESTING=OFF -DVOLUMIC_BUILD_EXAMPLES=OFF

# Python's modules of the installed package, wherever this Python's version puts them.
site=$(find "$build/install-vtk" -type d -name volumic -path '*-packages/volumic' -print -quit)
[ -n "$site" ] || fail "No Python package in $build/install-vtk. See $logs/build-vtk.log"

say ""
# A negative iso-value must not be taken for an option: hence the --.
PYTHONPATH="$(dirname "$site")${PYTHONPATH:+:$PYTHONPATH}" PYTHONDONTWRITEBYTECODE=1 \
  VOLUMIC_CRANIUM=$(cranium) \
  xvfb-run -a -s "-screen 0 1280x1024x24 -noreset" \
  "$(vtk_python)" "$script_folder/Python/quickstart.py" --output "$output" -- "${inputs[@]}" \
  2> >(tee "$logs/quickstart-errors.log" >&2) \
  || fail "The example failed. Its errors are above and in $logs/quickstart-errors.log"

say ""
say "To use it yourself:"
say "  $build/install-vtk/bin/volumic --help"
say "  PYTHONPATH=$(dirname "$site") $(vtk_python) $script_folder/Python/segment.py --help"
