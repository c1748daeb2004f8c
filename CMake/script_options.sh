# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Sourced by debian.sh: parser of command lines. A script defines `usage`, which prints its help, and
# `take_option`, whose arguments are the rest of the command line, beginning with an option:
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

# parse_options WORD...: handle --help, and end the script at an unknown option. If take_option sets used=0,
# the options end: the array `arguments` gets this word and the rest.
parse_options()
{
  local used # number of words of the option
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

# need_value WHAT OPTION [VALUE]...: for take_option: the next word is the value of the option.
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
