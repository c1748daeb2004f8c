// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SolidRegions.h"

#include "ToolErrors.h"

#include <vtkBoundingBox.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkIntArray.h>
#include <vtkMath.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

namespace tool
{
namespace
{
Vector3 Minus(const Vector3& a, const Vector3& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}

/** `from` and so many times `direction`. */
Vector3 Along(const Vector3& from, const Vector3& direction, double times)
{
  return { from[0] + times * direction[0], from[1] + times * direction[1],
    from[2] + times * direction[2] };
}

using Corners = std::array<Vector3, 3>;

/** How much of the sphere about a point a triangle covers, negative where its normal points to it. */
double SolidAngle(const Corners& corners, const Vector3& point)
{
  std::array<Vector3, 3> to;
  std::array<double, 3> far;
  for (std::size_t i = 0; i < 3; ++i)
  {
    to[i] = Minus(corners[i], point);
    far[i] = std::sqrt(Dot(to[i], to[i]));
  }
  return 2.0 * std::atan2(Dot(to[0], Cross(to[1], to[2])),
    far[0] * far[1] * far[2] + Dot(to[0], to[1]) * far[2] + Dot(to[1], to[2]) * far[0] +
      Dot(to[2], to[0]) * far[1]);
}

/** Where a ray meets a triangle, its border included, in lengths of its direction; or infinity. */
double MeetingOf(const Corners& corners, const Vector3& from, const Vector3& direction)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double border = 1e-9;
  const Vector3 a = Minus(corners[1], corners[0]);
  const Vector3 b = Minus(corners[2], corners[0]);
  const Vector3 across = Cross(direction, b);
  const double volume = Dot(a, across);
  if (volume == 0.0)
  {
    return infinity;
  }
  const Vector3 offset = Minus(from, corners[0]);
  const Vector3 turned = Cross(offset, a);
  const double u = Dot(offset, across) / volume;
  const double v = Dot(direction, turned) / volume;
  const double t = Dot(b, turned) / volume;
  const bool isMet = u >= -border && v >= -border && u + v <= 1.0 + border && t > 0.0;
  return isMet ? t : infinity;
}

// Each triangle t has two sides: side 2 t is behind it, 2 t + 1 in front of it, where its normal
// points. Sides that face each other across a wedge of an edge are of the same region; those that are
// joined so make a shell: the outer boundary of a region, or that of a cavity in it.
using Side = std::size_t;

struct Shell
{
  int Label;
  Side First;
  double Volume = 0.0; ///< enclosed by it, negative if the region is about it
  vtkBoundingBox Box = {};
  std::vector<Side> Sides = {};
  int Region = -1;
};

/** A corner of a triangle at an edge. */
struct EdgeUse
{
  vtkIdType Low;
  vtkIdType High;
  std::size_t Triangle;
  bool IsUpwards; ///< from Low to High in the order of the triangle's corners
  vtkIdType Opposite;

  /** The side that whoever goes about the edge counterclockwise, seen from High, comes upon last. */
  Side Leaving() const { return 2 * this->Triangle + (this->IsUpwards ? 1 : 0); }
  Side Coming() const { return 2 * this->Triangle + (this->IsUpwards ? 0 : 1); }
};

//------------------------------------------------------------------------------
class RegionFinder
{
public:
  explicit RegionFinder(vtkPolyData* surface) : Surface(surface) {}

  SolidRegions Find();

private:
  void ReadLabels();
  void ReadTriangles();
  void JoinSides();
  void JoinAbout(const EdgeUse* first, const EdgeUse* last);
  void SortAbout(std::vector<EdgeUse>& uses) const;
  void MakeShells();
  void MakeRegions();
  const Shell* ShellAbout(const Shell& cavity, const std::vector<const Shell*>& outer) const;
  void FindPoint(std::size_t region);

  const Vector3& Place(vtkIdType point) const
  {
    return this->Places[static_cast<std::size_t>(point)];
  }
  Corners CornersOf(Side side) const;
  double SolidAngleOf(const std::vector<Side>& sides, const Vector3& point) const;
  Side RootOf(Side side);
  void Join(Side a, Side b);

