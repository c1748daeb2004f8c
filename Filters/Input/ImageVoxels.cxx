// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/ImageVoxels.h"

#include "Core/Common/Refuse.h"
#include "Host/LargeArrays.h"

#include <vtkAbstractArray.h>
#include <vtkAlgorithm.h>
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
#include <stdexcept>
#include <type_traits>

namespace volumic
{
namespace
{
std::string Quote(const char* name)
{
  return name ? "'" + std::string(name) + "'" : std::string("without a name");
}

/** `it has 'a' and 'b'`, so that a user sees what could have been chosen. */
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
    text += "; it has cell data, which the filter Cell Data to Point Data turns into point data";
  }
  return text;
}

/**
 * The array that the selection names, whatever its type; the reason in a message if there is none.
 */
vtkAbstractArray* FindArray(vtkInformation* selection, vtkImageData* image)
{
  if (selection && selection->Has(vtkDataObject::FIELD_ASSOCIATION()))
  {
    const int association = selection->Get(vtkDataObject::FIELD_ASSOCIATION());
    if (association == vtkDataObject::FIELD_ASSOCIATION_CELLS ||
      association == vtkDataObject::FIELD_ASSOCIATION_NONE)
    {
      const char* name = selection->Get(vtkDataObject::FIELD_NAME());
      Refuse("the chosen array " + (name ? Quote(name) + " " : std::string()) +
        "is not point data; voxels are points. Apply Cell Data to Point Data, or choose a point " +
        "array: " + ArraysOf(image) + ".");
    }
  }
  const std::string name = ChosenName(selection);
  if (!name.empty())
  {
    vtkAbstractArray* array = image->GetPointData()->GetAbstractArray(name.c_str());
    if (!array)
    {
      Refuse("the image has no point array " + Quote(name.c_str()) + "; " + ArraysOf(image) + ".");
    }
    return array;
  }
  const int attribute = selection && selection->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE())
    ? selection->Get(vtkDataObject::FIELD_ATTRIBUTE_TYPE())
    : static_cast<int>(vtkDataSetAttributes::SCALARS);
  vtkAbstractArray* array = image->GetPointData()->GetAbstractAttribute(attribute);
  if (!array)
  {
    Refuse("the image has no active point scalars; " + ArraysOf(image) +
      ". Choose one as Voxels (SetInputArrayToProcess).");
  }
  return array;
}

template <typename T>
void CopyComponent(const T* values, int stride, vtkIdType count, T* selected)
{
  for (vtkIdType i = 0; i < count; ++i)
  {
    selected[i] = values[i * stride];
  }
}

template <typename T, typename Real>
void ComputeMagnitude(const T* values, int components, vtkIdType count, Real* magnitudes)
{
  for (vtkIdType i = 0; i < count; ++i)
  {
    double sum = 0.0;
    for (int c = 0; c < components; ++c)
    {
      const auto value = static_cast<double>(values[i * components + c]);
      sum += value * value;
    }
    magnitudes[i] = static_cast<Real>(std::sqrt(sum));
  }
}
}

std::string ChosenName(vtkInformation* selection)
{
  // A ParaView script that never saw the data chooses the array without a name.
  const char* name = selection && selection->Has(vtkDataObject::FIELD_NAME())
    ? selection->Get(vtkDataObject::FIELD_NAME())
    : nullptr;
  return name ? name : "";
}

bool FloatHolds(double smallest, double largest)
{
  const double size = std::max(std::abs(smallest), std::abs(largest));
  constexpr double rounding = 0.5 * std::numeric_limits<float>::epsilon();
  return largest == smallest || size * rounding <= 1e-5 * (largest - smallest);
}

std::string NameOf(vtkDataArray* array)
{
  return "array " + Quote(array->GetName());
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
    Refuse("the image is empty: it has " + SizeOf(image) + " voxels.");
  }
  vtkAbstractArray* found = FindArray(selection, image);
  auto* array = vtkDataArray::SafeDownCast(found);
  if (!array)
  {
    Refuse("array " + Quote(found->GetName()) + " holds " + found->GetDataTypeAsString() +
      "s, not numbers; choose another one: " + ArraysOf(image) + ".");
  }
  if (array->GetNumberOfTuples() != image->GetNumberOfPoints())
  {
    Refuse(NameOf(array) + " has " + std::to_string(array->GetNumberOfTuples()) +
      " values, but the image has " + SizeOf(image) + " voxels.");
  }
  return array;
}

vtkDataArray* ChooseVoxels(vtkInformation* selection, vtkImageData* image)
{
  vtkDataArray* array = ChooseArray(selection, image);
  if (array->GetNumberOfComponents() != 1)
  {
    Refuse(NameOf(array), " has ", array->GetNumberOfComponents(),
      " components; levels of a pyramid and maps of edges have one. Image Pyramid makes the levels "
      "of one component or of the magnitude (Selected Component).");
  }
  return array;
}

