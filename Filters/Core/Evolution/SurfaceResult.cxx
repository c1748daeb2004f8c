// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/SurfaceResult.h"

#include "Core/Common/Select.h"
#include "Core/Evolution/GradedSizes.h"
#include "Core/Surface/RemainingContacts.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
/** Vertices per span of a parallel loop. */
constexpr std::size_t ResultSpan = 256; // Small, because of voxel accesses.
}

SurfaceResult MakeResult(
  SurfaceState& state, const Field& field, const Grading& grading, Executor& executor)
{
  SurfaceResult result;
  result.Delta = state.Sizing.OfLevel();
  if (state.Mesh.NumberOfVertices() == 0)
  {
    return result;
  }
  RemainingContacts contacts = FindRemainingContacts(state, field, executor);
  static_cast<IndexedSurface&>(result) = state.Mesh.ToIndexed(executor);
  const std::vector<int> alive = SelectIndices(executor, state.Mesh.Rings.size(),
    [&state](std::size_t v) { return state.Mesh.IsAlive(static_cast<int>(v)); });
  const std::size_t n = alive.size();
  const GradedSizes sizes(state, field, grading, executor);
  result.Normals.resize(n);
  result.Residual.resize(n);
  result.Motionless.resize(n);
  result.Held.resize(n);
  result.Size.resize(state.Sizing.IsGraded() ? n : 0);
  result.Thickness.resize(grading.ThinParts ? n : 0);
  LargeVector<int> pointOf(state.Mesh.Rings.size(), -1); // numbering of ToIndexed()
  ForSpans(executor, n, ResultSpan,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t point = begin; point < end; ++point)
      {
        const int v = alive[point];
        const NormalCone& normal = state.Normal[v];
        result.Normals[point] = { normal.X, normal.Y, normal.Z };
        result.Residual[point] = field.ResidualAt(state.Mesh.Position[v]);
        result.Motionless[point] = !state.Active[v];
        result.Held[point] = contacts.Held[v];
        if (!result.Size.empty())
        {
          result.Size[point] = state.Sizing.At(v);
        }
        if (!result.Thickness.empty())
        {
          result.Thickness[point] = sizes.ThicknessAt(v);
        }
        pointOf[v] = static_cast<int>(point);
      }
    });
  if (state.Sizing.KeepsGradation()) // after convergence
  {
    result.FitToTolerance = sizes.Measure();
  }
  result.Contacts = std::move(contacts.Pairs);
  for (std::array<int, 2>& pair : result.Contacts)
  {
    pair = { pointOf[pair[0]], pointOf[pair[1]] };
  }
  return result;
}
}
