# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Sets volumic_reader_sources: what reads volumes and the names of labels (ReadVolume.h,
# LabelNames.h), with absolute paths, and volumic_file_libraries: what they need beside VTK. The
# program has them, and the reader of the ParaView plugin.
set(volumic_reader_sources
  BinaryFile.cxx
  CheckImages.cxx
  CheckTiff.cxx
  CheckXmlInput.cxx
  DicomHeader.cxx
  InputFiles.cxx
  LabelJson.cxx
  LabelNames.cxx
  LabelTable.cxx
  MaskFolder.cxx
  Messages.cxx
  RawSlabs.cxx
  ReadDicom.cxx
  ReadInv3.cxx
  ReadNifti.cxx
  ReadNrrd.cxx
  ReadPictures.cxx
  ReadRaw.cxx
  ReadVolume.cxx
  SlabReader.cxx
  Texts.cxx
  VolumeImage.cxx
  WorldSpace.cxx)
find_package(nlohmann_json 3.9 REQUIRED) # headers, in Debian's nlohmann-json3-dev
find_package(LibArchive REQUIRED)        # in Debian's libarchive-dev
set(volumic_file_libraries nlohmann_json::nlohmann_json LibArchive::LibArchive)
list(TRANSFORM volumic_reader_sources PREPEND "${CMAKE_CURRENT_LIST_DIR}/")

# Sets volumic_writer_sources: what writes surfaces (WriteResults.h), beside the readers.
set(volumic_writer_sources
  GltfScene.cxx
  OutputFiles.cxx
  SolidRegions.cxx
  SolidShells.cxx
  SolverFiles.cxx
  SurfaceFacts.cxx
  SurfaceFormats.cxx
  SurfacePieces.cxx
  VtkWriters.cxx
  WriteResults.cxx)
list(TRANSFORM volumic_writer_sources PREPEND "${CMAKE_CURRENT_LIST_DIR}/")
