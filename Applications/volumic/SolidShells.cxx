// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SolidRegions.h"

#include "ToolErrors.h"

#include <vtkCellData.h>
#include <vtkIntArray.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace tool
{
/** A triangle at an edge. */
struct LabelledTriangles::EdgeUse
{
  vtkIdType Low;
  vtkIdType High;
  std::size_t Triangle;
  bool IsUpwards; ///< from Low to High in the order of the triangle's corners
  vtkIdType Opposite;

  /** The side that whoever goes about the edge counterclockwise, seen from High, comes upon last.
   */
  Side Leaving() const { return 2 * this->Triangle + (this->IsUpwards ? 1 : 0); }
  Side Coming() const { return 2 * this->Triangle + (this->IsUpwards ? 0 : 1); }
};

Vector3 Minus(const Vector3& a, const Vector3& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}

std::vector<int> SolidNumbers(const std::vector<SurfaceLabel>& labels)
{
  int next = 0;
  for (const SurfaceLabel& label : labels)
  {
    next = std::max(next, label.Label);
  }
  std::vector<int> numbers;
  for (const SurfaceLabel& label : labels)
  {
    numbers.push_back(label.Label > 0 ? label.Label : ++next);
  }
  return numbers;
}

//------------------------------------------------------------------------------
LabelledTriangles::LabelledTriangles(vtkPolyData* surface)
{
  this->ReadLabels(surface);
  this->ReadTriangles(surface);
}

void LabelledTriangles::ReadLabels(vtkPolyData* surface)
{
  this->Labels = LabelsOf(surface);
  if (surface->GetCellData()->HasArray("BoundaryLabels"))
  {
    return;
  }
  SurfaceLabel one{ 1, "object" };
  for (const SurfaceLabel& label : this->Labels)
  {
    const bool isFirst = &label == &this->Labels.front();
    one = isFirst ? label : SurfaceLabel{ one.Label, one.Name + ", " + label.Name, one.Color };
  }
  this->Labels = { one };
}

void LabelledTriangles::ReadTriangles(vtkPolyData* surface)
{
  std::map<int, int> numbers;
  for (std::size_t i = 0; i < this->Labels.size(); ++i)
  {
    numbers[this->Labels[i].Label] = static_cast<int>(i);
  }
  this->Places.resize(static_cast<std::size_t>(surface->GetNumberOfPoints()));
  for (std::size_t i = 0; i < this->Places.size(); ++i)
  {
    surface->GetPoint(static_cast<vtkIdType>(i), this->Places[i].data());
  }
  auto* labels = vtkIntArray::SafeDownCast(surface->GetCellData()->GetArray("BoundaryLabels"));
  const vtkIdType before = surface->GetNumberOfVerts() + surface->GetNumberOfLines(); // cells
  ForEachPolygon(surface,
    [&](vtkIdType polygon, const vtkIdType* corners, vtkIdType count)
    {
      FailIf(count != 3, "cannot be written (it has cells that are no triangles)");
      this->Triangles.push_back({ corners[0], corners[1], corners[2] });
      for (int side = 0; side < 2; ++side)
      {
        this->LabelOf.push_back(
          labels ? EntryOr(numbers, labels->GetTypedComponent(before + polygon, side), -1) : -side);
      }
    });
  FailIf(this->Triangles.empty(), "cannot be written (there is no surface)");
}

//------------------------------------------------------------------------------
Side LabelledTriangles::RootOf(Side side)
{
  while (this->Parents[side] != side)
  {
    side = this->Parents[side] = this->Parents[this->Parents[side]];
  }
  return side;
}

void LabelledTriangles::Join(Side a, Side b)
{
  FailIf(this->LabelOf[a] != this->LabelOf[b],
    "cannot be written (the labels on the sides of its triangles do not agree)");
  a = this->RootOf(a);
  b = this->RootOf(b);
  this->Parents[std::max(a, b)] = std::min(a, b);
}

void LabelledTriangles::JoinSides()
{
  this->Parents.resize(this->LabelOf.size());
  std::iota(this->Parents.begin(), this->Parents.end(), Side(0));
  std::vector<EdgeUse> uses;
  uses.reserve(3 * this->Triangles.size());
  for (std::size_t t = 0; t < this->Triangles.size(); ++t)
  {
    for (std::size_t i = 0; i < 3; ++i)
    {
      const vtkIdType from = this->Triangles[t][i];
      const vtkIdType to = this->Triangles[t][(i + 1) % 3];
      uses.push_back(
        { std::min(from, to), std::max(from, to), t, from < to, this->Triangles[t][(i + 2) % 3] });
    }
  }
  std::sort(uses.begin(), uses.end(),
    [](const EdgeUse& a, const EdgeUse& b)
    { return std::tie(a.Low, a.High, a.Triangle) < std::tie(b.Low, b.High, b.Triangle); });
  std::vector<EdgeUse> about;
  const EdgeUse* end = uses.data() + uses.size();
  for (const EdgeUse* first = uses.data(); first != end;)
  {
    const EdgeUse* last = std::find_if(first, end,
      [first](const EdgeUse& use) { return use.Low != first->Low || use.High != first->High; });
    about.assign(first, last);
    this->JoinAbout(about);
    first = last;
  }
}

/** Join the sides of the triangles of an edge, two and two. */
void LabelledTriangles::JoinAbout(std::vector<EdgeUse>& uses)
{
  FailIf(uses.size() == 1, "cannot be written (the surface is not closed)");
  if (uses.size() > 2)
  {
    // Where each label is there once, no angles are needed, which are as exact as numbers are.
    std::map<int, std::vector<Side>> sides;
    for (const EdgeUse& use : uses)
    {
      sides[this->LabelOf[use.Coming()]].push_back(use.Coming());
      sides[this->LabelOf[use.Leaving()]].push_back(use.Leaving());
    }
    if (std::all_of(
          sides.begin(), sides.end(), [](const auto& of) { return of.second.size() == 2; }))
    {
      for (const auto& of : sides)
      {
        this->Join(of.second[0], of.second[1]);
      }
      return;
    }
    this->SortAbout(uses);
  }
  for (std::size_t i = 0; i < uses.size(); ++i)
  {
    this->Join(uses[i].Leaving(), uses[(i + 1) % uses.size()].Coming());
  }
}

/** Counterclockwise about the edge, seen from its end. */
void LabelledTriangles::SortAbout(std::vector<EdgeUse>& uses) const
{
  const Vector3 low = this->Place(uses.front().Low);
  const Vector3 axis = Minus(this->Place(uses.front().High), low);
  const Vector3 y = Cross(axis, Minus(this->Place(uses.front().Opposite), low));
  const Vector3 x = Cross(y, axis);
  const double scale = std::sqrt(Dot(axis, axis)); // x is so much longer than y
  std::vector<std::pair<double, EdgeUse>> byAngle;
  for (const EdgeUse& use : uses)
  {
    const Vector3 to = Minus(this->Place(use.Opposite), low);
    byAngle.emplace_back(std::atan2(Dot(to, y) * scale, Dot(to, x)), use);
  }
  std::stable_sort(
    byAngle.begin(), byAngle.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::transform(
    byAngle.begin(), byAngle.end(), uses.begin(), [](const auto& angled) { return angled.second; });
}

//------------------------------------------------------------------------------
Corners LabelledTriangles::CornersOf(Side side) const
{
  const std::array<vtkIdType, 3>& corners = this->Triangles[side / 2];
  const bool isTurned = side % 2 == 1;
  return { this->Place(corners[0]), this->Place(corners[isTurned ? 2 : 1]),
    this->Place(corners[isTurned ? 1 : 2]) };
}

std::vector<Shell> LabelledTriangles::FindShells()
{
  this->JoinSides();
  std::vector<Shell> shells;
  std::map<Side, std::size_t> numbers;
  for (Side side = 0; side < this->LabelOf.size(); ++side)
  {
    const Side root = this->RootOf(side); // the first one of the shell
    if (root == side)
    {
      numbers[root] = shells.size();
      shells.push_back({ this->LabelOf[side] });
    }
    Shell& shell = shells[numbers.at(root)];
    shell.Sides.push_back(side);
    const Vector3 origin = this->Place(this->Triangles[shell.Sides.front() / 2][0]);
    const Corners corners = this->CornersOf(side);
    shell.Volume +=
      Dot(Minus(corners[0], origin), Cross(Minus(corners[1], origin), Minus(corners[2], origin))) /
      6.0;
    for (const Vector3& corner : corners)
    {
      shell.Box.AddPoint(corner[0], corner[1], corner[2]);
    }
  }
  return shells;
}
}
