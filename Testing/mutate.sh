#!/bin/bash
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Mutation test: applies the mutations of Testing/mutations.txt, one at a time, to a copy of the
# sources, and checks that the tests of the core fail.

set -eo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../CMake/debian.sh"

usage()
{
  cat << 'USAGE'
Usage: bash Testing/mutate.sh [OPTION]...
  -R REGEX   only mutations whose file or description matches
  --check    only check that the text of each mutation occurs once in the sources
  --help     print this text
Exit status: 0 if tests failed for every mutation, 1 if a mutation survived, does not compile, or
does not match the sources.
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
suites=()       # tests that should fail, as a GoogleTest filter: run first
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
      fail "$list: invalid line: $line"
    fi
  done < "$list"
  [ ${#files[@]} -gt 0 ] || fail "$list contains no mutations."
}

# mutated INDEX: print the file with the mutation; fail if its text does not occur exactly once.
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
  local i invalid=0
  for i in "${!files[@]}"; do
    if ! mutated "$i" > /dev/null; then
      say "Not found exactly once in ${files[$i]}: ${originals[$i]}"
      invalid=$((invalid + 1))
    fi
  done
  [ "$invalid" -eq 0 ] || fail "$invalid of ${#files[@]} mutations do not match the sources. Update $list."
}

copy= # a temporary folder, removed at the end
time_limit=600 # Seconds after which tests count as endless.

configure_copy()
{
  local vtk_options
  find_vtk
  mkdir "$copy/sources"
  tar -C "$root" --exclude=./build --exclude=./.git -cf - . | tar -C "$copy/sources" -xf -
  # -O1: each mutation is compiled once and run once.
  cmake -S "$copy/sources" -B "$copy/build" -G Ninja \
    -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS=-O1 -DVOLUMIC_BUILD_PARAVIEW_PLUGIN=OFF \
    -DVOLUMIC_BUILD_TESTING=ON -DVOLUMIC_BUILD_EXAMPLES=OFF -DVOLUMIC_WRAP_PYTHON=OFF \
    "${vtk_options[@]}"
}

build_copy() { cmake --build "$copy/build" --target TestCore -j "$(job_count)"; }

# run_tests FILTER: run these tests; fail if one fails.
run_tests()
{
  GTEST_FAIL_FAST=1 timeout "$time_limit" "$copy/build/bin/TestCore" "--gtest_filter=$1" \
    < /dev/null
}

# killer: print the test that failed, or that ran when the program crashed or timed out.
killer()
{
  { sed -n 's/^\[  FAILED  \] \([^ ,]*\).* ms).*/\1/p' "$copy/log"
    sed -n 's/^\[ RUN      \] //p' "$copy/log" | tail -n 1; } | sed -n 1p
}

# try_mutation INDEX: test a mutation and print its line of the report.
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
  cp "$root/Filters/Core/${files[$i]}" "$source" # Compiled with the next mutation.
  say "${files[$i]}: ${descriptions[$i]}: $verdict ($((SECONDS - started)) s)"
}

read_list
check_list
if $check_only; then
  say "All ${#files[@]} mutations match the sources."
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
run_step "Running them on the original core" mutate-tests run_tests '*'
time_limit=$((30 + 5 * (SECONDS - started)))

report=$logs/mutate-report.log
for i in "${!files[@]}"; do
  if [[ -z $selection || ${files[$i]} =~ $selection || ${descriptions[$i]} =~ $selection ]]; then
    try_mutation "$i"
  fi
done | tee "$report"
say ""
say "$(grep -c ': killed by ' "$report") of $(grep -c '' "$report") mutations were killed."
! grep -vq ': killed by ' "$report"
