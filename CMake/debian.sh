# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# What the project's scripts (Testing/run.sh, Examples/quickstart.sh) share; they source this file:
# it installs what is missing on a Debian 12, and builds Volumic for VTK and for ParaView under
# build/, printing a line per step and keeping a log of each step in build/logs.
#
#   plan_steps 3                                     # how many steps the script will announce
#   install_packages "${tool_packages[@]}"           # a step; nothing is ever removed
#   build_vtk_flavour -DVOLUMIC_BUILD_TESTING=OFF    # two steps; into build/install-vtk
#   "$(vtk_python)" script.py                        # the interpreter that finds VTK
#
# Debian's python3-paraview and python3-vtk9 exclude each other. Whichever of the two can't be
# installed without removing the other is unpacked into a folder under build/, linked to the rest of
# its packages: see prepare_paraview and prepare_vtk.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build
logs=$build/logs
mkdir -p "$logs"

tool_packages=(g++ cmake ninja-build python3 libpython3-dev python3-numpy)
# Without doxygen, which brings 200 MB of LLVM: its test is disabled where it is missing.
test_packages=(dpkg-dev libgtest-dev libcgal-dev libbenchmark-dev xvfb xauth libgl1-mesa-dri
  libxtst6)
example_packages=(invesalius-examples)

# Debian's own interpreter; another python3 (conda, pyenv) may be the first on PATH.
python=/usr/bin/python3

# The parts of each product that can always be installed, and the rest, of which python3-vtk9 and
# python3-paraview conflict (libvtk9-dev depends on the former).
vtk_free_packages=(libvtk9.1 libvtk9.1-qt libvtk9-java vtk9)
vtk_bound_packages=(libvtk9-dev python3-vtk9)
paraview_free_packages=(paraview paraview-dev)
paraview_bound_packages=(python3-paraview)
# What find_package(ParaView) looks for without paraview-dev depending on it.
paraview_needs=(qtbase5-dev libqt5svg5-dev qttools5-dev libqt5xmlpatterns5-dev
  qtxmlpatterns5-dev-tools libqt5opengl5-dev libqt5x11extras5-dev qtdeclarative5-dev python3-mpi4py
  libxml2-dev libutfcpp-dev libhdf5-mpi-dev libogg-dev libtheora-dev libavformat-dev libavcodec-dev
  libavutil-dev libswscale-dev libgl2ps-dev libpng-dev libnetcdf-dev libgdal-dev libglew-dev
  libdouble-conversion-dev libfreetype-dev)

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

# run_step TITLE LOG COMMAND...: run the command with its output in build/logs/LOG.log; when it
# fails, show the end of the log and stop. The command runs in a subshell and without input.
run_step()
{
  local title=$1 log=$logs/$2.log started=$SECONDS status
  shift 2
  step_number=$((step_number + 1))
  printf '[%d/%d] %s ... ' "$step_number" "$step_total" "$title"
  # Not in a condition: bash would ignore the errors inside of functions there.
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

# ---- Packages ----------------------------------------------------------------------------------

check_system()
{
  local system="another system"
  if [ -r /etc/os-release ]; then
    system=$(. /etc/os-release && echo "${ID:-} ${VERSION_ID:-}")
  fi
  if [ "$system" != "debian 12" ]; then
    say "Note: made for and tried on Debian 12; this is $system, whose packages may differ."
  fi
}

is_installed()
{
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2> /dev/null)" = installed ]
}

missing_packages()
{
  local package
  for package in "$@"; do
    is_installed "$package" || echo "$package"
  done
}

# The distribution's version of a package that is installed or could be.
package_version()
{
  if is_installed "$1"; then
    dpkg-query -W -f='${Version}' "$1"
  else
    apt-cache policy "$1" | sed -n 's/^  Candidate: //p'
  fi
}

# What apt-get is called through; empty when root.
privileged=()

find_privilege()
{
  local missing="$*"
  if [ "$(id -u)" -eq 0 ]; then
    return
  fi
  if command -v sudo > /dev/null && { sudo -n true 2> /dev/null || { [ -t 0 ] && sudo -v; }; }; then
    privileged=(sudo)
    return
  fi
  fail "These packages are missing, and installing them takes root's rights. Please run
  sudo apt-get install --no-install-recommends $missing
and start this script again."
}

