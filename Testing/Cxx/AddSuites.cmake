# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Included by ctest: add a test for each suite of the GoogleTest program `program` (a command with its
# emulator), for each test if `each` is true, with the properties `properties`.

function (add_suite name filter)
  add_test("${name}" ${program} "--gtest_filter=${filter}")
  # A suite counts as skipped if all its tests are skipped.
  set_tests_properties("${name}" PROPERTIES
    SKIP_REGULAR_EXPRESSION "PASSED  \\] 0 tests\\.\n(\\[  SKIPPED \\][^[]*)+$"
    ${properties})
endfunction ()

execute_process(COMMAND ${program} --gtest_list_tests
  OUTPUT_VARIABLE listing RESULT_VARIABLE status TIMEOUT 300)
if (NOT status EQUAL 0)
  # The program is missing or fails: add a failing test.
  add_suite("${program}" "*")
  set(listing "")
endif ()
# Suites begin a line and end with a point; their tests are indented.
string(REGEX MATCHALL "\n( +[^ \n]+|[^ \n]+\\.)" lines "\n${listing}")
foreach (line IN LISTS lines)
  string(REGEX REPLACE "[\n ]" "" name "${line}")
  if (line MATCHES "^\n ")
    if (each)
      add_suite("${suite}${name}" "${suite}${name}")
    endif ()
  else ()
    set(suite "${name}")
    if (NOT each)
      string(REGEX REPLACE "\\.$" "" name "${suite}")
      add_suite("${name}" "${suite}*")
    endif ()
  endif ()
endforeach ()
