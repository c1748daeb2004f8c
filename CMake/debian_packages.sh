# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Sourced by debian.sh: required Debian packages, their installation, and packages that are unpacked under
# build/.
#
# In some releases python3-paraview and python3-vtk9 exclude each other. The one that cannot be installed
# is then unpacked under build/ (prepare_paraview, prepare_vtk). Package names that contain versions are
# derived from the dependencies of other packages, so that a new release needs no change here.

# Second and third line: file formats, a download of 41 MB beside 600 MB for VTK and the compiler. The
# command names a missing package. The skull needs only NumPy.
tool_packages=(g++ cmake ninja-build libtbb-dev python3 libpython3-dev python3-numpy
  python3-scipy python3-nibabel python3-pydicom python3-gdcm python3-tifffile python3-mrcfile
  python3-zarr python3-h5py python3-meshio python3-pil)
# Without doxygen (200 MB of LLVM): its test is disabled if it is missing.
# mpi-default-bin: mpirun for the tests with several processes, which are skipped otherwise.
# ccache: sources of both variants are compiled once.
test_packages=(ccache dpkg-dev file locales libgtest-dev libcgal-dev xvfb xauth libgl1-mesa-dri
  libxtst6 mpi-default-bin)
# Packages of tests that are skipped if the release lacks them. (Without gmsh, half a gigabyte, whose test
# is skipped, too.)
optional_test_packages=(python3-scikit-build-core python3-venv python3-pip mypy tetgen
  calculix-ccx assimp-utils python3-distributed draco)
# The CT of a skull, input of the examples.
skull_package=invesalius-examples

# Packages that find_package(ParaView) requires although paraview-dev does not depend on them, and tools
# for a plugin with widgets.
paraview_needs=(python3-mpi4py libxml2-dev libutfcpp-dev libhdf5-mpi-dev libogg-dev libtheora-dev
  libavformat-dev libavcodec-dev libavutil-dev libswscale-dev libgl2ps-dev libpng-dev libnetcdf-dev
  libgdal-dev libglew-dev libdouble-conversion-dev libfreetype-dev)
qt5_packages=(qtbase5-dev libqt5svg5-dev qttools5-dev libqt5xmlpatterns5-dev
  qtxmlpatterns5-dev-tools libqt5opengl5-dev libqt5x11extras5-dev qtdeclarative5-dev)
qt6_packages=(qt6-base-dev qt6-svg-dev qt6-5compat-dev qt6-tools-dev qt6-svg-plugins xsltproc)

# ---- Packages ----------------------------------------------------------------------------------

# check_system: download the package lists if there are none.
check_system()
{
  if command -v apt-get > /dev/null && [ -z "$(package_version libvtk9-dev)" ]; then
    if ! is_root_or_sudo; then
      fail "There are no package lists yet. Please run
  sudo apt-get update
and start this script again."
    fi
    "${privileged[@]}" apt-get update -q > "$logs/package-lists.log" 2>&1 < /dev/null \
      || fail "apt-get update failed. Its log: $logs/package-lists.log"
    [ -n "$(package_version libvtk9-dev)" ] || fail "The package lists have no libvtk9-dev."
  fi
}

is_installed()
{
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2> /dev/null)" = installed ]
}

# available PACKAGE...: print the packages that this release has.
available()
{
  local package
  for package in "$@"; do
    [ -z "$(package_version "$package")" ] || echo "$package"
  done
}

missing_packages()
{
  local package
  for package in "$@"; do
    is_installed "$package" || echo "$package"
  done
}

# Print the installed version of a package, or else the available one; empty if there is none.
package_version()
{
  if is_installed "$1"; then
    dpkg-query -W -f='${Version}' "$1"
  else
    LC_ALL=C apt-cache policy "$1" | sed -n 's/^  Candidate: //p' | grep -vxF '(none)' || true
  fi
}

# Command to call apt-get with; empty for root.
privileged=()

is_root_or_sudo()
{
  [ "$(id -u)" -eq 0 ] && return
  command -v sudo > /dev/null && { sudo -n true 2> /dev/null || { [ -t 0 ] && sudo -v; }; } \
    && privileged=(sudo)
}

