# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Runs the example program EXAMPLE by MPIRUN in FOLDER, on a cube and on a volume that is not there.

if (NOT MPIRUN OR NOT EXISTS "${EXAMPLE}")
  message("Skipped: mpirun or VTK's MPI (VTK::ParallelMPI) is missing")
  return ()
endif ()
file(REMOVE_RECURSE "${FOLDER}")
file(MAKE_DIRECTORY "${FOLDER}")
# A bar along x, 12 voxels wide in y and z.
string(REPEAT "0 " 40 outside)
string(REPEAT "0 " 8 end)
string(REPEAT "9 " 24 inside)
string(REPEAT "${outside}" 8 below)
string(REPEAT "${end}${inside}${end}" 12 between)
string(REPEAT "${outside}" 28 empty)
string(REPEAT "${empty}" 8 first)
string(REPEAT "${below}${between}${below}" 12 middle)
file(WRITE "${FOLDER}/volume.vti" "<VTKFile type=\"ImageData\" version=\"1.0\">
<ImageData WholeExtent=\"0 39 0 27 0 27\" Origin=\"0 0 0\" Spacing=\"1 1 1\">
<Piece Extent=\"0 39 0 27 0 27\"><PointData Scalars=\"Voxels\">
<DataArray type=\"Int16\" Name=\"Voxels\" format=\"ascii\">${first}${middle}${first}</DataArray>
</PointData></Piece></ImageData></VTKFile>
")

execute_process(COMMAND "${MPIRUN}" -n 3 "${EXAMPLE}" "${FOLDER}/volume.vti" "${FOLDER}/3.pvtp" 4.5
  OUTPUT_VARIABLE output ERROR_VARIABLE errors RESULT_VARIABLE status TIMEOUT 60)
message("${output}${errors}")
string(REGEX MATCHALL "rank [0-9]: [1-9][0-9]* triangles" told "${output}")
list(LENGTH told count)
if (NOT status EQUAL 0 OR NOT count EQUAL 3 OR NOT EXISTS "${FOLDER}/3.pvtp")
  message(FATAL_ERROR "The example failed: status ${status}")
endif ()

execute_process(
  COMMAND "${MPIRUN}" -n 2 "${EXAMPLE}" "${FOLDER}/missing.vti" "${FOLDER}/missing.pvtp" 4.5
  OUTPUT_VARIABLE output ERROR_VARIABLE errors RESULT_VARIABLE status TIMEOUT 60)
if (status EQUAL 0 OR EXISTS "${FOLDER}/missing.pvtp")
  message(FATAL_ERROR "A missing volume went unnoticed: ${status}")
endif ()
if (status MATCHES "timeout")
  message(FATAL_ERROR "A missing volume is waited for")
endif ()
