#!/bin/bash
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs missing packages on Debian, builds Volumic for VTK and for ParaView under build/, and runs
# the tests of both builds. Later runs are incremental.

set -eo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../CMake/debian.sh"

usage()
{
  cat << 'USAGE'
Usage: bash Testing/run.sh [OPTION]...
  --vtk-only        only the library, the Python package and their tests
  --paraview-only   only the ParaView plugin and its tests
  -R REGEX          only tests whose name matches
  --help            print this text
USAGE
}

flavours=(vtk paraview)
selection=(--no-tests=error)
take_option()
{
  case $1 in
    --vtk-only) flavours=(vtk) ;;
    --paraview-only) flavours=(paraview) ;;
    -R)
      need_value "a regular expression" "$@"
      selection=(-R "$2") # may select no test of one build
      ;;
    *) return 1 ;;
  esac
}
parse_options "$@"

# run_tests FLAVOUR: a step that prints its output at once. After a failure the tests of the other
# build run too.
failed=0
run_tests()
{
  local flavour=$1 log=$logs/test-$1.log status
  step_number=$((step_number + 1))
  say "[$step_number/$step_total] Testing ($flavour)"
  set +e
  (cd "$build/$flavour" && ctest --output-on-failure -j "$(job_count)" "${selection[@]}") \
    2>&1 < /dev/null | tee "$log"
  status=${PIPESTATUS[0]}
  set -e
  [ "$status" -eq 0 ] || failed=1
}

# summarize FLAVOUR: print one line from ctest's output.
summarize()
{
  local log=$logs/test-$1.log passed skipped broken seconds
  passed=$(grep -cE '^ *[0-9]+/[0-9]+ Test .* Passed ' "$log" || true)
  skipped=$(grep -cE '^ *[0-9]+/[0-9]+ Test .*\*\*\*(Skipped|Not Run \(Disabled\))' "$log" || true)
  broken=$(sed -n 's/.* \([0-9][0-9]*\) tests failed out of .*/\1/p' "$log")
  seconds=$(sed -n 's/^Total Test time (real) = *//p' "$log")
  printf '  %-9s %4d passed  %3d failed  %3d skipped   %s   %s\n' "$1" "$passed" \
    "${broken:-0}" "$skipped" "$seconds" "$log"
}

# slowest: print the ten slowest tests of all builds. The last command of the pipe reads all lines:
# closing the pipe early would stop `sort` and the script.
slowest()
{
  local flavour
  for flavour in "${flavours[@]}"; do
    sed -nE "s/^ *[0-9]+\/[0-9]+ Test +#[0-9]+: ([^ ]+) .* ([0-9.]+) sec.*/\2 s  $flavour \1/p" \
      "$logs/test-$flavour.log"
  done | sort -rn | sed -n '1,10s/^/  /p'
}

# use_ccache: both builds share many object files. In the mode `depend`, ccache gets the list of
# headers from the compiler and supports precompiled headers.
use_ccache()
{
  ccache_options=()
  command -v ccache > /dev/null || return 0
  export CCACHE_DEPEND=1 CCACHE_SLOPPINESS=pch_defines,time_macros
  export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1
  ccache_options=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
}

check_system
plan_steps $((1 + $(skull_steps) + 3 * ${#flavours[@]}))

mapfile -t packages < <(skull_packages; available "${optional_test_packages[@]}")
packages+=("${tool_packages[@]}" "${test_packages[@]}")
for flavour in "${flavours[@]}"; do
  mapfile -t needed < <("${flavour}_packages")
  packages+=("${needed[@]}")
done
install_packages "${packages[@]}"
prepare_skull
use_ccache

for flavour in "${flavours[@]}"; do
  options=(-DVOLUMIC_BUILD_TESTING=ON -DVOLUMIC_BUILD_EXAMPLES=ON -DVOLUMIC_CRANIUM="$(cranium)"
    "${ccache_options[@]}")
  "build_${flavour}_flavour" "${options[@]}"
done
test_logs=()
for flavour in "${flavours[@]}"; do
  run_tests "$flavour"
  test_logs+=("$logs/test-$flavour.log")
done

if ! grep -qE '^ *1/[0-9]+ Test ' "${test_logs[@]}"; then
  fail "No test matches."
fi
say ""
say "Summary, after $SECONDS s:"
for flavour in "${flavours[@]}"; do
  summarize "$flavour"
done
say "Slowest tests:"
slowest
if [ "$failed" -ne 0 ]; then
  fail "Some tests failed; see above or the logs."
fi
say "All tests passed."
if [[ " ${flavours[*]} " == *" paraview "* ]]; then
  say "To use the plugin, load
  $(find "$build/install-paraview" -name Volumic.so)
in $(paraview_prefix)/bin/paraview"
fi