  vtkPolyData* Surface;
  SolidRegions Found;
  std::vector<Vector3> Places; ///< of points
  std::vector<std::array<vtkIdType, 3>> Triangles;
  std::vector<int> LabelOf; ///< of each side, as SolidRegion has it
  std::vector<Side> Parents; ///< of each side, up to one of its shell
  std::vector<Shell> Shells;
  std::vector<std::vector<Side>> SidesOf; ///< of each region
};

//------------------------------------------------------------------------------
void RegionFinder::ReadLabels()
{
  this->Found.Labels = LabelsOf(this->Surface);
  if (this->Surface->GetCellData()->HasArray("BoundaryLabels"))
  {
    return;
  }
  SurfaceLabel one{ 1, "object" };
  for (const SurfaceLabel& label : this->Found.Labels)
  {
    const bool isFirst = &label == &this->Found.Labels.front();
    one = isFirst ? label : SurfaceLabel{ one.Label, one.Name + ", " + label.Name, one.Color };
  }
  this->Found.Labels = { one };
}

void RegionFinder::ReadTriangles()
{
  std::map<int, int> numbers;
  for (std::size_t i = 0; i < this->Found.Labels.size(); ++i)
  {
    numbers[this->Found.Labels[i].Label] = static_cast<int>(i);
  }
  this->Places.resize(static_cast<std::size_t>(this->Surface->GetNumberOfPoints()));
  for (std::size_t i = 0; i < this->Places.size(); ++i)
  {
    this->Surface->GetPoint(static_cast<vtkIdType>(i), this->Places[i].data());
  }
  auto* labels =
    vtkIntArray::SafeDownCast(this->Surface->GetCellData()->GetArray("BoundaryLabels"));
  const vtkIdType before =
    this->Surface->GetNumberOfVerts() + this->Surface->GetNumberOfLines(); // cells
  auto cells = vtk::TakeSmartPointer(this->Surface->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    cells->GetCurrentCell(count, corners);
    FailIf(count != 3, "cannot be written (it has cells that are no triangles)");
    this->Triangles.push_back({ corners[0], corners[1], corners[2] });
    for (int side = 0; side < 2; ++side)
    {
      const int label = labels
        ? EntryOr(numbers, labels->GetTypedComponent(before + cells->GetCurrentCellId(), side), -1)
        : -side;
      this->LabelOf.push_back(label);
    }
  }
  FailIf(this->Triangles.empty(), "cannot be written (there is no surface)");
}

//------------------------------------------------------------------------------
Side RegionFinder::RootOf(Side side)
{
  while (this->Parents[side] != side)
  {
    side = this->Parents[side] = this->Parents[this->Parents[side]];
  }
  return side;
}

void RegionFinder::Join(Side a, Side b)
{
  FailIf(this->LabelOf[a] != this->LabelOf[b],
    "cannot be written (the labels on the sides of its triangles do not agree)");
  a = this->RootOf(a);
  b = this->RootOf(b);
  this->Parents[std::max(a, b)] = std::min(a, b);
}

void RegionFinder::JoinSides()
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
      uses.push_back({ std::min(from, to), std::max(from, to), t, from < to,
        this->Triangles[t][(i + 2) % 3] });
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b)
    { return std::tie(a.Low, a.High, a.Triangle) < std::tie(b.Low, b.High, b.Triangle); });
  const EdgeUse* end = uses.data() + uses.size();
  for (const EdgeUse* first = uses.data(); first != end;)
  {
    const EdgeUse* last = std::find_if(first, end, [first](const EdgeUse& use)
      { return use.Low != first->Low || use.High != first->High; });
    this->JoinAbout(first, last);
    first = last;
  }
}

