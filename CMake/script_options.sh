# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Sourced by debian.sh. Reads the command lines of the project's scripts. A script defines `usage`,
# which prints its help, and `take_option`, which gets the remaining words, the option first:
#
#   take_option()
#   {
#     case $1 in
#       --fast) fast=yes ;;
#       -R) need_value "a regular expression" "$@"; regex=$2 ;;
#       *) return 1 ;;                   # an unknown option
#     esac
#   }
#   parse_options "$@"

# parse_options WORD...: handle --help, and exit on unknown options. If take_option sets used=0, the
# options end, and this word and the rest are stored in the array `arguments`.
parse_options()
{
  local used # words of the option
  arguments=()
  while [ $# -gt 0 ]; do
    case $1 in
      -h | --help)
        usage
        exit 0
        ;;
    esac
    used=1
    if ! take_option "$@"; then
      usage >&2
      fail "Unknown option: $1"
    fi
    if [ "$used" -eq 0 ]; then
      arguments=("$@")
      return
    fi
    shift "$used"
  done
}

# need_value WHAT OPTION [VALUE]...: in take_option: use the next word as the value of the option.
need_value()
{
  [ $# -ge 3 ] || fail "$2 needs $1"
  used=2
}

# need_number OPTION [VALUE]...: the same for an integer.
need_number()
{
  [[ ${2:-} =~ ^[0-9]+$ ]] || fail "$1 needs a number"
  used=2
}
