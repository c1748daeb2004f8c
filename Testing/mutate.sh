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

# Seconds after which the tests count as caught in an endless loop; less once they have been timed.
time_limit=600

# ---- The list ----------------------------------------------------------------------------------

read_list()
{
  local line number=0 last
  while IFS= read -r line; do
    number=$((number + 1))
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

# ---- The copies --------------------------------------------------------------------------------

# Each worker breaks and builds a copy of its own: a mutation compiles one file, mostly.
copies= # a temporary folder, removed at the end
workers=$(job_count)
remove_copies() { [ -z "$copies" ] || rm -rf "$copies"; }

copy_sources()
{
  local worker
  for ((worker = 0; worker < workers; ++worker)); do
    mkdir -p "$copies/$worker/sources"
    tar -C "$root" --exclude=./build --exclude=./.git -cf - . | tar -C "$copies/$worker/sources" -xf -
  done
}

configure_copies()
{
  local vtk_options worker
  find_vtk
  copy_sources
  for ((worker = 0; worker < workers; ++worker)); do
    # Optimised a little: compiled once and run once.
    cmake -S "$copies/$worker/sources" -B "$copies/$worker/build" -G Ninja \
      -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS=-O1 -DVOLUMIC_BUILD_PARAVIEW_PLUGIN=OFF \
      -DVOLUMIC_BUILD_TESTING=ON -DVOLUMIC_BUILD_TOOL=OFF -DVOLUMIC_BUILD_EXAMPLES=OFF \
      -DVOLUMIC_WRAP_PYTHON=OFF "${vtk_options[@]}"
  done
}

# build_copy WORKER
build_copy() { cmake --build "$copies/$1/build" --target TestCore -j 1; }

build_copies()
{
  local worker processes=()
  for ((worker = 0; worker < workers; ++worker)); do
    build_copy "$worker" &
    processes+=($!)
  done
  for worker in "${processes[@]}"; do
    wait "$worker"
  done
}

# run_tests WORKER FILTER: whether they pass; what they print goes to the file tests.
run_tests()
{
  GTEST_FAIL_FAST=1 timeout "$time_limit" "$copies/$1/build/bin/TestCore" "--gtest_filter=$2" \
    > "$copies/$1/tests" 2>&1 < /dev/null
}

run_unbroken()
{
  run_tests 0 '*' || { cat "$copies/0/tests"; return 1; }
}

# killer WORKER: the test that failed, or that ran when the program died.
killer()
{
  local name
  name=$(sed -n 's/^\[  FAILED  \] \([^ ,]*\).* ms).*/\1/p' "$copies/$1/tests" | head -n 1)
  if [ -z "$name" ]; then
    name="$(sed -n 's/^\[ RUN      \] //p' "$copies/$1/tests" | tail -n 1) (crashed or too slow)"
  fi
  echo "$name"
}

# ---- Mutations ---------------------------------------------------------------------------------

# try_mutation WORKER INDEX: one line of the report.
try_mutation()
{
  local worker=$1 i=$2 started=$SECONDS verdict
  local source=$copies/$worker/sources/Filters/Core/${files[$i]}
  mutated "$i" > "$source"
  if ! build_copy "$worker" > "$copies/$worker/log" 2>&1 < /dev/null; then
    verdict="DOES NOT COMPILE: $(grep -m 1 'error:' "$copies/$worker/log")"
  elif ! run_tests "$worker" "${suites[$i]}" || ! run_tests "$worker" '*'; then
    verdict="killed by $(killer "$worker")"
  else
    verdict=SURVIVED
  fi
  # Compiled together with the next mutation.
  cp "$root/Filters/Core/${files[$i]}" "$source"
  say "${files[$i]}: ${descriptions[$i]}: $verdict ($((SECONDS - started)) s)" \
    | tee -a "$copies/report"
}

# work WORKER: the mutations that no other worker has begun, in the order of the list.
work()
{
  local i
  for i in "${!files[@]}"; do
    if is_selected "$i" && mkdir "$copies/begun-$i" 2> /dev/null; then
      try_mutation "$1" "$i"
    fi
  done
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
copies=$(mktemp -d)
trap remove_copies EXIT
run_step "Configuring copies of the sources" mutate-configure configure_copies
run_step "Building the tests of the core" mutate-build build_copies
started=$SECONDS
run_step "Running them on the unbroken core" mutate-tests run_unbroken
time_limit=$((30 + 5 * (SECONDS - started)))

touch "$copies/report"
processes=()
for ((worker = 0; worker < workers; ++worker)); do
  work "$worker" &
  processes+=($!)
done
wait "${processes[@]}"

report=$logs/mutate-report.log
sort "$copies/report" > "$report"
count() { grep -c "$1" "$report" || true; }
survived=$(count ': SURVIVED (')
broken=$(count ': DOES NOT COMPILE')
say ""
say "$(count '') mutations after $SECONDS s: $(count ': killed by ') killed, $survived survived," \
  "$broken did not compile."
grep -E ': SURVIVED \(|: DOES NOT COMPILE' "$report" || true
[ "$(count ': killed by ')" -gt 0 ] && [ "$survived" -eq 0 ] && [ "$broken" -eq 0 ]
