# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Included by ctest, before it runs: a test for each suite of the GoogleTest program `program` (with an
# emulator before it where one is needed), with the properties `properties`. A process for each test
# would take longer than most tests do; where `each` is true, they are long enough.

function (add_suite name filter)
  add_test("${name}" ${program} "--gtest_filter=${filter}")
  # Skipped is a suite of which each test is.
  set_tests_properties("${name}" PROPERTIES
    SKIP_REGULAR_EXPRESSION "PASSED  \\] 0 tests\\.\n(\\[  SKIPPED \\][^[]*)+$"
    ${properties})
endfunction ()

execute_process(COMMAND ${program} --gtest_list_tests
  OUTPUT_VARIABLE listing RESULT_VARIABLE status TIMEOUT 300)
if (NOT status EQUAL 0)
  # It's not built, or does not start: a test that fails tells so.
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
