// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ForVoxels.h"
#include "SurfaceJudge.h"

#include "JudgeInternals.h"
#include "PointGrid.h"

#include <algorithm>

namespace volumic::support
{
namespace
{

// Radii of ReachedShare(), in voxels.
constexpr double BallRadius = 1.5;
constexpr double TouchedRadius = 2.5;
constexpr double FoundRadius = 2.0;

/** Interpolated value and gradient; outside, the nearest voxel counts. */
class Field
{
public:
  explicit Field(const JudgedVolume& volume) : Volume(volume) {}

  void Sample(
    const std::array<double, 3>& point, double& value, std::array<double, 3>& gradient) const
  {
    int low[3];
    double part[3];
    for (int a = 0; a < 3; ++a)
    {
      const double inside = std::clamp(point[a], 0.0, this->Volume.Size[a] - 1.0);
      low[a] = std::min(static_cast<int>(inside), std::max(this->Volume.Size[a] - 2, 0));
      part[a] = inside - low[a];
    }
    value = 0.0;
    gradient = { 0.0, 0.0, 0.0 };
    for (int corner = 0; corner < 8; ++corner)
    {
      int at[3];
      double weight = 1.0;
      for (int a = 0; a < 3; ++a)
      {
        const int step = corner >> a & 1;
        at[a] = low[a] + step;
        weight *= step ? part[a] : 1.0 - part[a];
      }
      value += weight * this->Voxel(at[0], at[1], at[2]);
      gradient[0] += 0.5 * weight *
        (this->Voxel(at[0] + 1, at[1], at[2]) - this->Voxel(at[0] - 1, at[1], at[2]));
      gradient[1] += 0.5 * weight *
        (this->Voxel(at[0], at[1] + 1, at[2]) - this->Voxel(at[0], at[1] - 1, at[2]));
      gradient[2] += 0.5 * weight *
        (this->Voxel(at[0], at[1], at[2] + 1) - this->Voxel(at[0], at[1], at[2] - 1));
    }
    for (int a = 0; a < 3; ++a)
    {
      gradient[a] /= this->Volume.Spacing[a];
    }
  }

private:
  double Voxel(int i, int j, int k) const
  {
    const auto& size = this->Volume.Size;
    i = std::clamp(i, 0, size[0] - 1);
    j = std::clamp(j, 0, size[1] - 1);
    k = std::clamp(k, 0, size[2] - 1);
    return this->Volume.Values[(static_cast<std::size_t>(k) * size[1] + j) * size[0] + i];
  }

  const JudgedVolume& Volume;
};

double DistanceAt(const Field& field, const std::array<double, 3>& point, double isoValue)
{
  constexpr double largest = 10.0;
  double value;
  std::array<double, 3> gradient;
  field.Sample(point, value, gradient);
  const double difference = std::abs(value - isoValue);
  const double slope = Norm(gradient);
  return difference < largest * slope ? difference / slope : (difference > 0.0 ? largest : 0.0);
}

/** The volume with a border of background, wide enough for the ball and its neighbours. */
struct AirMap
{
  enum Flag : unsigned char
  {
    Object = 1,
    Clear = 2, ///< centre of a ball of background
    Reached = 4
  };
  static constexpr int Border = 5;

  std::array<int, 3> Size;
  std::vector<unsigned char> Flags;

  explicit AirMap(const JudgedVolume& volume)
  {
    for (int a = 0; a < 3; ++a)
    {
      this->Size[a] = volume.Size[a] + 2 * Border;
    }
    this->Flags.assign(static_cast<std::size_t>(this->Offset(0, 0, this->Size[2])), 0);
    const float* value = volume.Values;
    ForVoxels(volume.Size,
      [&](int i, int j, int k)
      {
        const bool isObject =
          volume.ObjectIsBright ? *value > volume.IsoValue : *value < volume.IsoValue;
        this->Flags[this->Offset(i + Border, j + Border, k + Border)] = isObject ? Object : 0;
        ++value;
      });
  }

  std::ptrdiff_t Offset(int i, int j, int k) const
  {
    return (static_cast<std::ptrdiff_t>(k) * this->Size[1] + j) * this->Size[0] + i;
  }

