// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkOtsuThreshold.h"

#include "AlgorithmErrors.h"
#include "CellVoxels.h"
#include "Core/Common/Refuse.h"
#include "HostThreads.h"
#include "ImageVoxels.h"
#include "InputImage.h"
#include "ValidVoxels.h"
#include "WholeInput.h"

#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkImageData.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>
#include <vtkTable.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <exception>
#include <functional>
#include <limits>
#include <mutex>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkOtsuThreshold);

namespace
{
constexpr int Bins = 1024;

using Counts = std::vector<vtkIdType>;

/** How many voxels each bin between the smallest and the largest voxel has. */
template <typename T>
void CountVoxels(const T* voxels, vtkIdType count, const volumic::ValidVoxels& valid,
  const std::array<double, 2>& range, volumic::Executor& threads, Counts& all)
{
  const double scale = Bins / (range[1] - range[0]);
  std::mutex mutex;
  threads.For(static_cast<std::size_t>(count), 1 << 18,
    [&](std::size_t begin, std::size_t end)
    {
      Counts counts(Bins, 0);
      for (std::size_t i = begin; i < end; ++i)
      {
        if (valid.Has(i))
        {
          const double place = (static_cast<double>(voxels[i]) - range[0]) * scale;
          ++counts[std::min(Bins - 1, static_cast<int>(place))];
        }
      }
      const std::lock_guard<std::mutex> lock(mutex);
      std::transform(all.begin(), all.end(), counts.begin(), all.begin(), std::plus<>());
    });
}

/** The bins below the split with the largest variance between the classes. */
int BestSplit(const Counts& counts)
{
  // Bins stand for the values, which follow from them by a scale that changes no maximum.
  double all = 0.0;
  double sum = 0.0;
  for (int bin = 0; bin < Bins; ++bin)
  {
    all += static_cast<double>(counts[bin]);
    sum += static_cast<double>(counts[bin]) * bin;
  }
  std::vector<double> variance(Bins - 1, 0.0);
  double low = 0.0;
  double lowSum = 0.0;
  for (int bin = 0; bin < Bins - 1; ++bin)
  {
    low += static_cast<double>(counts[bin]) / all;
    lowSum += static_cast<double>(counts[bin]) * bin / all;
    const double difference = sum / all * low - lowSum;
    variance[bin] = low > 0.0 && low < 1.0 ? difference * difference / (low * (1.0 - low)) : 0.0;
  }
  const double best = *std::max_element(variance.begin(), variance.end()) * (1.0 - 1e-12);
  std::vector<int> splits;
  for (int bin = 0; bin < Bins - 1; ++bin)
  {
    if (variance[bin] >= best)
    {
      splits.push_back(bin + 1);
    }
  }
  return splits[splits.size() / 2];
}

/** The largest voxel up to a value, and the smallest one above that. */
template <typename T>
void FindNeighbours(const T* voxels, vtkIdType count, const volumic::ValidVoxels& valid,
  double value, double neighbours[2])
{
  T below = std::numeric_limits<T>::lowest();
  T above = std::numeric_limits<T>::max();
  for (vtkIdType i = 0; i < count; ++i)
  {
    const T voxel = voxels[i];
    if (!valid.Has(i))
    {
      continue;
    }
    if (static_cast<double>(voxel) <= value)
    {
      below = std::max(below, voxel);
    }
    else
    {
      above = std::min(above, voxel);
    }
  }
  neighbours[0] = static_cast<double>(below);
  neighbours[1] = static_cast<double>(above);
}

double OtsuThreshold(vtkImageData* image, vtkInformation* selection, int component)
{
  const vtkSmartPointer<vtkDataArray> chosen =
    volumic::SelectComponent(volumic::ChooseArray(selection, image), component);
  const vtkSmartPointer<vtkDataArray> voxels = volumic::ContiguousVoxels(chosen);
  volumic::HostThreads threads(0);
  const volumic::ValidVoxels valid =
    volumic::FindValidVoxels(chosen, voxels, image, true, threads);
  volumic::CheckAnyIsValid(chosen, valid);
  const std::array<double, 2> range = volumic::RangeOf(voxels, valid);
  const double size = range[1] - range[0];
  if (!(size > 0.0) || !std::isfinite(size))
  {
    volumic::Refuse(volumic::NameOf(chosen), " ranges from ", range[0], " to ", range[1],
      ": no value separates its voxels.");
  }
  Counts counts(Bins, 0);
  switch (voxels->GetDataType())
  {
    vtkTemplateMacro(threads.Run(
      [&]
      {
        CountVoxels(static_cast<const VTK_TT*>(voxels->GetVoidPointer(0)),
          voxels->GetNumberOfTuples(), valid, range, threads, counts);
      }));
  }
  const double value = range[0] + BestSplit(counts) * size / Bins;
  double neighbours[2] = { range[0], range[1] };
  switch (voxels->GetDataType())
  {
    vtkTemplateMacro(FindNeighbours(static_cast<const VTK_TT*>(voxels->GetVoidPointer(0)),
      voxels->GetNumberOfTuples(), valid, value, neighbours));
  }
  const double middle = 0.5 * (neighbours[0] + neighbours[1]);
  const bool areReal = voxels->GetDataType() == VTK_FLOAT || voxels->GetDataType() == VTK_DOUBLE;
  return areReal ? middle : std::floor(middle) + 0.5;
}
}

//------------------------------------------------------------------------------
vtkOtsuThreshold::vtkOtsuThreshold() : SelectedComponent(-1), Threshold(vtkMath::Nan())
{
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
}

vtkOtsuThreshold::~vtkOtsuThreshold() = default;

//------------------------------------------------------------------------------
int vtkOtsuThreshold::FillInputPortInformation(int, vtkInformation* info)
{
  // Whatever it is: VTK's pipeline would run once per leaf of a composite dataset.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

//------------------------------------------------------------------------------
int vtkOtsuThreshold::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  volumic::AskForWholeInputs(request, input, 1, output);
  return 1;
}

//------------------------------------------------------------------------------
int vtkOtsuThreshold::RequestData(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  this->Threshold = vtkMath::Nan();
  this->SetErrorCode(vtkErrorCode::NoError);
  if (!volumic::IsFirstProcess(request, output))
  {
    return 1;
  }
  try
  {
    const volumic::PointVoxels voxels = volumic::TakeCellsAsPoints(
      volumic::ImageOf(vtkDataObject::GetData(input[0])), this->GetInputArrayInformation(0));
    this->Threshold = OtsuThreshold(voxels.Image, voxels.Selection, this->SelectedComponent);
    vtkNew<vtkDoubleArray> column;
    column->SetName("Threshold");
    column->InsertNextValue(this->Threshold);
    vtkTable::GetData(output)->AddColumn(column);
  }
  catch (const std::exception& error)
  {
    volumic::InitializeOutputs(output);
    this->SetErrorCode(volumic::ErrorCodeOf(error));
    vtkErrorMacro("Input port 0: " << error.what());
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkOtsuThreshold::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "SelectedComponent: " << this->SelectedComponent << endl;
  os << indent << "Threshold: " << this->Threshold << endl;
}
