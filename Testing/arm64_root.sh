#!/bin/bash
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Unpacks Debian's VTK and GoogleTest for arm64 with all dependencies into a folder, for
# CMake/aarch64-linux-gnu.cmake. Its programs run only in qemu. The preset `arm64` uses
# build/arm64-root. Downloads 600 MB, needs 3 GB on disk, and does not need root.
#
#   bash Testing/arm64_root.sh build/arm64-root
#   cmake --preset arm64 && cmake --build --preset arm64 && ctest --preset arm64

set -eo pipefail

if [ $# -ne 1 ] || [[ $1 == -* ]]; then
  sed -n '5,11s/^# \{0,1\}//p' "$0"
  exit 2
fi
arm64_root=$(realpath -m "$1")
packages=(base-files libc6-dev libvtk9-dev libgtest-dev libcgal-dev)

program=$(echo /usr/bin/vtkWrapHierarchy-*)
if [ ! -e "$program" ]; then
  echo "$program does not exist. Install libvtk9-dev for this machine." >&2
  exit 1
fi
if [ -e "$arm64_root" ] && [ -n "$(ls -A "$arm64_root")" ]; then
  echo "$arm64_root is not empty. Choose another folder or remove it." >&2
  exit 1
fi

# Uses this machine's package sources with separate lists and state.
state=$(mktemp -d)
trap 'rm -rf "$state"' EXIT
mkdir -p "$state/lists/partial" "$state/archives/partial" "$arm64_root"
touch "$state/status"
apt=(apt-get -q -o APT::Architecture=arm64 -o APT::Architectures::=arm64
  -o Dir::State="$state" -o Dir::State::status="$state/status" -o Dir::Cache="$state"
  -o Debug::NoLocking=1 -o APT::Sandbox::User="$(id -un)")
"${apt[@]}" update
"${apt[@]}" install -y --download-only --no-install-recommends "${packages[@]}"

# base-files first: it has the links from /lib to /usr/lib.
for package in "$state"/archives/base-files_*.deb "$state"/archives/*.deb; do
  dpkg-deb -x "$package" "$arm64_root"
done
# Links that packages create when they are configured; VTK's libraries need them.
libraries=$arm64_root/usr/lib/aarch64-linux-gnu
ln -sf blas/libblas.so.3 lapack/liblapack.so.3 "$libraries/"
# The only program of VTK that the build runs.
cp "$program" "$arm64_root/usr/bin/"
echo "VTK for arm64: $arm64_root"
