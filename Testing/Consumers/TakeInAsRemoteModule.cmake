# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Puts the project RemoteModule, which stands in for VTK, into FOLDER and the sources of Volumic into
# its folder Remote, as if fetched there; configures it and compiles a file of each kind.

function (run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status)
  if (NOT status EQUAL 0)
    message(FATAL_ERROR "Failed (${status}): ${ARGV}")
  endif ()
endfunction ()

file(REMOVE_RECURSE "${FOLDER}/Remote")
file(COPY "${CMAKE_CURRENT_LIST_DIR}/RemoteModule/" DESTINATION "${FOLDER}")
file(GLOB entries RELATIVE "${VOLUMIC_SOURCE_DIR}" "${VOLUMIC_SOURCE_DIR}/*")
list(FILTER entries EXCLUDE REGEX "^build")
foreach (entry IN LISTS entries)
  file(COPY "${VOLUMIC_SOURCE_DIR}/${entry}" DESTINATION "${FOLDER}/Remote/Volumic")
endforeach ()

# No precompiled headers, which hide that a file does not include what it uses.
run("${CMAKE_COMMAND}" -S "${FOLDER}" -B "${FOLDER}/build" -G Ninja "-DVTK_DIR=${VTK_DIR}"
  -DCMAKE_BUILD_TYPE=None -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON)
set(objects "")
set(module FiltersVolumic)
file(STRINGS "${FOLDER}/build/build.ninja" newer REGEX "/vtkFiltersVolumic\\.dir/" LIMIT_COUNT 1)
if (newer) # VTK 9.7
  set(module vtkFiltersVolumic)
endif ()
foreach (source IN ITEMS
    VolumicCore.dir/Core/Mesh/SurfaceMesh.cxx
    ${module}.dir/Unity/unity_0_cxx.cxx)
  list(APPEND objects "Remote/Volumic/Filters/CMakeFiles/${source}.o")
endforeach ()
run("${CMAKE_COMMAND}" --build "${FOLDER}/build" --target ${objects})
message("Volumic can be taken in as a remote module.")
