# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# VOLUMIC_EXTRA_WARNINGS adds warnings to all targets of the project except generated wrappers. Headers
# of VTK, ParaView, Qt and CGAL are system headers, which give no warnings.
# CMAKE_COMPILE_WARNING_AS_ERROR=ON (CMake 3.24) turns warnings into errors.

if (NOT CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  message(WARNING "VOLUMIC_EXTRA_WARNINGS adds nothing: it supports GCC and Clang, "
    "not those of ${CMAKE_CXX_COMPILER_ID}.")
  return ()
endif ()

set(volumic_warnings -Wall -Wextra -Wshadow)
set(volumic_vtk_warnings ${volumic_warnings} -Wpedantic)
if (CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  # VTK writes a semicolon after vtkTypeMacro(), which is redundant.
  list(APPEND volumic_vtk_warnings -Wno-extra-semi)
elseif (CMAKE_CXX_COMPILER_VERSION VERSION_LESS 14)
  # The same semicolon. GCC before 14 has no separate flag for it.
  list(REMOVE_ITEM volumic_vtk_warnings -Wpedantic)
endif ()
list(APPEND volumic_warnings -Wpedantic)

# Warnings on conversions, for targets that users run. Conversions of signs are excluded, because
# indices of vertices and voxels are signed and sizes of containers unsigned.
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
