// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Output/PartOfSurface.h"

#include "Core/Common/RankLists.h"
#include "Core/Evolution/RankNumbers.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>

namespace volumic
{
namespace
{
/**
 * By all ranks: which piece of the part of the whole the part of a piece is, and its contacts.
 * @param index of its points in the part, by their index in the piece; -1: they are not kept
 */
void NumberKept(
  const SurfaceResult& surface, const LargeVector<int>& index, SurfaceResult& part)
{
  const PieceOfSurface& whole = surface.Piece;
  Communicator& ranks = *whole.Ranks;
  std::vector<int> counted;
  std::vector<int> others;
  std::size_t all = 0;
  for (std::size_t p = 0; p < index.size(); ++p)
  {
    all += whole.Counts(p);
    if (index[p] >= 0)
    {
      (whole.Counts(p) ? counted : others).push_back(whole.Ids[p]);
      part.Piece.Roles.push_back(whole.Roles[p]);
    }
  }
  // Of points in contact all ranks know the numbers in the whole.
  std::vector<int> ends;
  for (const std::array<int, 2>& pair : surface.Contacts)
  {
    std::copy_if(pair.begin(), pair.end(), std::back_inserter(ends),
      [&counted](int id) { return std::binary_search(counted.begin(), counted.end(), id); });
  }
  ends = GatherListsOnAll(ranks, ends);
  std::sort(ends.begin(), ends.end());
  others.insert(others.end(), ends.begin(), ends.end());
  const VertexNumbers numbers =
    NumberOnRanks(ranks, SumOfRanks(ranks, all), [](int) { return 0; }, counted, others);
  for (std::size_t p = 0; p < index.size(); ++p)
  {
    if (index[p] >= 0)
    {
      part.Piece.Ids.push_back(numbers.Of[whole.Ids[p]].Point);
    }
  }
  for (const std::array<int, 2>& pair : surface.Contacts)
  {
    if (std::all_of(pair.begin(), pair.end(),
          [&ends](int id) { return std::binary_search(ends.begin(), ends.end(), id); }))
    {
      part.Contacts.push_back({ numbers.Of[pair[0]].Point, numbers.Of[pair[1]].Point });
    }
  }
  part.Piece.Ranks = whole.Ranks;
  const std::vector<std::size_t> triangles = GatherValues(ranks, part.Triangles.size());
  part.Piece.FirstTriangle = static_cast<int>(
    std::accumulate(triangles.begin(), triangles.begin() + ranks.Rank(), std::size_t(0)));
}
}

SurfaceResult PartOf(const SurfaceResult& surface, const SurfaceFeatures& features,
  const std::vector<bool>& isKept)
{
  SurfaceResult part;
  part.Delta = surface.Delta;
  part.FitToTolerance = surface.FitToTolerance;
  LargeVector<int> index(surface.Points.size(), -1);
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    if (isKept[features.ComponentOfTriangle[t]])
    {
      part.Triangles.push_back(surface.Triangles[t]);
      for (const int corner : surface.Triangles[t])
      {
        index[corner] = 0;
      }
    }
  }
  for (std::size_t p = 0; p < surface.Points.size(); ++p)
  {
    if (index[p] == 0)
    {
      index[p] = static_cast<int>(part.Points.size());
      part.Points.push_back(surface.Points[p]);
      part.Normals.push_back(surface.Normals[p]);
      part.Residual.push_back(surface.Residual[p]);
      part.Motionless.push_back(surface.Motionless[p]);
      part.Held.push_back(surface.Held[p]);
      if (!surface.Size.empty())
      {
        part.Size.push_back(surface.Size[p]);
      }
      if (!surface.Thickness.empty())
      {
        part.Thickness.push_back(surface.Thickness[p]);
      }
    }
  }
  if (!surface.Piece.IsWhole())
  {
    NumberKept(surface, index, part);
  }
  else
  {
    for (const std::array<int, 2>& pair : surface.Contacts)
    {
      if (index[pair[0]] >= 0 && index[pair[1]] >= 0)
      {
        part.Contacts.push_back({ index[pair[0]], index[pair[1]] });
      }
    }
  }
  for (Triangle& triangle : part.Triangles)
  {
    for (int& corner : triangle)
    {
      corner = index[corner];
    }
  }
  return part;
}
}
