# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Included by ctest, before it runs: a test for each suite of the GoogleTest program `program`, with
# the properties `properties`. A process for each test would take longer than most tests do.

execute_process(COMMAND "${program}" --gtest_list_tests
  OUTPUT_VARIABLE listing RESULT_VARIABLE status TIMEOUT 300)
if (NOT status EQUAL 0)
  # It's not built, or does not start: which is told as a test that fails.
  get_filename_component(listing "${program}" NAME)
  set(listing "\n${listing}.")
endif ()
# Suites stand at the beginning of a line and end with a point, tests are indented.
string(REGEX MATCHALL "\n[^ \n]+\\." suites "\n${listing}")
foreach (suite IN LISTS suites)
  string(REGEX REPLACE "^\n(.*)\\.$" "\\1" suite "${suite}")
  add_test("${suite}" "${program}" "--gtest_filter=${suite}.*")
  # Skipped is a suite of which each test is.
  set_tests_properties("${suite}" PROPERTIES
    SKIP_REGULAR_EXPRESSION "PASSED  \\] 0 tests\\.\n(\\[  SKIPPED \\][^[]*)+$"
    ${properties})
endforeach ()
