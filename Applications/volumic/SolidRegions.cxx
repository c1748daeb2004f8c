// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SolidRegions.h"

#include "ToolErrors.h"

#include <vtkMath.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace tool
{
namespace
{
/** `from` and so many times `direction`. */
Vector3 Along(const Vector3& from, const Vector3& direction, double times)
{
  return { from[0] + times * direction[0], from[1] + times * direction[1],
    from[2] + times * direction[2] };
}

Vector3 MiddleOf(const Corners& corners)
{
  const Vector3 sum = Along(Along(corners[0], corners[1], 1.0), corners[2], 1.0);
  return { sum[0] / 3.0, sum[1] / 3.0, sum[2] / 3.0 };
}

/** How much of the sphere about a point a triangle covers, negative where its normal points to it.
 */
double SolidAngle(const Corners& corners, const Vector3& point)
{
  std::array<Vector3, 3> to;
  std::array<double, 3> far;
  for (std::size_t i = 0; i < 3; ++i)
  {
    to[i] = Minus(corners[i], point);
    far[i] = std::sqrt(Dot(to[i], to[i]));
  }
  return 2.0 *
    std::atan2(Dot(to[0], Cross(to[1], to[2])),
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

//------------------------------------------------------------------------------
class RegionFinder
{
public:
  explicit RegionFinder(vtkPolyData* surface) : Mesh(surface), Shells(Mesh.FindShells()) {}

  SolidRegions Find();

private:
  void MakeRegions();
  int RegionAbout(const Shell& cavity, const std::vector<const Shell*>& outer) const;
  void FindPoint(std::size_t region);
  void AddTriangles();
  double SolidAngleOf(const std::vector<Side>& sides, const Vector3& point) const;

  LabelledTriangles Mesh;
  std::vector<Shell> Shells;
  SolidRegions Found;
  std::vector<int> RegionOf;              ///< of each side
  std::vector<std::vector<Side>> SidesOf; ///< of each region
};

double RegionFinder::SolidAngleOf(const std::vector<Side>& sides, const Vector3& point) const
{
  return std::accumulate(sides.begin(), sides.end(), 0.0,
    [&](double sum, Side side) { return sum + SolidAngle(this->Mesh.CornersOf(side), point); });
}

/** That of the smallest shell that has a cavity's one inside. @param outer by their volumes */
int RegionFinder::RegionAbout(const Shell& cavity, const std::vector<const Shell*>& outer) const
{
  const Vector3 place = MiddleOf(this->Mesh.CornersOf(cavity.Sides.front()));
  const auto found = std::find_if(outer.begin(), outer.end(),
    [&](const Shell* shell)
    {
      return shell->Label == cavity.Label && shell->Volume > -cavity.Volume &&
        shell->Box.Contains(cavity.Box) &&
        this->SolidAngleOf(shell->Sides, place) > 2.0 * vtkMath::Pi();
    });
  FailIf(found == outer.end() && cavity.Label >= 0,
    "cannot be written (its triangles do not enclose " +
      this->Mesh.Labels[static_cast<std::size_t>(std::max(cavity.Label, 0))].Name + ")");
  return found == outer.end() ? 0 : this->RegionOf[(*found)->Sides.front()];
}

/** One of each outer shell, with the cavities in it, and the outermost region. */
void RegionFinder::MakeRegions()
{
  std::vector<const Shell*> outer;
  std::vector<const Shell*> cavities;
  for (const Shell& shell : this->Shells)
  {
    (shell.Volume > 0.0 ? outer : cavities).push_back(&shell);
  }
  this->RegionOf.resize(2 * this->Mesh.Triangles.size());
  const auto add = [this](const Shell& shell, int region)
  {
    std::vector<Side>& sides = this->SidesOf[static_cast<std::size_t>(region)];
    sides.insert(sides.end(), shell.Sides.begin(), shell.Sides.end());
    for (const Side side : shell.Sides)
    {
      this->RegionOf[side] = region;
    }
  };
  this->Found.Regions.resize(1 + outer.size());
  this->SidesOf.resize(1 + outer.size());
  std::stable_sort(outer.begin(), outer.end(),
    [](const Shell* a, const Shell* b)
    { return std::make_pair(a->Label < 0, a->Label) < std::make_pair(b->Label < 0, b->Label); });
  for (std::size_t i = 0; i < outer.size(); ++i)
  {
    this->Found.Regions[i + 1].Label = outer[i]->Label;
    add(*outer[i], static_cast<int>(i + 1));
  }
  std::stable_sort(outer.begin(), outer.end(),
    [](const Shell* a, const Shell* b) { return a->Volume < b->Volume; });
  for (const Shell* cavity : cavities)
  {
    add(*cavity, this->RegionAbout(*cavity, outer));
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
  std::vector<std::pair<double, Vector3>> points; // behind the way to each, negative
  const std::size_t step = std::max<std::size_t>(sides.size() / tries, 1);
  for (std::size_t i = 0; i < sides.size(); i += step)
  {
    const Corners corners = this->Mesh.CornersOf(sides[i]);
    const Vector3 middle = MiddleOf(corners);
    const Vector3 inward = Cross(Minus(corners[2], corners[0]), Minus(corners[1], corners[0]));
    double way = std::numeric_limits<double>::infinity();
    for (const Side side : sides)
    {
      way = side == sides[i] ? way
                             : std::min(way, MeetingOf(this->Mesh.CornersOf(side), middle, inward));
    }
    if (std::isfinite(way))
    {
      points.emplace_back(-way * std::sqrt(Dot(inward, inward)), Along(middle, inward, way / 2.0));
    }
  }
  std::sort(points.begin(), points.end());
  const auto found = std::find_if(points.begin(), points.end(),
    [&](const auto& point)
    { return std::abs(this->SolidAngleOf(sides, point.second) - 4.0 * vtkMath::Pi()) < 1e-3; });
  FailIf(found == points.end(), "cannot be written (a region of it is too thin for a point in it)");
  this->Found.Regions[region].Inside = found->second;
}

/** Those between the same regions have the same one behind them, the first of a label. */
void RegionFinder::AddTriangles()
{
  const auto order = [this](int region)
  { return std::make_pair(!this->Found.IsSolid(static_cast<std::size_t>(region)), region); };
  for (std::size_t t = 0; t < this->Mesh.Triangles.size(); ++t)
  {
    SolidRegions::Triangle triangle{ this->Mesh.Triangles[t], this->RegionOf[2 * t],
      this->RegionOf[2 * t + 1] };
    if (order(triangle.InFront) < order(triangle.Behind))
    {
      std::swap(triangle.Behind, triangle.InFront);
      std::swap(triangle.Corners[1], triangle.Corners[2]);
    }
    this->Found.Triangles.push_back(triangle);
  }
}

SolidRegions RegionFinder::Find()
{
  this->MakeRegions();
  for (std::size_t region = 1; region < this->Found.Regions.size(); ++region)
  {
    this->FindPoint(region);
  }
  this->AddTriangles();
  this->Found.Labels = this->Mesh.Labels;
  return std::move(this->Found);
}
}

SolidRegions FindRegions(vtkPolyData* surface)
{
  return RegionFinder(surface).Find();
}
}