  /** Return the offsets of voxels within a radius of at most Border. */
  std::vector<std::ptrdiff_t> Ball(double radius) const
  {
    std::vector<std::ptrdiff_t> offsets;
    ForBox({ -Border, -Border, -Border }, { Border + 1, Border + 1, Border + 1 },
      [&](int i, int j, int k)
      {
        if (i * i + j * j + k * k <= radius * radius)
        {
          offsets.push_back(this->Offset(i, j, k));
        }
      });
    return offsets;
  }

  /** Count the voxels at these offsets that have a flag. */
  std::size_t Count(
    std::ptrdiff_t voxel, const std::vector<std::ptrdiff_t>& offsets, Flag flag) const
  {
    return static_cast<std::size_t>(std::count_if(offsets.begin(), offsets.end(),
      [&](std::ptrdiff_t offset) { return (this->Flags[voxel + offset] & flag) != 0; }));
  }

  /** Call visit(index, position) for all voxels except the two outermost layers. */
  template <typename Visitor>
  void ForEachInner(Visitor visit)
  {
    ForBox({ 2, 2, 2 }, { this->Size[0] - 2, this->Size[1] - 2, this->Size[2] - 2 },
      [&](int i, int j, int k)
      {
        visit(this->Offset(i, j, k),
          std::array<double, 3>{ double(i - Border), double(j - Border), double(k - Border) });
      });
  }

  /** Mark the centres of background balls, then those connected to the outside. */
  void Flood(double radius)
  {
    const std::vector<std::ptrdiff_t> ball = this->Ball(radius);
    this->ForEachInner([&](std::ptrdiff_t voxel, const auto&)
      { this->Flags[voxel] |= this->Count(voxel, ball, Object) == 0 ? Clear : 0; });
    const std::vector<std::ptrdiff_t> faces = this->Ball(1.0);
    std::vector<std::ptrdiff_t> stack(1, this->Offset(2, 2, 2));
    this->Flags[stack.back()] |= Reached;
    while (!stack.empty())
    {
      const std::ptrdiff_t voxel = stack.back();
      stack.pop_back();
      for (const std::ptrdiff_t offset : faces)
      {
        if ((this->Flags[voxel + offset] & (Clear | Reached)) == Clear)
        {
          this->Flags[voxel + offset] |= Reached;
          stack.push_back(voxel + offset);
        }
      }
    }
  }
};

} // namespace

IsoDistanceVerdict JudgeIsoDistance(const TriangleSurface& surface, const JudgedVolume& volume)
{
  const Field field(volume);
  IsoDistanceVerdict verdict;
  for (const auto& triangle : surface.Triangles)
  {
    verdict.MeanAtCentroids += DistanceAt(field, CentroidOf(surface, triangle), volume.IsoValue);
  }
  verdict.MeanAtCentroids /= surface.Triangles.size();
  for (const auto& point : surface.Points)
  {
    verdict.MeanAtVertices += DistanceAt(field, point, volume.IsoValue);
  }
  verdict.MeanAtVertices /= surface.Points.size();
  return verdict;
}

double ReachedShare(const TriangleSurface& surface, const JudgedVolume& volume)
{
  AirMap map(volume);
  map.Flood(BallRadius);
  const std::vector<std::ptrdiff_t> faces = map.Ball(1.0);
  const std::vector<std::ptrdiff_t> touched = map.Ball(TouchedRadius);
  const PointGrid grid(surface.Points, FoundRadius);
  double reachable = 0.0;
  double found = 0.0;
  map.ForEachInner(
    [&](std::ptrdiff_t voxel, const std::array<double, 3>& point)
    {
      const std::size_t objects = map.Count(voxel, faces, AirMap::Object);
      const bool isObject = (map.Flags[voxel] & AirMap::Object) != 0;
      if (!isObject || objects == faces.size() || map.Count(voxel, touched, AirMap::Reached) == 0)
      {
        return;
      }
      bool isFound = false;
      grid.ForEachWithin(point, FoundRadius, [&isFound](int) { isFound = true; });
      reachable += 1.0;
      found += isFound ? 1.0 : 0.0;
    });
  return reachable > 0.0 ? found / reachable : 1.0;
}

} // namespace volumic::support
