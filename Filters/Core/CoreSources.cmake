# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# The sources of the core, for the module and for the tests, which see what the library hides.

set(volumic_core_sources
  AxisOperator.cxx
  LevelReduction.cxx
  PyramidGeometry.cxx
  RowKernels.cxx)
set(volumic_core_headers
  AxisOperator.h
  Executor.h
  LevelReduction.h
  PyramidGeometry.h
  RowKernels.h)
list(TRANSFORM volumic_core_sources PREPEND "${CMAKE_CURRENT_LIST_DIR}/")
list(TRANSFORM volumic_core_headers PREPEND "${CMAKE_CURRENT_LIST_DIR}/")

# Results are the same bits on every processor: no product and sum is contracted into one rounding.
set(volumic_core_options)
if (CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  set(volumic_core_options "$<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>")
endif ()
