// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "VolumeImage.h"

#include "Texts.h"
#include "ToolErrors.h"

#include <vtkByteSwap.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tool
{
namespace
{
/** Headers round their direction cosines to some digits. */
constexpr double DigitsOfHeaders = 1e-3;
}

std::array<double, 2> RangeOf(vtkDataArray* values, int component)
{
  // Nothing is between these where there is no such component.
  std::array<double, 2> range = { 1.0, 0.0 };
  if (component < values->GetNumberOfComponents())
  {
    values->GetRange(range.data(), values->GetNumberOfComponents() == 1 ? 0 : component);
  }
  return range;
}

double Dot(const Vector3& a, const Vector3& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector3 Cross(const Vector3& a, const Vector3& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}

void VolumePlacement::SetSteps(const std::array<Vector3, 3>& steps)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double length = std::sqrt(Dot(steps[axis], steps[axis]));
    this->Spacing[axis] = length;
    for (int c = 0; c < 3; ++c)
    {
      this->Axes[axis][c] = length > 0.0 ? steps[axis][c] / length : 0.0;
    }
  }
}

std::array<double, 12> VolumePlacement::Numbers() const
{
  std::array<double, 12> numbers;
  for (std::size_t i = 0; i < 12; ++i)
  {
    const std::size_t axis = i / 3;
    numbers[i] = axis < 3 ? this->Axes[axis][i % 3] * this->Spacing[axis] : this->Origin[i % 3];
  }
  return numbers;
}

std::string VolumePlacement::Text() const
{
  std::string text = "steps and origin";
  for (const double number : this->Numbers())
  {
    text += " " + NumberText(std::round(1e4 * number) / 1e4);
  }
  return text;
}

bool VolumePlacement::IsLike(const VolumePlacement& other, const int* size) const
{
  const std::array<double, 12> a = this->Numbers();
  const std::array<double, 12> b = other.Numbers();
  const double most = 0.1 * *std::min_element(this->Spacing.begin(), this->Spacing.end());
  for (std::size_t c = 0; c < 3; ++c)
  {
    double apart = std::abs(a[9 + c] - b[9 + c]);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      apart += (size[axis] - 1) * std::abs(a[3 * axis + c] - b[3 * axis + c]);
    }
    if (!(apart < most))
    {
      return false;
    }
  }
  return true;
}

bool VolumePlacement::IsSpace() const
{
  bool isSpace = std::abs(Dot(Cross(this->Axes[0], this->Axes[1]), this->Axes[2])) > 0.1;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    isSpace = isSpace && this->Spacing[axis] > 0.0 && std::isfinite(this->Spacing[axis]) &&
      std::abs(Dot(this->Axes[axis], this->Axes[axis]) - 1.0) < DigitsOfHeaders;
  }
  return isSpace;
}

bool VolumePlacement::HasRightAngles() const
{
  bool areRight = true;
  for (std::size_t a = 0; a < 3; ++a)
  {
    for (std::size_t b = 0; b < 3; ++b)
    {
      const double product = Dot(this->Axes[a], this->Axes[b]);
      areRight = areRight && std::abs(product - (a == b ? 1.0 : 0.0)) < DigitsOfHeaders;
    }
  }
  return areRight;
}

void PlaceImage(vtkImageData* image, const VolumePlacement& placement)
{
  double matrix[9];
  for (int axis = 0; axis < 3; ++axis)
  {
    FailIf(!(placement.Spacing[axis] > 0.0) || !std::isfinite(placement.Spacing[axis]),
      "the distance of the voxels is not positive");
    for (int row = 0; row < 3; ++row)
    {
      matrix[3 * row + axis] = placement.Axes[axis][row];
    }
  }
  FailIf(!placement.HasRightAngles(),
    "the voxel axes are not at right angles: such a sheared or tilted volume must be resampled "
    "first (3D Slicer: Resample Scalar/Vector/DWI Volume)");
  image->SetSpacing(placement.Spacing.data());
  image->SetOrigin(placement.Origin.data());
  image->SetDirectionMatrix(matrix);
}

VolumePlacement PlacementOf(vtkImageData* image)
{
  VolumePlacement placement;
  const double* matrix = image->GetDirectionMatrix()->GetData();
  for (std::size_t i = 0; i < 9; ++i)
  {
    placement.Axes[i % 3][i / 3] = matrix[i];
  }
  std::copy_n(image->GetSpacing(), 3, placement.Spacing.begin());
  std::copy_n(image->GetOrigin(), 3, placement.Origin.begin());
  return placement;
}

void SetWorldAxes(vtkImageData* image, const std::string& axes)
{
  SetFact(image, "Axes", axes);
}

void SetFact(vtkDataObject* data, const std::string& name, const std::string& text)
{
  vtkNew<vtkStringArray> fact;
  fact->SetName(name.c_str());
  fact->InsertNextValue(text);
  data->GetFieldData()->AddArray(fact);
}

std::string GetFact(vtkDataObject* data, const std::string& name)
{
  auto* fact = vtkStringArray::SafeDownCast(data->GetFieldData()->GetAbstractArray(name.c_str()));
  return fact && fact->GetNumberOfValues() > 0 ? fact->GetValue(0) : "";
}

void ToNativeOrder(vtkDataArray* values, bool isBig)
{
  // "BE" is the identity on a big-endian machine, and the other way round.
  const int width = values->GetDataTypeSize();
  void (*swap)(void*, std::size_t) = nullptr;
  swap = width == 2 ? (isBig ? vtkByteSwap::Swap2BERange : vtkByteSwap::Swap2LERange)
    : width == 4    ? (isBig ? vtkByteSwap::Swap4BERange : vtkByteSwap::Swap4LERange)
    : width == 8    ? (isBig ? vtkByteSwap::Swap8BERange : vtkByteSwap::Swap8LERange)
                    : nullptr;
  if (swap)
  {
    swap(values->GetVoidPointer(0), static_cast<std::size_t>(values->GetNumberOfValues()));
  }
}

vtkSmartPointer<vtkDataArray> Rescaled(vtkDataArray* values, double slope, double shift)
{
  auto rescaled = vtkSmartPointer<vtkFloatArray>::New();
  rescaled->SetName(values->GetName());
  rescaled->SetNumberOfComponents(values->GetNumberOfComponents());
  rescaled->SetNumberOfTuples(values->GetNumberOfTuples());
  for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < values->GetNumberOfComponents(); ++c)
    {
      rescaled->SetTypedComponent(
        i, c, static_cast<float>(slope * values->GetComponent(i, c) + shift));
    }
  }
  return rescaled;
}
}
