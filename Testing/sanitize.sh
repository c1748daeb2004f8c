#!/bin/bash
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Builds the C++ tests twice more, for VTK, and runs them: with AddressSanitizer and
# UndefinedBehaviorSanitizer, and with ThreadSanitizer. What they find makes tests fail.

set -eo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../CMake/debian.sh"

usage()
{
  cat << 'USAGE'
Usage: bash Testing/sanitize.sh [OPTION]...
  --address-only    AddressSanitizer and UndefinedBehaviorSanitizer only
  --thread-only     ThreadSanitizer only
  -R REGEX          only the tests whose name matches
  --help            this text
USAGE
}

kinds=(address thread)
selection=()
while [ $# -gt 0 ]; do
  case $1 in
    --address-only) kinds=(address) ;;
    --thread-only) kinds=(thread) ;;
    -R)
      [ $# -ge 2 ] || fail "-R needs a regular expression"
      selection=(-R "$2")
      shift
      ;;
    -h | --help)
      usage
      exit 0
      ;;
    *)
      usage >&2
      fail "Unknown option: $1"
      ;;
  esac
  shift
done

# Optimised a little, or the tests would take too long.
flags="-O1 -g -fno-omit-frame-pointer"
declare -A sanitizers=(
  [address]="-fsanitize=address,undefined -fno-sanitize-recover=undefined"
  [thread]="-fsanitize=thread")

# Exhausted memory is what some tests are about: it must come back as an error, as without ASan.
export ASAN_OPTIONS="allocator_may_return_null=1:strict_string_checks=1:check_initialization_order=1"
export UBSAN_OPTIONS="print_stacktrace=1"
export TSAN_OPTIONS="second_deadlock_stack=1"

# configure_sanitized KIND: the tree build/sanitize-KIND.
configure_sanitized()
{
  local prefix directory=()
  prepare_vtk
  prefix=$(vtk_prefix)
  if [ -n "$prefix" ]; then
    directory=(-DVTK_DIR="$(echo "$prefix/usr/lib/$(multiarch)"/cmake/vtk-*)")
  fi
  # The type of build brings flags of its own, which stand behind these: none.
  configure "sanitize-$1" -DVOLUMIC_BUILD_PARAVIEW_PLUGIN=OFF -DVOLUMIC_BUILD_TESTING=ON \
    -DVOLUMIC_WRAP_PYTHON=OFF -DPython3_EXECUTABLE="$(vtk_python)" "${directory[@]}" \
    -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS="$flags ${sanitizers[$1]}"
}

build_sanitized()
{
  cmake --build "$build/sanitize-$1" -j "$(job_count)"
}

# run_sanitized KIND: one step, whose output is shown as it comes.
failed=0
run_sanitized()
{
  local kind=$1 labels='core|filters|support|scenes' launcher=() status
  if [ "$kind" = thread ]; then
    # Those that use threads. ThreadSanitizer of GCC 12 wants addresses that are not randomised. Of
    # VTK's backends it can follow the one of std::thread; TBB, which Debian does not compile with it,
    # would be one race.
    labels='core|filters'
    launcher=(env VTK_SMP_BACKEND_IN_USE=STDThread setarch "$(uname -m)" -R)
  fi
  step_number=$((step_number + 1))
  say "[$step_number/$step_total] Testing ($kind)"
  set +e
  (cd "$build/sanitize-$kind" && "${launcher[@]}" ctest --output-on-failure -j "$(job_count)" \
    --no-tests=error -L "$labels" "${selection[@]}") 2>&1 < /dev/null \
    | tee "$logs/sanitize-$kind"
  status=${PIPESTATUS[0]}
  set -e
  [ "$status" -eq 0 ] || failed=1
}

check_system
plan_steps $((1 + 3 * ${#kinds[@]}))
mapfile -t needed < <(vtk_packages)
install_packages "${tool_packages[@]}" "${test_packages[@]}" "${needed[@]}"
for kind in "${kinds[@]}"; do
  run_step "Configuring ($kind)" "configure-sanitize-$kind" configure_sanitized "$kind"
  run_step "Building ($kind)" "build-sanitize-$kind" build_sanitized "$kind"
done
for kind in "${kinds[@]}"; do
  run_sanitized "$kind"
done
if [ "$failed" -ne 0 ]; then
  fail "Some tests failed; see above, or the logs in $logs."
fi
say "All tests passed under the sanitizers."