/** Join the sides of the triangles of an edge, two and two. */
void RegionFinder::JoinAbout(const EdgeUse* first, const EdgeUse* last)
{
  FailIf(last - first == 1, "cannot be written (the surface is not closed)");
  std::vector<EdgeUse> uses(first, last);
  if (uses.size() > 2)
  {
    // Where each label is there once, no angles are needed, which are as exact as numbers are.
    std::map<int, std::vector<Side>> sides;
    for (const EdgeUse& use : uses)
    {
      sides[this->LabelOf[use.Coming()]].push_back(use.Coming());
      sides[this->LabelOf[use.Leaving()]].push_back(use.Leaving());
    }
    if (std::all_of(sides.begin(), sides.end(),
          [](const auto& of) { return of.second.size() == 2; }))
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
void RegionFinder::SortAbout(std::vector<EdgeUse>& uses) const
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
  std::stable_sort(byAngle.begin(), byAngle.end(),
    [](const auto& a, const auto& b) { return a.first < b.first; });
  std::transform(byAngle.begin(), byAngle.end(), uses.begin(),
    [](const auto& angled) { return angled.second; });
}

//------------------------------------------------------------------------------
/** Those of its triangle, in the order that makes the normal point out of the side's region. */
Corners RegionFinder::CornersOf(Side side) const
{
  const std::array<vtkIdType, 3>& corners = this->Triangles[side / 2];
  const bool isTurned = side % 2 == 1;
  return { this->Place(corners[0]), this->Place(corners[isTurned ? 2 : 1]),
    this->Place(corners[isTurned ? 1 : 2]) };
}

void RegionFinder::MakeShells()
{
  std::map<Side, std::size_t> numbers;
  for (Side side = 0; side < this->LabelOf.size(); ++side)
  {
    const Side root = this->RootOf(side); // the first one of the shell
    if (root == side)
    {
      numbers[root] = this->Shells.size();
      this->Shells.push_back({ this->LabelOf[side], side });
    }
    Shell& shell = this->Shells[numbers.at(root)];
    shell.Sides.push_back(side);
    const Vector3 origin = this->Place(this->Triangles[shell.First / 2][0]);
    const Corners corners = this->CornersOf(side);
    shell.Volume += Dot(Minus(corners[0], origin),
                      Cross(Minus(corners[1], origin), Minus(corners[2], origin))) /
      6.0;
    for (const Vector3& corner : corners)
    {
      shell.Box.AddPoint(corner[0], corner[1], corner[2]);
    }
  }
}

double RegionFinder::SolidAngleOf(const std::vector<Side>& sides, const Vector3& point) const
{
  return std::accumulate(sides.begin(), sides.end(), 0.0, [&](double sum, Side side)
    { return sum + SolidAngle(this->CornersOf(side), point); });
}

/** The smallest one that has a cavity's shell inside; null: none. @param outer by their volumes */
const Shell* RegionFinder::ShellAbout(
  const Shell& cavity, const std::vector<const Shell*>& outer) const
{
  const Corners corners = this->CornersOf(cavity.First);
  Vector3 middle;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    middle[axis] = (corners[0][axis] + corners[1][axis] + corners[2][axis]) / 3.0;
  }
  const auto found = std::find_if(outer.begin(), outer.end(), [&](const Shell* shell)
    {
      return shell->Label == cavity.Label && shell->Volume > -cavity.Volume &&
        shell->Box.Contains(cavity.Box) &&
        this->SolidAngleOf(shell->Sides, middle) > 2.0 * vtkMath::Pi();
    });
  return found == outer.end() ? nullptr : *found;
}

/** One of each outer shell, with the cavities in it, and the outermost region. */
void RegionFinder::MakeRegions()
{
  std::vector<Shell*> ordered;
  for (Shell& shell : this->Shells)
  {
    if (shell.Volume > 0.0)
    {
      ordered.push_back(&shell);
    }
  }
  std::stable_sort(ordered.begin(), ordered.end(), [](const Shell* a, const Shell* b)
    { return std::make_pair(a->Label < 0, a->Label) < std::make_pair(b->Label < 0, b->Label); });
  this->Found.Regions.resize(1);
  for (Shell* shell : ordered)
  {
    shell->Region = static_cast<int>(this->Found.Regions.size());
    this->Found.Regions.push_back({ shell->Label });
  }
  std::vector<const Shell*> outer(ordered.begin(), ordered.end());
  std::stable_sort(outer.begin(), outer.end(),
    [](const Shell* a, const Shell* b) { return a->Volume < b->Volume; });
  for (Shell& shell : this->Shells)
  {
    if (shell.Region < 0)
    {
      const Shell* about = this->ShellAbout(shell, outer);
      FailIf(!about && shell.Label >= 0,
        "cannot be written (its triangles do not enclose " +
          this->Found.Labels[static_cast<std::size_t>(std::max(shell.Label, 0))].Name + ")");
      shell.Region = about ? about->Region : 0;
    }
  }
  this->SidesOf.resize(this->Found.Regions.size());
  for (const Shell& shell : this->Shells)
  {
    std::vector<Side>& sides = this->SidesOf[static_cast<std::size_t>(shell.Region)];
    sides.insert(sides.end(), shell.Sides.begin(), shell.Sides.end());
  }
}

