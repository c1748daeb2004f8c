# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Puts the project RemoteModule, which stands in for VTK, into FOLDER and the sources of Volumic into
# its folder Remote, as if fetched there; configures it, and compiles one filter and its program.

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

run("${CMAKE_COMMAND}" -S "${FOLDER}" -B "${FOLDER}/build" -G "${GENERATOR}" "-DVTK_DIR=${VTK_DIR}"
  -DCMAKE_BUILD_TYPE=Release)
if (GENERATOR MATCHES "Ninja") # which compiles a single file, by the name of what comes of it
  run("${CMAKE_COMMAND}" --build "${FOLDER}/build" --target
    Remote/Volumic/Filters/CMakeFiles/FiltersVolumic.dir/vtkImagePyramid.cxx.o
    CMakeFiles/UseRemoteModule.dir/UseRemoteModule.cxx.o)
endif ()
