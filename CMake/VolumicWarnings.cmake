# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# VOLUMIC_EXTRA_WARNINGS: more warnings for every target that holds code of ours, and for none of
# VTK's wrappings. Headers of VTK, ParaView, Qt and CGAL are the system's for the compiler, which is
# silent about them. CMAKE_COMPILE_WARNING_AS_ERROR=ON (CMake 3.24) makes errors of the warnings.

if (NOT CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  message(WARNING "VOLUMIC_EXTRA_WARNINGS adds nothing: it knows the flags of GCC and Clang only, "
    "not those of ${CMAKE_CXX_COMPILER_ID}.")
  return ()
endif ()

set(volumic_warnings -Wall -Wextra -Wshadow)
set(volumic_vtk_warnings ${volumic_warnings} -Wpedantic)
if (CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  # The semicolon that VTK's habits put behind vtkTypeMacro() is one too many.
  list(APPEND volumic_vtk_warnings -Wno-extra-semi)
elseif (CMAKE_CXX_COMPILER_VERSION VERSION_LESS 14)
  # The same; and this compiler has no flag of its own for it.
  list(REMOVE_ITEM volumic_vtk_warnings -Wpedantic)
endif ()
list(APPEND volumic_warnings -Wpedantic)

# Numbers are converted with care in what users run. Signs are left out, which Clang counts in:
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