/**
 * From the middles of some of its sides straight on to what is met first, which is of the same
 * region: half the way of the longest one, if the solid angles say that it is inside.
 */
void RegionFinder::FindPoint(std::size_t region)
{
  constexpr std::size_t tries = 12;
  const std::vector<Side>& sides = this->SidesOf[region];
  std::vector<std::pair<double, Vector3>> points; // and their distance from the sides
  const std::size_t step = std::max<std::size_t>(sides.size() / tries, 1);
  for (std::size_t i = 0; i < sides.size(); i += step)
  {
    const Corners corners = this->CornersOf(sides[i]);
    const Vector3 outward = Cross(Minus(corners[1], corners[0]), Minus(corners[2], corners[0]));
    const double length = std::sqrt(Dot(outward, outward));
    if (length == 0.0)
    {
      continue;
    }
    const Vector3 inward = Along({ 0.0, 0.0, 0.0 }, outward, -1.0 / length);
    const Vector3 middle = Along(Along(Along({ 0.0, 0.0, 0.0 }, corners[0], 1.0 / 3.0), corners[1],
                                   1.0 / 3.0),
      corners[2], 1.0 / 3.0);
    double way = std::numeric_limits<double>::infinity();
    for (const Side side : sides)
    {
      way = side == sides[i] ? way : std::min(way, MeetingOf(this->CornersOf(side), middle, inward));
    }
    if (std::isfinite(way))
    {
      points.emplace_back(-way, Along(middle, inward, way / 2.0));
    }
  }
  std::sort(points.begin(), points.end());
  const auto found = std::find_if(points.begin(), points.end(), [&](const auto& point)
    { return std::abs(this->SolidAngleOf(sides, point.second) - 4.0 * vtkMath::Pi()) < 1e-3; });
  FailIf(found == points.end(), "cannot be written (a region of it is too thin for a point in it)");
  this->Found.Regions[region].Inside = found->second;
}

//------------------------------------------------------------------------------
SolidRegions RegionFinder::Find()
{
  this->ReadLabels();
  this->ReadTriangles();
  this->JoinSides();
  this->MakeShells();
  this->MakeRegions();
  for (std::size_t region = 1; region < this->Found.Regions.size(); ++region)
  {
    this->FindPoint(region);
  }
  std::vector<int> regionOf(this->LabelOf.size());
  for (const Shell& shell : this->Shells)
  {
    for (const Side side : shell.Sides)
    {
      regionOf[side] = shell.Region;
    }
  }
  for (std::size_t t = 0; t < this->Triangles.size(); ++t)
  {
    SolidRegions::Triangle triangle{ this->Triangles[t], regionOf[2 * t], regionOf[2 * t + 1] };
    // The same triangles of a pair of regions have the same one behind them.
    const auto order = [this](int region)
    {
      const auto index = static_cast<std::size_t>(region);
      return std::make_pair(!this->Found.IsSolid(index), region);
    };
    if (order(triangle.InFront) < order(triangle.Behind))
    {
      std::swap(triangle.Behind, triangle.InFront);
      std::swap(triangle.Corners[1], triangle.Corners[2]);
    }
    this->Found.Triangles.push_back(triangle);
  }
  return std::move(this->Found);
}
}

SolidRegions FindRegions(vtkPolyData* surface)
{
  return RegionFinder(surface).Find();
}
}
