#!/bin/bash
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Run the tests, or another command, on any release of Debian: a minimal system in a folder, made by
# debootstrap, with a copy of this checkout. Needs root for chroot.

set -eo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../CMake/debian.sh"

usage()
{
  cat << 'USAGE'
Usage: bash Testing/on_debian.sh [OPTION]... RELEASE [COMMAND [ARGUMENT]...]
  RELEASE           bookworm, trixie, forky, testing, sid or another name; or 12, 13, 14
  COMMAND           what is run in the copy's root folder; by default bash Testing/run.sh
  --system DIR      keep the system in DIR, or use the system that is there; by default it is made
                    in a temporary folder and removed at the end
  --bind DIR        mount this folder in the system under the same name; may be repeated
  --mirror URL      Debian mirror (default: the mirror of this machine)
  --help            this text
The copy is /volumic/checkout in the system. Its build folder is kept as long as the system. If there
is a folder `shared` beside this checkout, it is mounted beside the copy, read-only.
Exit status: the command's.
USAGE
}

system=
mirror=
binds=()
take_option()
{
  case $1 in
    --system)
      need_value "a value" "$@"
      system=$2
      ;;
    --bind)
      need_value "a value" "$@"
      [ -d "$2" ] || fail "--bind: $2 is not a folder"
      binds+=("$(realpath "$2")")
      ;;
    --mirror)
      need_value "a value" "$@"
      mirror=$2
      ;;
    -*) return 1 ;;
    *) used=0 ;; # the release
  esac
}
parse_options "$@"
set -- "${arguments[@]}"
if [ $# -eq 0 ]; then
  usage >&2
  fail "Which release of Debian?"
fi
release=$1
shift
case $release in
  12) release=bookworm ;;
  13) release=trixie ;;
  14) release=forky ;;
  *[!a-z]*) fail "$release is not a release of Debian" ;;
esac
case ${1-} in
  -*) fail "$1: options come before the release" ;;
esac
if [ $# -gt 0 ]; then
  command=("$@")
else
  command=(bash Testing/run.sh)
fi
[ "$(id -u)" -eq 0 ] || fail "Run this script as root, which chroot requires."

# ---- Cleaning up -------------------------------------------------------------------------------

# All mounts are in a namespace that ends with its processes, and these end with this script even if it
# is killed. Only the temporary folder has to be removed here.
temporary=
child=
clean_up()
{
  trap - EXIT
  if [ -n "$child" ]; then
    kill -KILL "$child" 2> /dev/null || true
    wait "$child" 2> /dev/null || true
  fi
  [ -z "$temporary" ] || rm -rf --one-file-system "$temporary"
}
trap clean_up EXIT
trap 'exit 129' HUP
trap 'exit 130' INT
trap 'exit 143' TERM

# apart COMMAND...: run the command with separate mounts and processes. It runs in the background,
# because bash handles signals only after a command in the foreground ends.
apart()
{
  local status=0
  setpriv --pdeathsig KILL \
    unshare --mount --propagation private --pid --fork --kill-child --mount-proc "$@" <&0 &
  child=$!
  wait "$child" || status=$?
  child=
  return "$status"
}

# ---- The system --------------------------------------------------------------------------------

# Print the Debian mirror of this machine, if any. Otherwise debootstrap has a default.
configured_mirror()
{
  apt-get indextargets --format '$(REPO_URI)' 'Origin: Debian' 'Label: Debian' \
    'Created-By: Packages' | sed -n 1p
}

# make_system DIR: a minimal Debian.
make_system()
{
  local scripts=/usr/share/debootstrap/scripts script
  script=$scripts/$release
  [ -e "$script" ] || script=$scripts/sid # a release that is newer than debootstrap
  debootstrap --variant=minbase \
    --keyring=/usr/share/keyrings/debian-archive-keyring.gpg \
    "$release" "$1" "${mirror:-http://deb.debian.org/debian}" "$script"
}

# Settings of apt to reach the mirror, such as proxies.
copy_network_settings()
{
  cp -L /etc/resolv.conf /etc/hosts "$1/etc/"
  apt-config dump Acquire::http Acquire::https Acquire::Check-Valid-Until Acquire::Check-Date \
    > "$1/etc/apt/apt.conf.d/90machine"
}

# copy_checkout DIR: copy this checkout without files that git ignores, and keep DIR/build. Files get
# the time of the copy, so that the next build notices all changes.
copy_checkout()
{
  mkdir -p "$1"
  find "$1" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
  (cd "$root" && git -c safe.directory="$root" ls-files -z --cached --others --exclude-standard \
    | while IFS= read -r -d '' file; do [ ! -e "$file" ] || printf '%s\0' "$file"; done \
    | tar -c --null -T -) | tar -x --no-same-owner --touch -C "$1"
}

# The namespace's first process: SYSTEM SHARED BIND... -- COMMAND...
enter='
  set -e
  system=$1 shared=$2
  shift 2
  mount -t proc proc "$system/proc"
  mount --rbind /sys "$system/sys"
  mount --rbind /dev "$system/dev"
  if [ -n "$shared" ]; then
    mkdir -p "$system/volumic/shared"
    mount --bind "$shared" "$system/volumic/shared"
    mount -o remount,bind,ro "$system/volumic/shared"
  fi
  while [ "$1" != -- ]; do
    mkdir -p "$system$1"
    mount --bind "$1" "$system$1"
    shift
  done
  shift
  exec chroot "$system" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root \
    LANG=C.UTF-8 TERM="${TERM:-dumb}" DEBIAN_FRONTEND=noninteractive \
    sh -c "cd /volumic/checkout && exec \"\$@\"" sh "$@"'

# In braces, so that bash reads all of it before it runs. The file may then be edited.
{
plan_steps 3
install_packages debootstrap debian-archive-keyring git
[ -n "$mirror" ] || mirror=$(configured_mirror)

if [ -z "$system" ]; then
  temporary=$(mktemp -d)
  system=$temporary/system
fi
if [ -e "$system/etc/os-release" ]; then
  present=$(. "$system/etc/os-release" && echo "${VERSION_CODENAME:-unknown}")
  case $release in
    "$present" | testing | sid | unstable) ;;
    *) fail "$system holds Debian $present, not $release. Choose another folder, or remove it." ;;
  esac
  run_step "System: Debian $present of an earlier run" debian-system true
else
  if [ -e "$system" ] && [ -n "$(ls -A "$system")" ]; then
    fail "$system holds something else. Choose a folder that is empty or not there yet."
  fi
  # The folder has another name until the system is complete.
  export -f make_system
  export release mirror
  rm -rf --one-file-system "$system.partial"
  run_step "Making a Debian $release" debian-system \
    apart bash -c 'make_system "$1"' make_system "$system.partial"
  [ ! -e "$system" ] || rmdir "$system"
  mv "$system.partial" "$system"
fi
system=$(realpath "$system")
# Another run would replace the sources during a build.
exec 9> "$system/volumic.lock"
flock -n 9 || fail "$system is in use by another run. Wait for its end, or choose another folder."

prepare_system()
{
  copy_network_settings "$system"
  copy_checkout "$system/volumic/checkout"
}
run_step "Copying the checkout" debian-copy prepare_system

shared=$root/../shared
[ -d "$shared" ] || shared=
say "In the Debian $(cat "$system/etc/debian_version"): ${command[*]}"
status=0
apart sh -c "$enter" enter "$system" "${shared:+$(realpath "$shared")}" "${binds[@]}" -- \
  "${command[@]}" || status=$?
exit "$status"
}
