// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicDicomFiles_h
#define volumicDicomFiles_h

#include "LabelNames.h"
#include "VolumeImage.h"

#include <vtkSmartPointer.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

class vtkDataArray;

namespace tool
{
/** A slice: a DICOM file, or one frame of one. What the file lacks is missing. */
struct DicomSlice
{
  std::string File;
  std::size_t Frame = 0;
  std::array<int, 2> Size = { 0, 0 };           ///< columns and rows
  std::optional<Vector3> Position;              ///< of the first pixel: patient coordinates, mm
  std::optional<std::array<Vector3, 2>> Axes;   ///< along its rows, and from row to row
  std::optional<std::array<double, 2>> Spacing; ///< along these
  std::optional<std::array<double, 2>> ImagerSpacing; ///< of the detector
  double Thickness = 0.0;                             ///< 0: not told
  double Slope = 1.0;
  double Shift = 0.0;
  std::optional<double> Padding; ///< the value of pixels that are none, as it is in the file
  std::array<double, 4> Time = { 0, 0, 0, 0 }; ///< orders slices of one place
  bool IsGuessed = false;                      ///< its place: that of its number among the frames
  int Segment = 0;                             ///< that a frame of a segmentation is of
};

struct DicomSeries
{
  std::string Identifier;
  std::string Description;
  std::string Date;
  std::string Modality;
  std::vector<DicomSlice> Slices; ///< in the order of the files
  LabelNames Segments;            ///< of a segmentation

  /** Number, what it is and how large, in one line. */
  std::string Text(std::size_t number) const;
};

/**
 * The series that the files are of, in the order of their first files. Directories, reports and the
 * like are passed over.
 * @throws Failure that names the file if it is damaged
 */
std::vector<DicomSeries> DicomSeriesOf(const std::vector<std::string>& files);

/** @throws Failure, without the name, unless all elements fit into each other and the file. */
void CheckDicom(const std::string& file);

/** The pixels of slices, unpacked, as they are in the files. */
class DicomPixels
{
public:
  /**
   * Those of a slice; a new array, or one that is valid until the next call.
   * @throws Failure that names the file if they are cut off, damaged or not numbers
   */
  vtkSmartPointer<vtkDataArray> Read(const DicomSlice& slice);

private:
  void Load(const DicomSlice& slice);

  std::string File; ///< that was read last
  std::vector<char> Bytes;
  int Type = 0;
  bool AreBits = false;
};
}

#endif
