#!/bin/bash
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Breaks the core on purpose, in one place at a time (Testing/mutations.txt), in a copy of the
# sources, and looks whether the tests of the core notice.

set -eo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../CMake/debian.sh"

usage()
{
  cat << 'USAGE'
Usage: bash Testing/mutate.sh [OPTION]...
  -R REGEX   only the mutations whose file or description matches
  --check    only look whether each mutation has its place in the sources
  --help     this text
Exit status: 0 when the tests have noticed every mutation, 1 when one has survived, or when one has
no place in the sources or does not compile, which is an error of the list.
USAGE
}

selection=
check_only=false
take_option()
{
  case $1 in
    -R)
      need_value "a regular expression" "$@"
      selection=$2
      ;;
    --check) check_only=true ;;
    *) return 1 ;;
  esac
}
parse_options "$@"

list=$root/Testing/mutations.txt
files=()        # of Filters/Core
suites=()       # tests that should notice, as a filter of GoogleTest: run first
descriptions=()
originals=()
replacements=()

read_list()
{
  local line last
  while IFS= read -r line; do
    last=$((${#files[@]} - 1))
    if [[ $line =~ ^([A-Za-z]+/[A-Za-z]+\.(cxx|h))\ +\[([^]]+)\]\ (.+)$ ]]; then
      files+=("${BASH_REMATCH[1]}")
      suites+=("${BASH_REMATCH[3]}")
      descriptions+=("${BASH_REMATCH[4]}")
      originals+=("")
      replacements+=("")
    elif [[ $line == "  - "* && $last -ge 0 ]]; then
      originals[last]+="${originals[last]:+$'\n'}${line:4}"
    elif [[ $line == "  +"* && $last -ge 0 ]]; then
      replacements[last]+="${replacements[last]:+$'\n'}${line:4}"
    elif [[ -n $line && $line != "#"* ]]; then
      fail "$list: no line of a mutation: $line"
    fi
  done < "$list"
  [ ${#files[@]} -gt 0 ] || fail "$list has no mutations."
}

# mutated INDEX: prints the file with the mutation; false where its place is not found exactly once.
mutated()
{
  local text rest original=${originals[$1]}
  text=$(cat "$root/Filters/Core/${files[$1]}") || return 1
  rest=${text#*"$original"}
  [[ -n $original && $rest != "$text" && $rest != *"$original"* ]] || return 1
  printf '%s%s%s\n' "${text%%"$original"*}" "${replacements[$1]}" "$rest"
}

check_list()
{
  local i lost=0
  for i in "${!files[@]}"; do
    if ! mutated "$i" > /dev/null; then
      say "Not found exactly once in ${files[$i]}: ${originals[$i]}"
      lost=$((lost + 1))
    fi
  done
  [ "$lost" -eq 0 ] || fail "$lost of ${#files[@]} mutations have no place in the sources: mend $list."
}

copy= # a temporary folder, removed at the end
time_limit=600 # Seconds after which tests count as caught in an endless loop.

configure_copy()
{
  local vtk_options
  find_vtk
  mkdir "$copy/sources"
  tar -C "$root" --exclude=./build --exclude=./.git -cf - . | tar -C "$copy/sources" -xf -
  # Optimised a little: compiled once and run once.
  cmake -S "$copy/sources" -B "$copy/build" -G Ninja \
    -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS=-O1 -DVOLUMIC_BUILD_PARAVIEW_PLUGIN=OFF \
    -DVOLUMIC_BUILD_TESTING=ON -DVOLUMIC_BUILD_EXAMPLES=OFF -DVOLUMIC_WRAP_PYTHON=OFF \
    "${vtk_options[@]}"
}

build_copy() { cmake --build "$copy/build" --target TestCore -j "$(job_count)"; }

# run_tests FILTER: whether they pass.
run_tests()
{
  GTEST_FAIL_FAST=1 timeout "$time_limit" "$copy/build/bin/TestCore" "--gtest_filter=$1" \
    < /dev/null
}

# killer: the test that failed, or that ran when the program died or took too long.
killer()
{
  { sed -n 's/^\[  FAILED  \] \([^ ,]*\).* ms).*/\1/p' "$copy/log"
    sed -n 's/^\[ RUN      \] //p' "$copy/log" | tail -n 1; } | sed -n 1p
}

# try_mutation INDEX: one line of the report.
try_mutation()
{
  local i=$1 started=$SECONDS verdict source=$copy/sources/Filters/Core/${files[$1]}
  mutated "$i" > "$source"
  if ! build_copy > "$copy/log" 2>&1 < /dev/null; then
    verdict="DOES NOT COMPILE: $(grep -m 1 'error:' "$copy/log")"
  elif ! { run_tests "${suites[$i]}" && run_tests '*'; } > "$copy/log" 2>&1; then
    verdict="killed by $(killer)"
  else
    verdict=SURVIVED
  fi
  cp "$root/Filters/Core/${files[$i]}" "$source" # Compiled together with the next mutation.
  say "${files[$i]}: ${descriptions[$i]}: $verdict ($((SECONDS - started)) s)"
}

read_list
check_list
if $check_only; then
  say "All ${#files[@]} mutations have their place in the sources."
  exit 0
fi
check_system
plan_steps 4
mapfile -t needed < <(vtk_packages)
install_packages "${tool_packages[@]}" "${test_packages[@]}" "${needed[@]}"
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
run_step "Configuring a copy of the sources" mutate-configure configure_copy
run_step "Building the tests of the core" mutate-build build_copy
started=$SECONDS
run_step "Running them on the unbroken core" mutate-tests run_tests '*'
time_limit=$((30 + 5 * (SECONDS - started)))

report=$logs/mutate-report.log
for i in "${!files[@]}"; do
  if [[ -z $selection || ${files[$i]} =~ $selection || ${descriptions[$i]} =~ $selection ]]; then
    try_mutation "$i"
  fi
done | tee "$report"
say ""
say "$(grep -c ': killed by ' "$report") of $(grep -c '' "$report") mutations have been noticed."
! grep -vq ': killed by ' "$report"
