#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# From a bare Debian to ParaView with the plugin: installs what is missing, builds the plugin alone
# under build/, tells where it is, and starts ParaView with it and the CT of a skull.

set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../CMake/debian.sh"

usage()
{
  cat << 'USAGE'
Usage: bash Examples/paraview.sh [--no-start]
  --no-start   build, and tell how to start ParaView
  --help       this text
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
[ -n "$plugin" ] || fail "No plugin in $build/install-paraview. See $logs/build-paraview.log"
start=("$(paraview_prefix)/bin/paraview" --plugin-search-paths="$(dirname "$plugin")"
  --plugins=Volumic --data="$(cranium)")
say ""
say "The plugin: $plugin
To have it in each ParaView that you start: Tools > Manage Plugins... > Load New..., choose that
file, and tick Auto Load. ParaView with the plugin and the skull:
  ${start[*]}
There: Apply, Filters > Volumic > Volume to Surface, 226.5 as Iso Value for the bone, Apply."
if [ "$starts" = yes ] && [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
  exec "${start[@]}"
fi
