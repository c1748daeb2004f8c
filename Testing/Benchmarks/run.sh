#!/bin/bash
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Builds the benchmarks and prints the tables of Documentation/measured.md. Run it on an idle machine.

set -eo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../../CMake/debian.sh"

usage()
{
  cat << 'USAGE'
Usage: bash Testing/Benchmarks/run.sh [TABLE [OPTION]...]
  TABLE   pyramid, surface, command: skull CT of Debian's invesalius-examples
          interfaces: generated label maps, and two of Debian's mricron-data
          (default: all tables)
  OPTION  replaces the table's default options; `benchmark.py TABLE --help` lists them. The skull
          is build/benchmarks/skull.vti, its iso-value 226.5
Prints the tables and writes all figures to build/benchmarks/*.csv.
USAGE
}

packages=("${tool_packages[@]}" libcgal-dev mricron-data)
tables=(pyramid surface command interfaces)
case " ${tables[*]} " in
  *" ${1:-all} "*)
    tables=("$1")
    shift
    ;;
  *) [ $# -eq 0 ] || { usage; exit 2; } ;;
esac

results=$build/benchmarks
mkdir -p "$results"
check_system
plan_steps $((4 + $(skull_steps)))
mapfile -t needed < <(vtk_packages; skull_packages)
install_packages "${packages[@]}" "${needed[@]}"
prepare_skull
build_vtk_flavour -DVOLUMIC_BUILD_BENCHMARKS=ON
skull=$results/skull.vti
run_step "Reading the skull CT" benchmark-skull \
  "$build/install-vtk/bin/volumic" "$(cranium)" --write-volume "$skull"

failed= tables_made=0
# measure TABLE OPTION...: run a table. A failure does not stop the other tables.
measure()
{
  local table=$1 package
  shift
  package=$(find "$build/install-vtk" -type d -path '*-packages/volumic' -print -quit)
  say "" "$table" "$@"
  PATH="$build/vtk/bin:$build/install-vtk/bin:$PATH" \
    PYTHONPATH=$(dirname "$package")${PYTHONPATH:+:$PYTHONPATH} \
    "$(vtk_python)" "$root/Testing/Benchmarks/benchmark.py" "$table" \
    --csv "$results/$table-$((++tables_made)).csv" "$@" || failed=yes
}

sed -n 's/^model name[^:]*: /Processor: /p' /proc/cpuinfo | sort -u
for table in "${tables[@]}"; do
  case $#$table in
    [1-9]*) measure "$table" "$@" ;;
    0pyramid) measure pyramid "$skull" ;;
    0surface) measure surface "$skull" --iso 226.5 ;;
    0command) measure command "$skull" --iso 226.5 --sizes 0,512 --repetitions 5 ;;
    0interfaces) measure interfaces ;;
  esac
done
[ -z "$failed" ] || fail "Some runs failed; see above."
