#!/bin/bash
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Builds and runs the C++ tests for VTK twice: with AddressSanitizer and UndefinedBehaviorSanitizer,
# and with ThreadSanitizer. Findings make tests fail. Flags, environment and selected tests are those
# of the presets `asan` and `tsan` in CMakePresets.json.

set -eo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../CMake/debian.sh"

usage()
{
  cat << 'USAGE'
Usage: bash Testing/sanitize.sh [OPTION]...
  --address-only    AddressSanitizer and UndefinedBehaviorSanitizer only
  --thread-only     ThreadSanitizer only
  -R REGEX          only tests whose name matches
  --help            print this text
USAGE
}

presets=(asan tsan)
selection=()
take_option()
{
  case $1 in
    --address-only) presets=(asan) ;;
    --thread-only) presets=(tsan) ;;
    -R)
      need_value "a regular expression" "$@"
      selection=(-R "$2")
      ;;
    *) return 1 ;;
  esac
}
parse_options "$@"

cd "$root" # cmake reads the presets there

# configure_sanitized PRESET: configure build/PRESET.
configure_sanitized()
{
  local vtk_options
  find_vtk
  cd "$root"
  # --fresh: the flags of the preset or the path of the checkout may have changed.
  cmake --fresh --preset "$1" "${vtk_options[@]}"
}

build_sanitized()
{
  cmake --build --preset "$1" -j "$(job_count)"
}

# run_sanitized PRESET: a step that prints its output at once.
failed=0
run_sanitized()
{
  local preset=$1 launcher=() status
  if [ "$preset" = tsan ]; then
    launcher=(setarch "$(uname -m)" -R)
  fi
  step_number=$((step_number + 1))
  say "[$step_number/$step_total] Testing ($preset)"
  set +e
  "${launcher[@]}" ctest --preset "$preset" -j "$(job_count)" "${selection[@]}" 2>&1 < /dev/null \
    | tee "$logs/$preset"
  status=${PIPESTATUS[0]}
  set -e
  [ "$status" -eq 0 ] || failed=1
}

check_system
plan_steps $((1 + 3 * ${#presets[@]}))
mapfile -t needed < <(vtk_packages)
install_packages "${tool_packages[@]}" "${test_packages[@]}" "${needed[@]}"
for preset in "${presets[@]}"; do
  run_step "Configuring ($preset)" "configure-$preset" configure_sanitized "$preset"
  run_step "Building ($preset)" "build-$preset" build_sanitized "$preset"
done
for preset in "${presets[@]}"; do
  run_sanitized "$preset"
done
if [ "$failed" -ne 0 ]; then
  fail "Some tests failed; see above, or the logs in $logs."
fi
say "All tests passed under the sanitizers."
