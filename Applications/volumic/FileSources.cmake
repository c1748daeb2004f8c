# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Sets volumic_reader_sources: what reads volumes and the names of labels (ReadVolume.h,
# LabelNames.h), with absolute paths, and volumic_file_libraries: what they need beside VTK. The
# program has them, and the reader of the ParaView plugin.
set(volumic_reader_sources
  BinaryFile.cxx
  CheckImages.cxx
  CheckXmlInput.cxx
  InputFiles.cxx
  LabelJson.cxx
  LabelNames.cxx
  LabelTable.cxx
  MaskFolder.cxx
  Messages.cxx
  RawSlabs.cxx
  ReadInv3.cxx
  ReadNifti.cxx
  ReadNrrd.cxx
  ReadPictures.cxx
  ReadPlain.cxx
  ReadTiff.cxx
  ReadRaw.cxx
  ReadVolume.cxx
  RegularGrid.cxx
  SlabReader.cxx
  Texts.cxx
  TiffTags.cxx
  VolumeImage.cxx
  WorldSpace.cxx)
find_package(nlohmann_json 3.9 REQUIRED) # headers, in Debian's nlohmann-json3-dev
find_package(LibArchive REQUIRED)        # in Debian's libarchive-dev
set(volumic_file_libraries nlohmann_json::nlohmann_json LibArchive::LibArchive)
# ITK reads DICOM (by GDCM, which comes with it) and what VTK has no reader for.
option(VOLUMIC_USE_ITK "Have ITK read DICOM and other formats, where it is found" ON)
set(volumic_reader_includes "")
if (VOLUMIC_USE_ITK)
  set(volumic_log_level "${CMAKE_MESSAGE_LOG_LEVEL}")
  set(CMAKE_MESSAGE_LOG_LEVEL WARNING) # GDCM's package tells of programs that nobody wants.
  find_package(ITK 5.2 QUIET COMPONENTS ITKIOGDCM ITKIOGIPL ITKIOMINC)
  set(CMAKE_MESSAGE_LOG_LEVEL "${volumic_log_level}")
  if (ITK_FOUND)
    message(STATUS "DICOM, GIPL and MINC 2 by ITK ${ITK_VERSION}")
    list(APPEND volumic_reader_sources DicomFiles.cxx DicomStructure.cxx ReadDicom.cxx ReadItk.cxx)
    list(APPEND volumic_file_libraries ${ITK_LIBRARIES} ${ITKGDCM_LIBRARIES})
    set(volumic_reader_includes ${ITK_INCLUDE_DIRS} ${ITKGDCM_INCLUDE_DIRS})
  else ()
    message(STATUS "No DICOM: ITK is missing (Debian: libinsighttoolkit5-dev)")
  endif ()
endif ()
if (NOT ITK_FOUND)
  list(APPEND volumic_reader_sources WithoutItk.cxx)
endif ()
list(TRANSFORM volumic_reader_sources PREPEND "${CMAKE_CURRENT_LIST_DIR}/")

# Sets volumic_writer_sources: what writes surfaces (WriteResults.h), beside the readers.
set(volumic_writer_sources
  GltfScene.cxx
  OutputFiles.cxx
  SolidFiles.cxx
  SolidRegions.cxx
  SolidShells.cxx
  SolverFiles.cxx
  SurfaceFacts.cxx
  SurfaceFormats.cxx
  SurfacePieces.cxx
  Tetrahedra.cxx
  ThreeMf.cxx
  VtkWriters.cxx
  WriteResults.cxx)
list(TRANSFORM volumic_writer_sources PREPEND "${CMAKE_CURRENT_LIST_DIR}/")
