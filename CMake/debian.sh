# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Functions of the project's scripts (Testing/run.sh, Examples/quickstart.sh), which source this file:
# install missing packages on Debian, and build Volumic for VTK and for ParaView under build/. Each step
# prints a line and writes a log in build/logs.
#
#   plan_steps 3                                     # number of steps of the script
#   install_packages "${tool_packages[@]}"           # a step; no package is removed
#   build_vtk_flavour -DVOLUMIC_BUILD_TESTING=OFF    # two steps; installs into build/install-vtk
#   "$(vtk_python)" script.py                        # the interpreter that finds VTK

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build
logs=$build/logs
mkdir -p "$logs"

# Debian's interpreter. Another python3 (conda, pyenv) may be the first on PATH.
python=/usr/bin/python3

. "$root/CMake/script_options.sh"
. "$root/CMake/debian_packages.sh"

# ---- Steps -------------------------------------------------------------------------------------

step_number=0
step_total=0

plan_steps() { step_total=$1; step_number=0; }

say() { printf '%s\n' "$*"; }

fail()
{
  printf '\n%s\n' "$*" >&2
  exit 1
}

# run_step TITLE LOG COMMAND...: run the command in a subshell without input, with its output in
# build/logs/LOG.log. If it fails, show the end of the log and stop.
run_step()
{
  local title=$1 log=$logs/$2.log started=$SECONDS status
  shift 2
  step_number=$((step_number + 1))
  printf '[%d/%d] %s ... ' "$step_number" "$step_total" "$title"
  # Not in a condition, where bash ignores errors inside functions.
  set +e
  (set -eo pipefail; "$@") > "$log" 2>&1 < /dev/null
  status=$?
  set -e
  if [ "$status" -ne 0 ]; then
    say "failed after $((SECONDS - started)) s"
    say ""
    tail -n 20 "$log" | sed 's/^/    /'
    fail "$title failed (status $status). The whole log: $log"
  fi
  say "$((SECONDS - started)) s"
}

# ---- Building ----------------------------------------------------------------------------------

# Print the number of jobs: one per processor, with at least 1.5 GB of memory each.
job_count()
{
  local processors gigabytes
  processors=$(nproc)
  gigabytes=$(awk '/^MemAvailable/ { print int($2 / 1500000) }' /proc/meminfo)
  echo $((gigabytes < 1 ? 1 : gigabytes < processors ? gigabytes : processors))
}

# configure NAME ARGUMENT...: configure build/NAME, with the prefix build/install-NAME.
configure()
{
  local tree=$build/$1
  # The build folder of a moved or copied checkout cannot be used.
  if [ -f "$tree/CMakeCache.txt" ] \
    && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$tree/CMakeCache.txt"; then
    rm -rf "$tree"
  fi
  cmake -S "$root" -B "$tree" -G Ninja -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=ON \
    -DCMAKE_INSTALL_PREFIX="$build/install-$1" -DCMAKE_INSTALL_LIBDIR="lib/$(multiarch)" \
    -DVOLUMIC_WRAP_PYTHON=ON "${@:2}"
}

compile_and_install()
{
  cmake --build "$build/$1" -j "$(job_count)"
  cmake --install "$build/$1"
}

# find_vtk: prepare VTK, and set the array vtk_options to the options of cmake.
find_vtk()
{
  local prefix
  prepare_vtk
  prefix=$(vtk_prefix)
  vtk_options=(-DPython3_EXECUTABLE="$(vtk_python)")
  if [ -n "$prefix" ]; then
    vtk_options+=(-DVTK_DIR="$(echo "$prefix/usr/lib/$(multiarch)"/cmake/vtk-*)")
  fi
}

configure_vtk()
{
  local vtk_options
  find_vtk
  configure vtk -DVOLUMIC_BUILD_PARAVIEW_PLUGIN=OFF "${vtk_options[@]}" "$@"
}

configure_paraview()
{
  local prefix
  prepare_paraview
  prefix=$(paraview_prefix)
  configure paraview -DVOLUMIC_BUILD_PARAVIEW_PLUGIN=ON -DPython3_EXECUTABLE="$python" \
    -DVOLUMIC_PV_PREFIX="$prefix" \
    -DParaView_DIR="$(echo "$prefix/usr/lib/$(multiarch)"/cmake/paraview-*)" "$@"
}

# build_vtk_flavour ARGUMENT... and build_paraview_flavour ARGUMENT...: two steps each, with arguments of
# cmake. The packages must be installed.
build_vtk_flavour()
{
  run_step "Configuring for VTK" configure-vtk configure_vtk "$@"
  run_step "Building for VTK" build-vtk compile_and_install vtk
}

build_paraview_flavour()
{
  run_step "Configuring for ParaView" configure-paraview configure_paraview "$@"
  run_step "Building for ParaView" build-paraview compile_and_install paraview
}
