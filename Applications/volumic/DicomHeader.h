// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicDicomHeader_h
#define volumicDicomHeader_h

#include <cstdint>
#include <string>

namespace tool
{
/** What vtkDICOMImageReader does not tell or look at. */
struct DicomHeader
{
  std::string Syntax; ///< how the file is encoded, an identifier
  std::string Class;  ///< of the object: an image of CT, a report, ...
  std::string Series; ///< the identifier of the series
  std::string Description; ///< of the series, for people
  int Samples = 1;    ///< per pixel
  int Frames = 1;
  int Rows = 0;
  int Columns = 0;
  int Bits = 0; ///< allocated for each sample
  bool HasSpacing = false;
  std::string ImagerSpacing; ///< of the detector, between rows and between columns
  bool HasPosition = false;    ///< of its first pixel
  bool HasOrientation = false; ///< of its rows and columns
  bool HasPixels = false;
  std::uint64_t PixelBytes = 0; ///< in the file, as far as the element says they go

  /** Bytes of pixels that the sizes ask for. */
  std::uint64_t NeededBytes() const;

  /** A directory of files, a report or another object that has no pixels by its nature. */
  bool IsOtherThanImage() const;
};

/**
 * Walk through the elements of a DICOM file (PS3.5, sections 7.1 and A.4).
 * @throws Failure, without the name, if they do not fit together or the encoding is compressed.
 */
DicomHeader ReadDicomHeader(const std::string& file);
}

#endif
