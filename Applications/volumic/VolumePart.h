// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVolumePart_h
#define volumicVolumePart_h

#include "VolumeImage.h"

#include <vtkImageAlgorithm.h>
#include <vtkSmartPointer.h>

#include <array>
#include <limits>
#include <string>

class vtkDataArray;
class vtkImageData;
class vtkInformation;

namespace tool
{
class Ranks;

/** What a volume is, without its voxels. */
struct VolumeFacts
{
  std::array<int, 6> Extent = { 0, -1, 0, -1, 0, -1 };
  Vector3 Spacing = { 1.0, 1.0, 1.0 };
  Vector3 Origin = { 0.0, 0.0, 0.0 };
  std::array<double, 9> Direction = { 1, 0, 0, 0, 1, 0, 0, 0, 1 }; ///< row by row
  int Type = 0; ///< of the voxels, as VTK numbers types; 0: not known
  int Components = 1;
  /** Of the selected component: the smallest and the largest. */
  std::array<double, 2> Range = { std::numeric_limits<double>::infinity(),
    -std::numeric_limits<double>::infinity() };

  std::array<int, 3> Size() const;
};

/** Of an image that is there, and these of its arrays. */
VolumeFacts FactsOf(vtkImageData* image, vtkDataArray* scalars, int component);

/** What a source tells of its voxels, empty: of its active scalars; null: nothing. */
vtkInformation* VoxelsIn(vtkInformation* info, const std::string& array);

/** How many components that says; 1: nothing. */
int ComponentsIn(vtkInformation* voxels);

/**
 * The volume as the ranks' filters ask for it, the part of each. Where its reader cannot read
 * parts, the first rank has it all and the others nothing, as VTK's own readers do it then; the filters
 * send each other what they need.
 *
 * A part that cannot be read is no error of this source, which would keep its rank from the filter
 * that the other ranks are in already: it is empty, and FailureOfReading() tells why.
 */
class VolumePart : public vtkImageAlgorithm
{
public:
  static VolumePart* New();
  vtkTypeMacro(VolumePart, vtkImageAlgorithm);

  /**
   * Parts of what a reader reads.
   * @param array   that is wanted; empty: as ChooseScalars has it
   * @param spacing instead of the reader's; null: the reader's
   * @return whether the reader tells enough of it before it reads
   */
  bool SetReader(vtkAlgorithm* reader, const std::string& name, const std::string& array,
    const double* spacing);

  /** All of it at the first rank; elsewhere `image` is null. Called by all ranks. */
  void SetWhole(const Ranks& ranks, vtkImageData* image);

  /** The range is that of what this rank has read so far; without any the first is larger. */
  const VolumeFacts& Facts() const { return this->Known; }

  /** With the range of all ranks, which call this. */
  VolumeFacts FactsOfAll(const Ranks& ranks) const;

  /** Whether each rank reads its part. */
  bool IsInParts() const { return this->Reader != nullptr; }

  /** The component to take the range of; -1: of the magnitude. */
  void SetComponent(int component) { this->Component = component; }

  /** Empty: none. */
  const std::string& FailureOfReading() const { return this->Failure; }

protected:
  VolumePart() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override;

private:
  /**
   * Whether to read it whole and cut the part out, as a small `.vti`: VTK's reader reads parts slice by
   * slice, and unpacks the block that a slice is in each time anew.
   */
  bool IsReadWhole() const;
  void Read(const int* extent, vtkImageData* image);
  void MakeEmpty(vtkImageData* image) const;

  vtkSmartPointer<vtkAlgorithm> Reader; ///< null: the volume is whole
  vtkSmartPointer<vtkImageData> Whole;  ///< of the first rank
  VolumeFacts Known;
  std::string Name;
  std::string Array; ///< of the voxels; empty: not known
  bool HasSpacing = false;
  int Component = -1;
  std::string Failure;
};
}

#endif
