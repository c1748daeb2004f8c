# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Finds the modules of VTK that the program `volumic` uses. To be included in the scope that found
# VTK or Volumic: what VTK finds for its modules must be known where its targets are.

# With ParaView, all of its own VTK was found already.
if (NOT ParaView_FOUND)
  find_package(VTK REQUIRED
    COMPONENTS FiltersCore FiltersGeneral ImagingCore IOCore IOGeometry IOImage IOLegacy IOPLY IOXML
      ParallelCore png tiff zlib
    OPTIONAL_COMPONENTS IOHDF IOMINC ParallelMPI mpi)
endif ()
