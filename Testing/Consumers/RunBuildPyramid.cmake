# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Runs the example program EXAMPLE in FOLDER on a small volume, and on one that is not there.

file(REMOVE_RECURSE "${FOLDER}")
file(MAKE_DIRECTORY "${FOLDER}")
string(REPEAT "1 2 3 4 5 6 7 8 9 0 " 2400 voxels)
file(WRITE "${FOLDER}/volume.vti" "<VTKFile type=\"ImageData\" version=\"1.0\">
<ImageData WholeExtent=\"0 39 0 29 0 19\" Origin=\"0 0 0\" Spacing=\"1 1 2\">
<Piece Extent=\"0 39 0 29 0 19\"><PointData Scalars=\"Voxels\">
<DataArray type=\"Int16\" Name=\"Voxels\" format=\"ascii\">${voxels}</DataArray>
</PointData></Piece></ImageData></VTKFile>
")

execute_process(
  COMMAND "${EXAMPLE}" "${FOLDER}/volume.vti" "${FOLDER}/pyramid.vtm" 2
  OUTPUT_VARIABLE output ERROR_VARIABLE errors RESULT_VARIABLE status)
message("${output}${errors}")
if (NOT status EQUAL 0 OR NOT output MATCHES "Level 1: 23 x 17 x 11 voxels, unit 1.73")
  message(FATAL_ERROR "The example failed: status ${status}")
endif ()
if (NOT EXISTS "${FOLDER}/pyramid.vtm" OR NOT EXISTS "${FOLDER}/pyramid/pyramid_1.vti")
  message(FATAL_ERROR "The example left no pyramid")
endif ()

execute_process(
  COMMAND "${EXAMPLE}" "${FOLDER}/missing.vti" "${FOLDER}/missing.vtm"
  OUTPUT_VARIABLE output ERROR_VARIABLE errors RESULT_VARIABLE status)
if (status EQUAL 0 OR EXISTS "${FOLDER}/missing.vtm")
  message(FATAL_ERROR "A missing volume went unnoticed")
endif ()
