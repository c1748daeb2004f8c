#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Examples/quickstart.sh [VOLUME [ISO]] [--output DIR]
#
# Install missing packages, build Volumic for VTK under build/, and compute the surface of a volume
# with the command `volumic`. VOLUME is a file or a folder of DICOM slices (default: the skull CT in
# Debian's package invesalius-examples), ISO the iso-value (default: Otsu's threshold). Results are
# written to build/quickstart/ or DIR.

set -euo pipefail

usage="Usage: bash Examples/quickstart.sh [VOLUME [ISO]] [--output DIR]
VOLUME: a file such as scan.nii.gz, or a folder of DICOM slices"

usage() { say "$usage"; }

# shellcheck source=../CMake/debian.sh
. "$(dirname "${BASH_SOURCE[0]}")/../CMake/debian.sh"

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
copy=volume.vti
steps=5
mapfile -t packages < <(vtk_packages)
if [ "${#inputs[@]}" -eq 0 ]; then
  inputs=("$(cranium)" 226.5) # bone; between two integers, so that no voxel equals it
  copy=skull.vti
  steps=$((steps + $(skull_steps)))
  mapfile -t -O "${#packages[@]}" packages < <(skull_packages)
elif [[ ${inputs[0]} == *.vti ]]; then
  copy= # ParaView reads .vti
fi
plan_steps $steps
install_packages "${tool_packages[@]}" "${packages[@]}" xvfb xauth libgl1-mesa-dri
[ "$copy" != skull.vti ] || prepare_skull
build_vtk_flavour -DVOLUMIC_BUILD_TESTING=OFF -DVOLUMIC_BUILD_EXAMPLES=OFF

command=$build/install-vtk/bin/volumic
# The folder depends on the Python version.
package=$(find "$build/install-vtk" -path '*-packages/volumic' -print -quit)
make_surface()
{
  mkdir -p "$output"
  "$command" "${inputs[0]}" "$output/surface.vtp" ${inputs[1]:+"--iso=${inputs[1]}"} \
    --levels-output "$output/levels.vtm" --history "$output/history.csv" \
    --report "$output/report.json" ${copy:+--write-volume "$output/$copy"}
}
draw_pictures()
{
  PYTHONPATH=${package%/volumic} PYTHONDONTWRITEBYTECODE=1 \
    xvfb-run -a -s "-screen 0 1280x1024x24 -noreset" \
    "$(vtk_python)" "$root/Examples/Python/pictures.py" "${inputs[0]}" "$output"
}
run_step "Computing the surface" quickstart-surface make_surface
run_step "Drawing pictures" quickstart-pictures draw_pictures

say ""
cat "$logs/quickstart-surface.log"
say "Written to $output: $(ls -m "$output" | tr '\n' ' ')"
say "To use Volumic:
  $command --help
  PYTHONPATH=${package%/volumic} $(vtk_python) -c 'import volumic; help(volumic)'"
