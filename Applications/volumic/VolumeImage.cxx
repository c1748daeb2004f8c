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
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tool
{
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

bool VolumePlacement::IsLike(const VolumePlacement& other) const
{
  const std::array<double, 12> numbers = this->Numbers();
  const double most = 0.01 * *std::min_element(this->Spacing.begin(), this->Spacing.end());
  return std::equal(numbers.begin(), numbers.end(), other.Numbers().begin(),
    [most](double x, double y) { return std::abs(x - y) < most; });
}

void PlaceImage(vtkImageData* image, const VolumePlacement& placement)
{
  // Headers round their direction cosines to some digits.
  const double tolerance = 1e-3;
  double matrix[9];
  for (int a = 0; a < 3; ++a)
  {
    FailIf(!(placement.Spacing[a] > 0.0) || !std::isfinite(placement.Spacing[a]),
      "the distance of the voxels is not positive");
    for (int b = 0; b < 3; ++b)
    {
      const double product = Dot(placement.Axes[a], placement.Axes[b]);
      FailIf(!(std::abs(product - (a == b ? 1.0 : 0.0)) < tolerance),
        std::string("the voxel axes are not at right angles: ") + MustBeResampled);
      matrix[3 * b + a] = placement.Axes[a][b];
    }
  }
  image->SetSpacing(placement.Spacing.data());
  image->SetOrigin(placement.Origin.data());
  image->SetDirectionMatrix(matrix);
}

void SetWorldAxes(vtkImageData* image, const std::string& axes)
{
  SetFact(image, "Axes", axes);
}

void SetFact(vtkImageData* image, const std::string& name, const std::string& text)
{
  vtkNew<vtkStringArray> fact;
  fact->SetName(name.c_str());
  fact->InsertNextValue(text);
  image->GetFieldData()->AddArray(fact);
}

std::string GetFact(vtkImageData* image, const std::string& name)
{
  auto* fact = vtkStringArray::SafeDownCast(image->GetFieldData()->GetAbstractArray(name.c_str()));
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
