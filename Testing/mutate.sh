#!/bin/bash
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Breaks the core on purpose, in one place at a time (Testing/mutations.txt), in a copy of the
# sources, and looks whether the tests of the core notice. A mutation that no test notices is code
# that nobody watches: it needs a test.

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
while [ $# -gt 0 ]; do
  case $1 in
    -R)
      [ $# -ge 2 ] || fail "-R needs a regular expression"
      selection=$2
      shift
      ;;
    --check) check_only=true ;;
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

list=$root/Testing/mutations.txt
files=()        # of Filters/Core
suites=()       # tests that should notice, as a filter of GoogleTest: run first
descriptions=()
originals=()
replacements=()

# Seconds after which the tests count as caught in an endless loop; less once they have been timed.
time_limit=600

# ---- The list ----------------------------------------------------------------------------------

read_list()
{
  local line number=0 last
  while IFS= read -r line; do
    number=$((number + 1))
    last=$((${#files[@]} - 1))
    if [[ $line =~ ^([A-Za-z]+\.(cxx|h))\ +\[([^]]+)\]\ (.+)$ ]]; then
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
      fail "$list:$number is no line of a mutation: $line"
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

is_selected()
{
  [[ -z $selection || ${files[$1]} =~ $selection || ${descriptions[$1]} =~ $selection ]]
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

# ---- The copy ----------------------------------------------------------------------------------

copy= # a folder of its own, removed at the end
remove_copy() { [ -z "$copy" ] || rm -rf "$copy"; }

copy_sources()
{
  copy=$(mktemp -d)
  trap remove_copy EXIT
  mkdir "$copy/sources"
  tar -C "$root" --exclude=./build --exclude=./.git -cf - . | tar -C "$copy/sources" -xf -
}

configure_copy()
{
  local prefix directory=()
  prepare_vtk
  prefix=$(vtk_prefix)
  if [ -n "$prefix" ]; then
    directory=(-DVTK_DIR="$(echo "$prefix/usr/lib/$(multiarch)"/cmake/vtk-*)")
  fi
  # Optimised a little: compiled once and run once.
  cmake -S "$copy/sources" -B "$copy/build" -G Ninja -DCMAKE_BUILD_TYPE=None \
    -DCMAKE_CXX_FLAGS=-O1 -DVOLUMIC_BUILD_PARAVIEW_PLUGIN=OFF -DVOLUMIC_BUILD_TESTING=ON \
    -DVOLUMIC_BUILD_TOOL=OFF -DVOLUMIC_BUILD_EXAMPLES=OFF -DVOLUMIC_WRAP_PYTHON=OFF \
    -DPython3_EXECUTABLE="$(vtk_python)" "${directory[@]}"
}

build_copy() { cmake --build "$copy/build" --target TestCore -j "$(job_count)"; }

# run_tests FILTER: whether they pass; what they print goes to $copy/tests.
run_tests()
{
  GTEST_FAIL_FAST=1 timeout "$time_limit" "$copy/build/bin/TestCore" "--gtest_filter=$1" \
    > "$copy/tests" 2>&1 < /dev/null
}

# The test that failed, or that ran when the program died.
killer()
{
  local name
  name=$(sed -n 's/^\[  FAILED  \] \([^ ,]*\).* ms).*/\1/p' "$copy/tests" | head -n 1)
  if [ -z "$name" ]; then
    name="$(sed -n 's/^\[ RUN      \] //p' "$copy/tests" | tail -n 1) (crashed or too slow)"
  fi
  echo "$name"
}

# ---- Mutations ---------------------------------------------------------------------------------

survivors=()
broken=()

# try_mutation INDEX: one line of the report.
try_mutation()
{
  local i=$1 source=$copy/sources/Filters/Core/${files[$1]} started=$SECONDS verdict
  mutated "$i" > "$source"
  if ! build_copy > "$logs/mutate-build.log" 2>&1 < /dev/null; then
    verdict="DOES NOT COMPILE"
    broken+=("${files[$i]}: ${descriptions[$i]}")
    grep -m 1 'error:' "$logs/mutate-build.log" || true
  elif ! run_tests "${suites[$i]}" || ! run_tests '*'; then
    verdict="killed by $(killer)"
  else
    verdict="SURVIVED"
    survivors+=("${files[$i]}: ${descriptions[$i]}")
  fi
  # Compiled together with the next mutation.
  cp "$root/Filters/Core/${files[$i]}" "$source"
  say "${files[$i]}: ${descriptions[$i]}: $verdict ($((SECONDS - started)) s)"
}

run_unbroken()
{
  run_tests '*' || { cat "$copy/tests"; return 1; }
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
copy_sources
run_step "Configuring a copy of the sources" mutate-configure configure_copy
run_step "Building the tests of the core" mutate-build build_copy
started=$SECONDS
run_step "Running them on the unbroken core" mutate-tests run_unbroken
time_limit=$((30 + 5 * (SECONDS - started)))
tried=0
for i in "${!files[@]}"; do
  if is_selected "$i"; then
    try_mutation "$i"
    tried=$((tried + 1))
  fi
done

say ""
say "$tried mutations after $SECONDS s: $((tried - ${#survivors[@]} - ${#broken[@]})) killed," \
  "${#survivors[@]} survived, ${#broken[@]} did not compile."
for name in "${survivors[@]}"; do
  say "  survived: $name"
done
for name in "${broken[@]}"; do
  say "  does not compile: $name"
done
[ ${#survivors[@]} -eq 0 ] && [ ${#broken[@]} -eq 0 ] && [ "$tried" -gt 0 ]