find_privilege()
{
  is_root_or_sudo || fail "These packages are missing, and installing them takes root's rights.
Please run
  sudo apt-get install --no-install-recommends $*
and start this script again."
}

apt_install()
{
  "${privileged[@]}" apt-get update -q
  echo "To install: $*"
  "${privileged[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -q -o DPkg::Lock::Timeout=300 --no-install-recommends --no-remove "$@"
}

# install_packages PACKAGE...: one step that installs missing packages.
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

# dependencies PACKAGE: print the names of its dependencies.
dependencies()
{
  LC_ALL=C apt-cache depends "$1" | sed -n 's/^ [ |]Depends: \([a-z0-9][^ ]*\)$/\1/p'
}

products_exclude_each_other()
{
  LC_ALL=C apt-cache depends python3-paraview 2> /dev/null \
    | grep -x ' *Conflicts: python3-vtk9' > /dev/null
}

# vtk_is_beside: true if VTK cannot be installed because ParaView is. Then VTK is unpacked. In all other
# cases in which they exclude each other, ParaView's Python modules are unpacked.
vtk_is_beside()
{
  is_installed python3-paraview && products_exclude_each_other
}

# Packages of VTK: those that can always be installed, and those that python3-paraview may exclude. The
# CMake files of libvtk9-dev require all libraries and headers of VTK.
vtk_free_packages()
{
  local library
  library=$(dependencies libvtk9-dev | grep -x 'libvtk9\.[0-9.]*')
  echo "$library $library-qt libvtk9-java vtk9"
}

vtk_bound_packages() { echo "libvtk9-dev libvtk9-qt-dev python3-vtk9"; }
paraview_product_packages() { echo "paraview paraview-dev python3-paraview"; }

# vtk_packages and paraview_packages: print the packages of a variant that can be installed.
vtk_packages()
{
  local bound package
  read -ra bound <<< "$(vtk_bound_packages)"
  if vtk_is_beside; then
    # These are unpacked, so their dependencies must be named.
    for package in "${bound[@]}"; do
      dependencies "$package" | grep -vxFf <(printf '%s\n' "${bound[@]}")
    done
  else
    printf '%s\n' "${bound[@]}"
  fi
  vtk_free_packages | tr ' ' '\n'
}