apt_install()
{
  local simulation removed
  "${privileged[@]}" apt-get update -q
  echo "To install: $*"
  simulation=$(LC_ALL=C apt-get install -s --no-install-recommends "$@")
  removed=$(sed -n 's/^Remv \([^ ]*\).*/\1/p' <<< "$simulation" | tr '\n' ' ')
  if [ -n "$removed" ]; then
    echo "Installing these packages would remove others that are installed: $removed"
    echo "That is not done here. Decide about them yourself, then start this script again."
    return 1
  fi
  "${privileged[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -q -o DPkg::Lock::Timeout=300 --no-install-recommends --no-remove "$@"
}

# install_packages PACKAGE...: one step, which installs those that are missing.
install_packages()
{
  local missing
  if ! command -v apt-get > /dev/null; then
    run_step "Packages: no apt-get here, trusting that they are installed" packages true
    return
  fi
  mapfile -t missing < <(missing_packages "$@")
  if [ "${#missing[@]}" -eq 0 ]; then
    run_step "Packages: all $# installed" packages true
    return
  fi
  find_privilege "${missing[@]}"
  run_step "Installing ${#missing[@]} packages and what they need" packages \
    apt_install "${missing[@]}"
}

# The packages of a flavour that can be installed here. Without the other product's half of the
# conflict, VTK's is installed and ParaView's unpacked.
vtk_packages()
{
  if is_installed python3-paraview; then
    # libvtk9-dev is unpacked, so its dependencies have to be named.
    LC_ALL=C apt-cache depends libvtk9-dev \
      | sed -n 's/^  Depends: \([a-z0-9][^ ]*\)$/\1/p' | grep -v '^python3-vtk9$'
    printf '%s\n' "${vtk_free_packages[@]}"
  else
    printf '%s\n' "${vtk_free_packages[@]}" "${vtk_bound_packages[@]}"
  fi
}

paraview_packages()
{
  printf '%s\n' "${paraview_free_packages[@]}" "${paraview_needs[@]}"
}

# ---- Packages beside the system's --------------------------------------------------------------

multiarch() { gcc -print-multiarch; }

download_package()
{
  local package=$1 version=$2
  LC_ALL=C apt-get download -q "$package=$version" && return
  echo "Trying again with fresh package lists"
  find_privilege "$package" # only apt-get update needs it
  "${privileged[@]}" apt-get update -q
  LC_ALL=C apt-get download -q "$package=$version"
}

