#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Install missing packages on Debian, build the ParaView plugin under build/, and start ParaView with
# the plugin and the CT of a skull.

set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../CMake/debian.sh"

usage()
{
  cat << 'USAGE'
Usage: bash Examples/paraview.sh [--no-start]
  --no-start   build, and print how to start ParaView
  --help       print this help
USAGE
}

starts=yes
take_option()
{
  case $1 in
    --no-start) starts=no ;;
    *) return 1 ;;
  esac
}
parse_options "$@"

check_system
mapfile -t packages < <(paraview_packages; skull_packages)
plan_steps $((3 + $(skull_steps)))
install_packages "${tool_packages[@]}" "${packages[@]}"
prepare_skull
build_paraview_flavour -DVOLUMIC_BUILD_TESTING=OFF -DVOLUMIC_BUILD_EXAMPLES=OFF

plugin=$(find "$build/install-paraview" -name Volumic.so)
[ -n "$plugin" ] || fail "No plugin in $build/install-paraview; see $logs/build-paraview.log."
start=("$(paraview_prefix)/bin/paraview" --plugin-search-paths="$(dirname "$plugin")"
  --plugins=Volumic --data="$(cranium)")
say ""
say "Plugin: $plugin
To load the plugin in ParaView: Tools > Manage Plugins... > Load New..., choose this file, and check
Auto Load. To start ParaView with the plugin and the skull:
  ${start[*]}
Then press Apply, choose Filters > Volumic > Volume to Surface, set Iso Value to 226.5 (bone), and
press Apply."
if [ "$starts" = yes ] && [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
  exec "${start[@]}"
fi
