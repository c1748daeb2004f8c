#!/bin/bash
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs the tests or another command on a minimal Debian of any release, which debootstrap installs in a
# folder, with a copy of this checkout. Needs root for chroot.

set -eo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../CMake/debian.sh"

usage()
{
  cat << 'USAGE'
Usage: bash Testing/on_debian.sh [OPTION]... RELEASE [COMMAND [ARGUMENT]...]
  RELEASE           bookworm, trixie, forky, testing, sid or another name; or 12, 13, 14
  COMMAND           command to run in the root folder of the copy (default: bash Testing/run.sh)
  --system DIR      keep the system in DIR, or use the one that an earlier run made there (default:
                    a temporary folder, which is removed at the end)
  --bind DIR        mount this folder in the system under the same name; may be repeated
  --mirror URL      package mirror (default: that of this machine)
  --help            print this text
The copy is /volumic/checkout in the system. Its build folder is kept with the system. A folder
`shared` beside this checkout is mounted read-only beside the copy.
Exit status: that of the command.
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
  fail "The release of Debian is missing."
fi
release=$1
shift
case $release in
  12) release=bookworm ;;
  13) release=trixie ;;
  14) release=forky ;;
  *[!a-z]*) fail "$release is not a release of Debian." ;;
esac
case ${1-} in
  -*) fail "Put the option $1 before the release." ;;
esac
if [ $# -gt 0 ]; then
  command=("$@")
else
  command=(bash Testing/run.sh)
fi
[ "$(id -u)" -eq 0 ] || fail "Run this script as root (sudo)."

# ---- Cleaning up -------------------------------------------------------------------------------

# All mounts are in a namespace that ends with its processes, and these end with this script, even if
# it is killed. Only the temporary folder must be removed here.
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

# apart COMMAND...: run a command in its own mount and process namespace, in the background, so that
# signals are handled before it ends.
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

# Print the mirror of this machine's Debian packages; if empty, the default mirror is used.
configured_mirror()
{
  apt-get indextargets --format '$(REPO_URI)' 'Origin: Debian' 'Label: Debian' \
    'Created-By: Packages' | sed -n 1p
}

# make_system DIR: install a minimal Debian.
make_system()
{
  local scripts=/usr/share/debootstrap/scripts script
  script=$scripts/$release
  [ -e "$script" ] || script=$scripts/sid # the release is newer than debootstrap
  debootstrap --variant=minbase \
    --keyring=/usr/share/keyrings/debian-archive-keyring.gpg \
    "$release" "$1" "${mirror:-http://deb.debian.org/debian}" "$script"
}

# Copy how apt reaches the mirror, such as proxies.
copy_network_settings()
{
  cp -L /etc/resolv.conf /etc/hosts "$1/etc/"
  apt-config dump Acquire::http Acquire::https Acquire::Check-Valid-Until Acquire::Check-Date \
    > "$1/etc/apt/apt.conf.d/90machine"
}

# copy_checkout DIR: copy this checkout without ignored files; DIR/build stays. Files get the time of
# the copy: with their own times, changes made during an earlier build would not be compiled.
copy_checkout()
{
  mkdir -p "$1"
  find "$1" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
  (cd "$root" && git -c safe.directory="$root" ls-files -z --cached --others --exclude-standard \
    | while IFS= read -r -d '' file; do [ ! -e "$file" ] || printf '%s\0' "$file"; done \
    | tar -c --null -T -) | tar -x --no-same-owner --touch -C "$1"
}

# The first process of the namespace: SYSTEM SHARED BIND... -- COMMAND...
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

# In braces, so that bash reads all of it first: this file may be edited during the run.
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
    *) fail "$system contains Debian $present, not $release. Choose another folder or remove it." ;;
  esac
  run_step "System: Debian $present of an earlier run" debian-system true
else
  if [ -e "$system" ] && [ -n "$(ls -A "$system")" ]; then
    fail "$system does not contain a Debian. Choose an empty or new folder."
  fi
  # Has another name until it is complete.
  export -f make_system
  export release mirror
  rm -rf --one-file-system "$system.partial"
  run_step "Making a Debian $release" debian-system \
    apart bash -c 'make_system "$1"' make_system "$system.partial"
  [ ! -e "$system" ] || rmdir "$system"
  mv "$system.partial" "$system"
fi
system=$(realpath "$system")
# A second run would replace the sources during compilation.
exec 9> "$system/volumic.lock"
flock -n 9 || fail "$system is used by another run. Wait until it ends or choose another folder."

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
