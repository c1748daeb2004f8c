// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/ImageVoxels.h"

#include "Core/Common/ThrowInvalidArgument.h"
#include "Host/LargeArrays.h"

#include <vtkAbstractArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace volumic
{
namespace
{
std::string Quote(const char* name)
{
  return name ? "'" + std::string(name) + "'" : std::string("without a name");
}

/** Return `its point arrays are 'a', 'b'`. */
std::string ArraysOf(vtkImageData* image)
{
  std::string text;
  vtkPointData* points = image->GetPointData();
  vtkCellData* cells = image->GetCellData();
  if (points->GetNumberOfArrays() == 0)
  {
    text = "it has no point data";
  }
  for (int i = 0; i < points->GetNumberOfArrays(); ++i)
  {
    text += (i == 0 ? "its point arrays are " : ", ") + Quote(points->GetArrayName(i));
  }
  if (cells->GetNumberOfArrays() > 0)
  {
    text += "; it also has cell data, which Cell Data to Point Data converts";
  }
  return text;
}

/** Return valueOf(tuple) for each tuple. A tuple is a pointer to its first component. */
template <typename Array, typename ValueOf>
vtkSmartPointer<vtkDataArray> Compute(
  vtkDataArray* tuples, Executor& threads, const ValueOf& valueOf)
{
  constexpr std::size_t grain = 1 << 16;
  const auto count = static_cast<std::size_t>(tuples->GetNumberOfTuples());
  const int components = tuples->GetNumberOfComponents();
  const auto computed = NewLargeArray<Array>(count);
  computed->SetName(tuples->GetName());
  auto* to = computed->GetPointer(0);
  VisitVoxels(tuples,
    [&](const auto* from)
    {
      threads.For(count, grain,
        [&](std::size_t begin, std::size_t end)
        {
          for (std::size_t i = begin; i < end; ++i)
          {
            to[i] = static_cast<typename Array::ValueType>(valueOf(from + i * components));
          }
        });
    });
  return computed;
}

/** Compute floats, or doubles if the type of the tuples has more digits than float. */
template <typename ValueOf>
vtkSmartPointer<vtkDataArray> ComputeReal(
  vtkDataArray* tuples, Executor& threads, const ValueOf& valueOf)
{
  return tuples->GetDataType() == VTK_FLOAT || tuples->GetDataTypeSize() < 4
    ? Compute<vtkFloatArray>(tuples, threads, valueOf)
    : Compute<vtkDoubleArray>(tuples, threads, valueOf);
}
}

std::string ChosenName(vtkInformation* selection)
{
  // A ParaView script that has not read the data selects an array without a name.
  const char* name = selection->Get(vtkDataObject::FIELD_NAME());
  return name ? name : "";
}

bool FitsFloat(double smallest, double largest)
{
  const double size = std::max(std::abs(smallest), std::abs(largest));
  return largest == smallest ||
    size * 0.5 * std::numeric_limits<float>::epsilon() <= 1e-5 * (largest - smallest);
}

std::string NameOf(vtkDataArray* array)
{
  return "array " + Quote(array->GetName());
}

Point FirstVoxelOf(vtkImageData* image)
{
  Point first;
  const int* extent = image->GetExtent();
  image->TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4], first.data());
  return first;
}

std::string SizeOf(vtkImageData* image)
{
  const int* size = image->GetDimensions();
  return Join(size[0], " x ", size[1], " x ", size[2]);
}

vtkDataArray* ChooseArray(vtkInformation* selection, vtkImageData* image)
{
  if (image->GetNumberOfPoints() == 0)
  {
    ThrowInvalidArgument(
      "the image is empty: it has " + SizeOf(image) + " voxels. Load an image with voxels.");
  }
  // Keys that are not set are 0: points and scalars.
  const std::string name = ChosenName(selection);
  const int association = selection->Get(vtkDataObject::FIELD_ASSOCIATION());
  if (association == vtkDataObject::FIELD_ASSOCIATION_CELLS ||
    association == vtkDataObject::FIELD_ASSOCIATION_NONE)
  {
    ThrowInvalidArgument("the chosen array ", name.empty() ? name : Quote(name.c_str()) + " ",
      "is not point data. Apply Cell Data to Point Data, or choose a point array: ",
      ArraysOf(image), ".");
  }
  vtkAbstractArray* found = name.empty() ? image->GetPointData()->GetAbstractAttribute(
                                             selection->Get(vtkDataObject::FIELD_ATTRIBUTE_TYPE()))
                                         : image->GetPointData()->GetAbstractArray(name.c_str());
  if (!found && name.empty())
  {
    ThrowInvalidArgument("the image has no active point scalars; ", ArraysOf(image),
      ". Choose one as Voxels (SetInputArrayToProcess).");
  }
  if (!found)
  {
    ThrowInvalidArgument("the image has no point array ", Quote(name.c_str()),
      ". Choose another array: ", ArraysOf(image), ".");
  }
  auto* array = vtkDataArray::SafeDownCast(found);
  if (!array)
  {
    ThrowInvalidArgument("array " + Quote(found->GetName()) + " has the type " +
      found->GetDataTypeAsString() + ". Choose a numeric array: " + ArraysOf(image) + ".");
  }
  if (array->GetNumberOfTuples() != image->GetNumberOfPoints())
  {
    ThrowInvalidArgument(NameOf(array) + " has " + std::to_string(array->GetNumberOfTuples()) +
      " values, but the image has " + SizeOf(image) + " voxels. Provide a value for each voxel.");
  }
  return array;
}

