# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# VOLUMIC_EXTRA_WARNINGS: more warnings for all targets of the project, except VTK's wrappers. Headers of
# VTK, ParaView, Qt and CGAL are system headers, for which the compiler does not warn.
# CMAKE_COMPILE_WARNING_AS_ERROR=ON (CMake 3.24) turns warnings into errors.

if (NOT CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  message(WARNING "VOLUMIC_EXTRA_WARNINGS adds nothing: it supports GCC and Clang, "
    "not those of ${CMAKE_CXX_COMPILER_ID}.")
  return ()
endif ()

set(volumic_warnings -Wall -Wextra -Wshadow)
set(volumic_vtk_warnings ${volumic_warnings} -Wpedantic)
if (CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  # For the semicolon after vtkTypeMacro().
  list(APPEND volumic_vtk_warnings -Wno-extra-semi)
elseif (CMAKE_CXX_COMPILER_VERSION VERSION_LESS 14)
  # For the same reason; this compiler has no separate flag for it.
  list(REMOVE_ITEM volumic_vtk_warnings -Wpedantic)
endif ()
list(APPEND volumic_warnings -Wpedantic)

# Warn about conversions of numbers in the library and plugin, but not about signs, which Clang includes:
# vertices and voxels have signed numbers, containers unsigned ones.
set(volumic_conversion_warnings -Wconversion -Wno-sign-conversion)

# volumic_add_warnings(WARNINGS TARGET...)
function (volumic_add_warnings warnings)
  foreach (target IN LISTS ARGN)
    if (TARGET "${target}")
      get_target_property(module "${target}" ALIASED_TARGET) # of VTK, which names it
      if (module)
        set(target "${module}")
      endif ()
      target_compile_options("${target}" PRIVATE "$<$<COMPILE_LANGUAGE:CXX>:${warnings}>")
    endif ()
  endforeach ()
endfunction ()

volumic_add_warnings("${volumic_warnings};${volumic_conversion_warnings}" VolumicCore)
volumic_add_warnings("${volumic_vtk_warnings};${volumic_conversion_warnings}"
  Volumic::FiltersVolumic Volumic::ServerManagerVolumic BuildPyramid Volumic)
volumic_add_warnings("${volumic_warnings}" TestCore VolumicTestSupport)
volumic_add_warnings("${volumic_vtk_warnings}"
  TestFilters TestRealScans TestScenes Benchmark VolumicBenchmarkItk)
