// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/MismatchedVoxels.h"

#include "Core/Common/Sort.h"
#include "Core/Common/Spans.h"
#include "Core/Interfaces/InterfaceClearance.h"
#include "Core/Mesh/RowCrossing.h"
#include "Core/Mesh/TriangleDistance.h"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

namespace volumic
{
namespace
{
using Number = LabelMap::Number;

constexpr std::size_t SpanSize = 4096;

struct FaceCrossing
{
  std::int64_t Row;
  double X; ///< in voxels
  int Winding;
  int Face;

  bool operator<(const FaceCrossing& other) const
  {
    return std::tie(this->Row, this->X, this->Face) < std::tie(other.Row, other.X, other.Face);
  }
};

class MismatchFinder
{
public:
  MismatchFinder(const InterfaceMesh& mesh, const LabelMap& map, const VoxelBox& box,
    const std::array<double, 3>& step, Executor& executor)
    : Mesh(mesh), Map(map), Box(box), Step(step), Threads(executor)
  {
    this->Rows.First = { 0, box.First[1], box.First[2] };
    this->Rows.End = { 0, box.End[1], box.End[2] };
  }

  std::vector<MismatchedVoxel> Find()
  {
    this->FindCrossings();
    const VoxelBox& box = this->Box;
    return CollectInSpans<MismatchedVoxel>(this->Threads,
      static_cast<std::size_t>(std::max(0, box.Length(2))), 1,
      [&](std::size_t slice, std::vector<MismatchedVoxel>& found)
      {
        for (int j = box.First[1]; j < box.End[1]; ++j)
        {
          this->FollowRow(j, box.First[2] + static_cast<int>(slice), found);
        }
      });
  }

private:
  void FindCrossings()
  {
    this->Crossings = CollectInSpans<FaceCrossing>(this->Threads, this->Mesh.Faces.size(), SpanSize,
      [this](std::size_t f, std::vector<FaceCrossing>& crossings)
      {
        const InterfaceMesh::Face& face = this->Mesh.Faces[f];
        if (!face.IsThere())
        {
          return;
        }
        std::array<Point, 3> corners;
        for (int c = 0; c < 3; ++c)
        {
          const Vector& p = this->Mesh.Position[static_cast<std::size_t>(face.Vertex[c])];
          corners[c] = { p.X / this->Step[0], p.Y / this->Step[1], p.Z / this->Step[2] };
        }
        std::vector<RowGrid::Crossing> some;
        this->Rows.AddCrossings(corners, some);
        for (const RowGrid::Crossing& crossing : some)
        {
          crossings.push_back(
            { crossing.Row, crossing.Where.X, crossing.Where.Winding, static_cast<int>(f) });
        }
      });
    Sort(this->Threads, this->Crossings);
  }

  void FollowRow(int j, int k, std::vector<MismatchedVoxel>& found) const
  {
    const std::int64_t row = this->Rows.RowOf(j, k);
    auto next = std::lower_bound(this->Crossings.begin(), this->Crossings.end(), row,
      [](const FaceCrossing& crossing, std::int64_t number) { return crossing.Row < number; });
    const VoxelBox ofMap = VoxelBox::Of(this->Map.Size());
    if (!ofMap.Contains({ 0, j, k }) && (next == this->Crossings.end() || next->Row != row))
    {
      return;
    }
    std::vector<std::pair<Number, int>> windings; // non-zero winding numbers of objects
    const auto add = [&](Number object, int winding)
    {
      auto at = std::find_if(windings.begin(), windings.end(),
        [object](const auto& entry) { return entry.first == object; });
      at = at == windings.end() ? windings.insert(at, { object, 0 }) : at;
      at->second += winding;
      if (at->second == 0)
      {
        windings.erase(at);
      }
    };
    for (int i = this->Box.First[0]; i < this->Box.End[0]; ++i)
    {
      for (; next != this->Crossings.end() && next->Row == row && next->X < i; ++next)
      {
        const InterfaceMesh::Face& face = this->Mesh.Faces[static_cast<std::size_t>(next->Face)];
        add(face.Behind, next->Winding);
        if (!this->Mesh.IsSide(face.Front))
        {
          add(face.Front, -next->Winding);
        }
      }
      const Number mapObject = ofMap.Contains({ i, j, k }) ? this->Map.At(i, j, k) : Number(0);
      const auto inside = std::find_if(windings.begin(), windings.end(),
        [](const auto& entry) { return entry.first != 0 && entry.second > 0; });
      const Number meshObject = inside == windings.end() ? Number(0) : inside->first;
      if (mapObject != meshObject)
      {
        found.push_back({ { i, j, k }, mapObject, meshObject });
      }
    }
  }

  const InterfaceMesh& Mesh;
  const LabelMap& Map;
  const VoxelBox Box;
  const std::array<double, 3>& Step;
  Executor& Threads;
  RowGrid Rows;
  std::vector<FaceCrossing> Crossings;
};
}

std::vector<MismatchedVoxel> FindMismatchedVoxels(const InterfaceMesh& mesh, const LabelMap& map,
  const VoxelBox& box, const std::array<double, 3>& step, double tolerance, Executor& executor)
{
  std::vector<MismatchedVoxel> found = MismatchFinder(mesh, map, box, step, executor).Find();
  if (tolerance <= 0. || found.empty())
  {
    return found;
  }
  InterfaceClearance clearance(mesh, tolerance);
  clearance.Reset(executor);
  ForSpans(executor, found.size(), SpanSize,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      std::vector<int> near;
      for (std::size_t n = begin; n < end; ++n)
      {
        const std::array<int, 3>& at = found[n].At;
        const VectorD centre(at[0] * step[0], at[1] * step[1], at[2] * step[2]);
        clearance.FindNear({ Vector(centre), Vector(centre) }, near);
        found[n].IsFar = std::none_of(near.begin(), near.end(),
          [&](int f) {
            return SquaredDistanceToTriangle(centre, TriangleAt(mesh, f).Corner) <=
              tolerance * tolerance;
          });
      }
    });
  return found;
}
}
