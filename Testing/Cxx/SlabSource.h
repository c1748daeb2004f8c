// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSlabSource_h
#define volumicSlabSource_h

#include "FilterTestTools.h"

#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkFloatArray.h>
#include <vtkImageAlgorithm.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnsignedCharArray.h>

namespace volumic
{
inline constexpr std::array<int, 6> Whole = { -20, 123, 7, 150, 3, 130 };
inline constexpr double Spacing[3] = { 0.5, 0.5, 0.75 };
inline constexpr double Origin[3] = { 10.0, -5.0, 2.0 };
inline constexpr double Direction[9] = { 0, 1, 0, -1, 0, 0, 0, 0, 1 };
/** MiB: slabs have a sixty-fourth of it. */
inline constexpr int Limit = 720;
/** Floats of a voxel: so many that there are several slabs. */
inline constexpr int Components = 4;

/** What the source makes beside the voxels. */
struct SlabScene
{
  bool HasNaNs = false;
  bool AreCells = false;   ///< The voxels are cells, not points.
  bool HasGhosts = false;  ///< Some points and some cells are hidden.
  bool IsNamed = true;
  bool HasOther = true;    ///< Another array.
  bool GivesParts = true;
  int FailingSlab = -1;    ///< counted from 0
  int WrongSlab = -1;      ///< of another type
};

/** A ball in an image that is turned, shifted and does not begin at 0, with other arrays. */
class BallSource : public vtkImageAlgorithm
{
public:
  static BallSource* New();
  vtkTypeMacro(BallSource, vtkImageAlgorithm);

  SlabScene Made;
  std::vector<std::array<int, 2>> Slices; ///< that were asked for

protected:
  BallSource() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override
  {
    vtkInformation* info = output->GetInformationObject(0);
    info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), Whole.data(), 6);
    vtkDataObject::SetPointDataActiveScalarInfo(info, VTK_FLOAT, Components);
    info->Set(vtkDataObject::SPACING(), Spacing, 3);
    info->Set(vtkDataObject::ORIGIN(), Origin, 3);
    info->Set(vtkDataObject::DIRECTION(), Direction, 9);
    if (this->Made.GivesParts)
    {
      info->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
    }
    return 1;
  }

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override
  {
    std::array<int, 6> extent = Whole;
    if (this->Made.GivesParts)
    {
      output->GetInformationObject(0)->Get(
        vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), extent.data());
    }
    const int number = static_cast<int>(this->Slices.size());
    this->Slices.push_back({ extent[4], extent[5] });
    if (number == this->Made.FailingSlab)
    {
      vtkErrorMacro("the disk has gone.");
      return 0;
    }
    this->Fill(vtkImageData::GetData(output), extent, number == this->Made.WrongSlab);
    return 1;
  }

private:
  void Fill(vtkImageData* image, const std::array<int, 6>& extent, bool isWrong);
};

vtkStandardNewMacro(BallSource);

inline double ValueAt(int i, int j, int k)
{
  const double x = i - 50.3;
  const double y = j - 70.1;
  const double z = k - 60.7;
  return 100.0 - std::sqrt(x * x + y * y + z * z) + 3.0 * std::sin(0.7 * i + 1.3 * j * k);
}

inline void BallSource::Fill(vtkImageData* image, const std::array<int, 6>& extent, bool isWrong)
{
  image->SetExtent(extent[0], extent[1], extent[2], extent[3], extent[4], extent[5]);
  image->SetSpacing(Spacing);
  image->SetOrigin(Origin);
  image->SetDirectionMatrix(Direction);
  const int isCell = this->Made.AreCells ? 1 : 0;
  const auto voxels = vtk::TakeSmartPointer(
    isWrong ? static_cast<vtkDataArray*>(vtkUnsignedCharArray::New()) : vtkFloatArray::New());
  vtkNew<vtkFloatArray> other;
  voxels->SetName(this->Made.IsNamed ? "Ball" : nullptr);
  voxels->SetNumberOfComponents(Components);
  other->SetName("Other");
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  const int hidden = isCell ? static_cast<int>(vtkDataSetAttributes::HIDDENCELL)
                            : static_cast<int>(vtkDataSetAttributes::HIDDENPOINT);
  ForBox({ extent[0], extent[2], extent[4] },
    { extent[1] + 1 - isCell, extent[3] + 1 - isCell, extent[5] + 1 - isCell },
    [&](int i, int j, int k)
    {
      const double value = ValueAt(i, j, k);
      const bool isNaN = this->Made.HasNaNs && (i + 2 * j + 3 * k) % 97 == 0;
      voxels->InsertNextTuple4(1.0, 2.0,
        isNaN ? std::numeric_limits<float>::quiet_NaN() : value, value * 0.5);
      other->InsertNextValue(static_cast<float>(i + j + k));
      ghosts->InsertNextValue(static_cast<unsigned char>((i * j + k) % 31 == 0 ? hidden : 0));
    });
  vtkDataSetAttributes* attributes = image->GetPointData();
  attributes = isCell ? static_cast<vtkDataSetAttributes*>(image->GetCellData()) : attributes;
  if (this->Made.HasOther)
  {
    attributes->AddArray(other);
  }
  attributes->SetScalars(voxels);
  if (this->Made.HasGhosts)
  {
    attributes->AddArray(ghosts);
    vtkNew<vtkUnsignedCharArray> cells; // in which some lie between slabs, whatever their size
    cells->SetName(vtkDataSetAttributes::GhostArrayName());
    for (int k = extent[4]; k < extent[5] && !isCell; ++k)
    {
      for (int c = 0; c < (extent[1] - extent[0]) * (extent[3] - extent[2]); ++c)
      {
        cells->InsertNextValue(c % 900 < 300 ? vtkDataSetAttributes::HIDDENCELL : 0);
      }
    }
    image->GetCellData()->AddArray(isCell ? ghosts : cells);
  }
}

inline vtkSmartPointer<BallSource> SourceOf(const SlabScene& scene)
{
  auto source = vtkSmartPointer<BallSource>::New();
  source->Made = scene;
  return source;
}
}

#endif