vtkDataArray* ChooseVoxels(vtkInformation* selection, vtkImageData* image)
{
  vtkDataArray* array = ChooseArray(selection, image);
  if (array->GetNumberOfComponents() != 1)
  {
    ThrowInvalidArgument(NameOf(array), " has ", array->GetNumberOfComponents(),
      " components; levels of a pyramid and edge maps must have one. Compute the levels by Image "
      "Pyramid, which selects a component or the magnitude (Selected Component).");
  }
  return array;
}

vtkSmartPointer<vtkDataArray> SelectComponent(vtkDataArray* array, int component)
{
  const int count = array->GetNumberOfComponents();
  if (count < 1 || component < -1 || component >= count)
  {
    ThrowInvalidArgument("Selected Component is ", component, ", but ", NameOf(array), " has ",
      count, " component", count == 1 ? "" : "s",
      count > 1 ? Join(". Set it to 0 to ", count - 1, ", or to -1 for the magnitude.")
                : std::string(". Set it to 0 or -1."));
  }
  if (count == 1)
  {
    return array;
  }
  const vtkSmartPointer<vtkDataArray> tuples = ContiguousVoxels(array);
  if (component >= 0)
  {
    vtkSmartPointer<vtkDataArray> selected;
    selected.TakeReference(tuples->NewInstance());
    selected->SetName(array->GetName());
    selected->SetNumberOfTuples(tuples->GetNumberOfTuples());
    selected->CopyComponent(0, tuples, component);
    return selected;
  }
  return ComputeReal(tuples, OnThisThread(),
    [count](const auto* tuple)
    {
      double sum = 0.0;
      for (int c = 0; c < count; ++c)
      {
        const auto value = static_cast<double>(tuple[c]);
        sum += value * value;
      }
      return std::sqrt(sum);
    });
}

vtkSmartPointer<vtkImageData> WithVoxels(vtkImageData* image, vtkDataArray* voxels)
{
  vtkSmartPointer<vtkImageData> with;
  with.TakeReference(image->NewInstance());
  with->ShallowCopy(image);
  vtkPointData* arrays = with->GetPointData();
  arrays->SetActiveAttribute(
    voxels->GetName() ? arrays->AddArray(voxels) : arrays->SetScalars(voxels),
    vtkDataSetAttributes::SCALARS);
  return with;
}

vtkSmartPointer<vtkDataArray> ContiguousVoxels(vtkDataArray* voxels)
{
  const bool isPacked = voxels->GetDataType() == VTK_BIT;
  if (voxels->HasStandardMemoryLayout() && !isPacked)
  {
    return voxels;
  }
  vtkSmartPointer<vtkDataArray> copy;
  copy.TakeReference(
    isPacked ? vtkUnsignedCharArray::New() : vtkDataArray::CreateDataArray(voxels->GetDataType()));
  copy->DeepCopy(voxels);
  copy->SetName(voxels->GetName());
  return copy;
}

void ValueRange::Check() const
{
  if (!this->IsUsed())
  {
    return;
  }
  if (!std::isfinite(this->Lower))
  {
    ThrowInvalidArgument("Upper Value is ", this->Upper, ", but Iso Value is ",
      std::isnan(this->Lower) ? std::string("not set") : Join(this->Lower),
      ". Set Iso Value to the smallest value of the object. For an object below one value, set Iso "
      "Value to this value, remove Upper Value, and switch Object Is Bright off.");
  }
  if (!(this->Lower < this->Upper))
  {
    ThrowInvalidArgument("Upper Value is ", this->Upper, ", but Iso Value is ", this->Lower,
      ". Set Upper Value to more than Iso Value: the object has the values between the two.");
  }
}

vtkSmartPointer<vtkDataArray> FoldVoxels(
  vtkDataArray* voxels, const ValueRange& range, Executor& threads)
{
  const double sum = range.Lower + range.Upper;
  return ComputeReal(voxels, threads,
    [sum](const auto* voxel)
    {
      const auto value = static_cast<double>(*voxel);
      // In this order NaN stays NaN, and an infinite voxel stays infinite.
      return std::min(value, sum - value);
    });
}
}