paraview_packages()
{
  paraview_product_packages | tr ' ' '\n' \
    | if products_exclude_each_other; then grep -vx python3-paraview; else cat; fi
  printf '%s\n' "${paraview_needs[@]}"
  if dependencies paraview | grep '^libqt6core' > /dev/null; then
    printf '%s\n' "${qt6_packages[@]}"
  else
    printf '%s\n' "${qt5_packages[@]}"
  fi
  # From 6.1 on Debian's ParaView uses Debian's VTK, and paraview-dev has no headers of VTK.
  [ -z "$(dependencies paraview | grep '^libvtk9')" ] || printf '%s\n' libvtk9-dev libvtk9-qt-dev
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

# link_packages PREFIX PACKAGE...: fill PREFIX/usr with the files of these packages: links to installed
# ones, and downloads of the others. CMake's package files are copied, because CMake resolves links to
# find its prefix. Do nothing if the prefix has these versions already.
link_packages()
{
  local prefix=$1 package stamp linked=()
  shift
  stamp=$(for package in "$@"; do
    echo "$package $(package_version "$package") $(is_installed "$package" && echo linked)"
  done)
  if [ -f "$prefix/packages" ] && [ "$stamp" = "$(cat "$prefix/packages")" ]; then
    echo "$prefix is up to date"
    return
  fi
  rm -rf "$prefix"
  mkdir -p "$prefix/download" "$prefix/bin"
  cd "$prefix/download"
  for package in "$@"; do
    if is_installed "$package"; then
      linked+=("$package")
    else
      download_package "$package" "$(package_version "$package")"
    fi
  done
  for package in *.deb; do
    [ ! -e "$package" ] || dpkg-deb -x "$package" "$prefix"
  done
  cd "$prefix"
  rm -rf download
  if [ "${#linked[@]}" -gt 0 ]; then
    dpkg -L "${linked[@]}" | grep -E '^/usr/(bin|include|lib)/' | sort -u | while read -r path; do
      if [ -d "$path" ]; then
        continue
      elif [[ $path == */cmake/* ]]; then
        echo "$path" >> copies
      else
        echo "$path" >> links
      fi
    done
  fi
  touch copies links
  xargs -r -d '\n' -a copies cp -n --parents -t "$prefix"
  xargs -r -d '\n' -a links cp -s -n --parents -t "$prefix"
  rm copies links
  name_python_modules_plainly "$prefix"
  echo "$stamp" > "$prefix/packages"
}

# The CMake files of VTK and ParaView search for NAME.so. Newer packages have NAME.cpython-*.so: add links.
name_python_modules_plainly()
{
  local module
  find "$1/usr/lib/python3" -name '*.cpython-*.so' 2> /dev/null | while read -r module; do
    [ -e "${module%%.cpython-*}.so" ] || ln -s "${module##*/}" "${module%%.cpython-*}.so"
  done
}

# write_launcher PREFIX NAME TARGET before|after: write PREFIX/bin/NAME, which starts TARGET with the
# Python packages of the prefix before or after those in PYTHONPATH.
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

# Print the folder whose usr/ contains a complete ParaView, with bin/paraview, pvbatch, pvpython and
# pvserver.
paraview_prefix() { echo "$build/paraview-prefix"; }

# The same for VTK; empty for the VTK of the system.
vtk_prefix()
{
  if vtk_is_beside; then
    echo "$build/vtk-prefix"
  fi
}

prepare_paraview()
{
  local prefix program packages
  prefix=$(paraview_prefix)
  read -ra packages <<< "$(paraview_product_packages)"
  link_packages "$prefix" "${packages[@]}"
  for program in paraview pvbatch pvpython pvserver; do
    write_launcher "$prefix" "$program" "$prefix/usr/bin/$program" before
  done
}

prepare_vtk()
{
  local prefix packages
  prefix=$(vtk_prefix)
  [ -n "$prefix" ] || return 0
  read -ra packages <<< "$(vtk_free_packages) $(vtk_bound_packages)"
  link_packages "$prefix" "${packages[@]}"
  write_launcher "$prefix" python3 "$python" after
}

# Print the interpreter that imports VTK's modules.
vtk_python()
{
  local prefix
  prefix=$(vtk_prefix)
  echo "${prefix:+$prefix/bin/python3}" | grep . || echo "$python"
}

# ---- The skull ---------------------------------------------------------------------------------

# If a release lacks the data package of the skull (as forky), that of the stable release is unpacked under
# build/.
skull_is_beside()
{
  command -v apt-get > /dev/null && [ -z "$(package_version "$skull_package")" ]
}

# Print the number of steps of prepare_skull.
skull_steps() { if skull_is_beside; then echo 1; else echo 0; fi; }

# Print the packages of the skull that can be installed.
skull_packages() { skull_is_beside || echo "$skull_package"; }

skull_prefix() { if skull_is_beside; then echo "$build/skull"; fi; }

# Print the file of the skull.
cranium() { echo "$(skull_prefix)/usr/share/doc/invesalius-examples/examples/Cranium.inv3"; }

unpack_skull_of_stable()
{
  local prefix mirror options
  prefix=$(skull_prefix)
  rm -rf "$prefix"
  mkdir -p "$prefix/lists/partial"
  mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Label: Debian' \
    | sed -n 1p)
  echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg]" \
    "${mirror:-http://deb.debian.org/debian} stable main" > "$prefix/sources.list"
  # Separate package lists: those of the system do not change, and root is not needed.
  options=(-q -o Dir::Etc::sourcelist="$prefix/sources.list" -o Dir::Etc::sourceparts=-
    -o Dir::State::lists="$prefix/lists" -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache=
    -o APT::Sandbox::User=)
  cd "$prefix"
  apt-get "${options[@]}" update
  apt-get "${options[@]}" download "$skull_package"
  dpkg-deb -x "$skull_package"_*.deb "$prefix"
  rm -r "$skull_package"_*.deb lists sources.list
}

# prepare_skull: put the skull into the file of cranium; no step if it exists.
prepare_skull()
{
  if skull_is_beside; then
    if [ -e "$(cranium)" ]; then
      run_step "The skull's package: unpacked" skull true
    else
      run_step "Unpacking the skull's package of Debian's stable release" skull \
        unpack_skull_of_stable
    fi
  fi
}