vtkSmartPointer<vtkDataArray> SelectComponent(vtkDataArray* array, int component)
{
  const int count = array->GetNumberOfComponents();
  if (count < 1 || component < -1 || component >= count)
  {
    Refuse("Selected Component is ", component, ", but ", NameOf(array), " has ", count,
      " component", count == 1 ? "" : "s",
      count > 1 ? Join("; it must be 0 to ", count - 1, ", or -1 for the magnitude.")
                : std::string("; it must be 0, or -1."));
  }
  if (count == 1)
  {
    return array;
  }
  const vtkSmartPointer<vtkDataArray> tuples = ContiguousVoxels(array);
  const int type = tuples->GetDataType();
  const bool isSmall = type == VTK_FLOAT || tuples->GetDataTypeSize() < 4;
  vtkSmartPointer<vtkDataArray> selected;
  selected.TakeReference(
    vtkDataArray::CreateDataArray(component >= 0 ? type : (isSmall ? VTK_FLOAT : VTK_DOUBLE)));
  selected->SetName(array->GetName());
  selected->SetNumberOfTuples(array->GetNumberOfTuples());
  VisitVoxels(tuples,
    [&](const auto* values)
    {
      using Voxel = std::remove_cv_t<std::remove_pointer_t<decltype(values)>>;
      if (component >= 0)
      {
        CopyComponent(values + component, count, selected->GetNumberOfTuples(),
          static_cast<Voxel*>(selected->GetVoidPointer(0)));
      }
      else if (isSmall)
      {
        ComputeMagnitude(values, count, selected->GetNumberOfTuples(),
          static_cast<float*>(selected->GetVoidPointer(0)));
      }
      else
      {
        ComputeMagnitude(values, count, selected->GetNumberOfTuples(),
          static_cast<double*>(selected->GetVoidPointer(0)));
      }
    });
  return selected;
}

vtkSmartPointer<vtkImageData> WithVoxels(vtkImageData* image, vtkDataArray* voxels)
{
  vtkSmartPointer<vtkImageData> with;
  with.TakeReference(image->NewInstance());
  with->ShallowCopy(image);
  const char* name = voxels->GetName();
  if (!name)
  {
    with->GetPointData()->SetScalars(voxels);
    return with;
  }
  if (with->GetPointData()->GetArray(name) != voxels)
  {
    with->GetPointData()->AddArray(voxels);
  }
  with->GetPointData()->SetActiveScalars(name);
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
  return copy;
}

namespace
{
/** Voxels under which a thread is not worth it. */
constexpr std::size_t FoldGrain = 1 << 16;

template <typename Array, typename T>
vtkSmartPointer<vtkDataArray> Fold(
  const T* voxels, std::size_t count, const ValueRange& range, Executor& threads)
{
  const auto folded = NewLargeArray<Array>(count);
  auto* to = folded->GetPointer(0);
  const double sum = range.Lower + range.Upper;
  threads.For(count, FoldGrain,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const auto value = static_cast<double>(voxels[i]);
        // In this order NaN stays NaN, and an infinite voxel infinite.
        to[i] = static_cast<typename Array::ValueType>(std::min(value, sum - value));
      }
    });
  return folded;
}
}

void ValueRange::Check() const
{
  if (!this->IsUsed())
  {
    return;
  }
  if (!std::isfinite(this->Upper))
  {
    Refuse("Upper Value is ", this->Upper,
      "; it must be a number above Iso Value, or infinite, where the object has all values above "
      "that.");
  }
  if (!std::isfinite(this->Lower))
  {
    Refuse("Upper Value is ", this->Upper, ", but Iso Value is ",
      std::isnan(this->Lower) ? std::string("not set") : Join(this->Lower),
      "; set it to the least value of the object. For all that is below a value set Iso Value to "
      "that and switch Object Is Bright off.");
  }
  if (!(this->Lower < this->Upper))
  {
    Refuse("Upper Value is ", this->Upper, ", but Iso Value is ", this->Lower,
      "; it must be more: the object has the values between the two.");
  }
}

vtkSmartPointer<vtkDataArray> FoldVoxels(
  vtkDataArray* voxels, const ValueRange& range, Executor& threads)
{
  const auto count = static_cast<std::size_t>(voxels->GetNumberOfTuples());
  const bool isSmall = voxels->GetDataType() == VTK_FLOAT || voxels->GetDataTypeSize() < 4;
  vtkSmartPointer<vtkDataArray> folded;
  VisitVoxels(voxels,
    [&](const auto* values)
    {
      folded = isSmall ? Fold<vtkFloatArray>(values, count, range, threads)
                       : Fold<vtkDoubleArray>(values, count, range, threads);
    });
  folded->SetName(voxels->GetName());
  return folded;
}
}
