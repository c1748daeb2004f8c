// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSlabReader_h
#define volumicSlabReader_h

#include "VolumeImage.h"

#include <vtkSmartPointer.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataArray;

namespace tool
{
/** A volume that is read some slices at a time. All that it does may throw a Failure. */
class SlabReader
{
public:
  virtual ~SlabReader() = default;

  std::array<int, 3> Size = { 0, 0, 0 };
  int Type = 0; ///< of the values, as VTK numbers types
  int Components = 1;
  VolumePlacement Placement;
  std::string WorldAxes; ///< as SetWorldAxes takes them; may be empty
  std::string ArrayName; ///< of the values; empty: as Read() gives it

  /** The values of so many slices; a new array, or one that is valid until the next call. */
  virtual vtkSmartPointer<vtkDataArray> Read(int first, int count) = 0;
};

/**
 * A source of a pipeline that makes the slices that it is asked for. What the reader throws is an
 * error of its, with that text.
 */
vtkSmartPointer<vtkAlgorithm> NewSlabSource(std::unique_ptr<SlabReader> reader);

/** Where packed data are unpacked to: the option --scratch. */
using ScratchDirectory = std::string;

// The formats. Null where a file is of a kind that can only be read as a whole.

std::unique_ptr<SlabReader> OpenMeta(const std::string& name, const ScratchDirectory& scratch);
std::unique_ptr<SlabReader> OpenMrc(const std::string& name);
std::unique_ptr<SlabReader> OpenNrrd(const std::string& name, const ScratchDirectory& scratch);
std::unique_ptr<SlabReader> OpenNifti(const std::string& name, const ScratchDirectory& scratch);
std::unique_ptr<SlabReader> OpenDicom(const std::vector<std::string>& files);
std::unique_ptr<SlabReader> OpenPictures(const std::vector<std::string>& files);
/** One file of several pages. */
std::unique_ptr<SlabReader> OpenTiff(const std::string& name);
}

#endif