# unpack_beside PREFIX "UNPACKED..." "LINKED...": make PREFIX/usr look as if all these packages were
# installed there: the first ones are downloaded and unpacked, the others, installed ones, are
# linked. CMake's package files are copied, since CMake resolves links to find its prefix. Nothing
# is done if the prefix holds these versions already.
unpack_beside()
{
  local prefix=$1 unpacked=$2 linked=$3 package stamp
  stamp=$(for package in $unpacked $linked; do echo "$package $(package_version "$package")"; done)
  if [ -f "$prefix/packages" ] && [ "$stamp" = "$(cat "$prefix/packages")" ]; then
    echo "$prefix is up to date"
    return
  fi
  rm -rf "$prefix"
  mkdir -p "$prefix/download" "$prefix/bin"
  cd "$prefix/download"
  for package in $unpacked; do
    download_package "$package" "$(package_version "$package")"
  done
  for package in *.deb; do
    dpkg-deb -x "$package" "$prefix"
  done
  cd "$prefix"
  rm -rf download
  # shellcheck disable=SC2086 # a list
  dpkg -L $linked | grep -E '^/usr/(bin|include|lib)/' | while read -r path; do
    if [ -d "$path" ]; then
      continue
    elif [[ $path == */cmake/* ]]; then
      echo "$path" >> copies
    else
      echo "$path" >> links
    fi
  done
  touch copies links
  xargs -r -d '\n' -a copies cp -n --parents -t "$prefix"
  xargs -r -d '\n' -a links cp -s -n --parents -t "$prefix"
  rm copies links
  echo "$stamp" > "$prefix/packages"
}

# write_launcher PREFIX NAME TARGET before|after: PREFIX/bin/NAME starts TARGET with the prefix's
# Python packages before or after those that PYTHONPATH names.
write_launcher()
{
  local prefix=$1 name=$2 target=$3 place=$4 packages=$1/usr/lib/python3/dist-packages
  local value="$packages\${PYTHONPATH:+:\$PYTHONPATH}"
  if [ "$place" = after ]; then
    value="\${PYTHONPATH:+\$PYTHONPATH:}$packages"
  fi
  printf '#!/bin/sh\nPYTHONPATH="%s" exec "%s" "$@"\n' "$value" "$target" > "$prefix/bin/$name"
  chmod +x "$prefix/bin/$name"
}

# The folder whose usr/ holds ParaView (empty: the system's own), known once packages are installed.
paraview_prefix()
{
  is_installed python3-paraview || echo "$build/paraview-prefix"
}

vtk_prefix()
{
  if is_installed python3-paraview; then
    echo "$build/vtk-prefix"
  fi
}

# A complete ParaView for find_package and to run (PREFIX/bin/paraview, pvbatch, pvpython,
# pvserver), though python3-paraview isn't installed.
prepare_paraview()
{
  local prefix program
  prefix=$(paraview_prefix)
  [ -n "$prefix" ] || return 0
  unpack_beside "$prefix" "${paraview_bound_packages[*]}" "${paraview_free_packages[*]}"
  for program in paraview pvbatch pvpython pvserver; do
    write_launcher "$prefix" "$program" "$prefix/usr/bin/$program" before
  done
}

# The same for VTK, on a machine that has python3-paraview.
prepare_vtk()
{
  local prefix
  prefix=$(vtk_prefix)
  [ -n "$prefix" ] || return 0
  unpack_beside "$prefix" "${vtk_bound_packages[*]}" "${vtk_free_packages[*]}"
  write_launcher "$prefix" python3 "$python" after
}

# The interpreter that imports VTK's modules, whichever way VTK is there.
vtk_python()
{
  local prefix
  prefix=$(vtk_prefix)
  echo "${prefix:+$prefix/bin/python3}" | grep . || echo "$python"
}

# ---- Building ----------------------------------------------------------------------------------

# As many jobs as there are processors and, at 1.5 GB for a job, memory.
job_count()
{
  local processors gigabytes
  processors=$(nproc)
  gigabytes=$(awk '/^MemAvailable/ { print int($2 / 1500000) }' /proc/meminfo)
  echo $((gigabytes < 1 ? 1 : gigabytes < processors ? gigabytes : processors))
}

# configure NAME ARGUMENT...: the build tree build/NAME, to be installed into build/install-NAME.
configure()
{
  local tree=$build/$1
  # A build folder that came along with a moved or copied checkout is of no use.
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

configure_vtk()
{
  local prefix directory=()
  prepare_vtk
  prefix=$(vtk_prefix)
  if [ -n "$prefix" ]; then
    directory=(-DVTK_DIR="$(echo "$prefix/usr/lib/$(multiarch)"/cmake/vtk-*)")
  fi
  configure vtk -DVOLUMIC_BUILD_PARAVIEW_PLUGIN=OFF -DPython3_EXECUTABLE="$(vtk_python)" \
    "${directory[@]}" "$@"
}

configure_paraview()
{
  local prefix directory=()
  prepare_paraview
  prefix=$(paraview_prefix)
  if [ -n "$prefix" ]; then
    directory=(-DParaView_DIR="$(echo "$prefix/usr/lib/$(multiarch)"/cmake/paraview-*)")
  fi
  configure paraview -DVOLUMIC_BUILD_PARAVIEW_PLUGIN=ON -DPython3_EXECUTABLE="$python" \
    -DVOLUMIC_PV_PREFIX="$prefix" "${directory[@]}" "$@"
}

# build_vtk_flavour ARGUMENT... and build_paraview_flavour ARGUMENT...: two steps each; arguments go
# to cmake. The packages must be installed.
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
