// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/EdgesToKeep.h"

#include "Core/Common/RankLists.h"
#include "Core/Common/Select.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace volumic
{
void EdgesToKeep::FindOwn(int centre, std::vector<NumberedFace>& found) const
{
  // That of the last vertex whose faces do not begin behind it, if that has one.
  int face = centre - this->Piece.Mesh.Size();
  const std::vector<int>& own = this->Piece.Own;
  const auto behind = std::upper_bound(own.begin(), own.end(), face,
    [this](int number, int v) { return number < this->Numbers.FirstFace[v]; });
  if (behind == own.begin())
  {
    return;
  }
  const auto v = static_cast<std::size_t>(*(behind - 1));
  face -= this->Numbers.FirstFace[v];
  this->Piece.Mesh.VisitFaces(v, v + 1,
    [&](int a, int b, int c)
    {
      if (face-- == 0)
      {
        found.push_back({ centre, { a, b, c } });
      }
    });
}

std::map<int, EdgesToKeep::Face> EdgesToKeep::FindFaces(
  const std::vector<Proximity::FacePair>& pairs) const
{
  std::vector<int> centres;
  for (const Proximity::FacePair& pair : pairs)
  {
    for (const auto& face : { pair.First, pair.Second })
    {
      std::copy_if(face.begin(), face.end(), std::back_inserter(centres),
        [this](int v) { return this->IsCentre(v); });
    }
  }
  SortUnique(centres);
  std::vector<NumberedFace> own;
  for (const int centre : centres)
  {
    this->FindOwn(centre, own);
  }
  std::map<int, Face> faces;
  for (const NumberedFace& face : GatherListsOnAll(this->Ranks, own))
  {
    faces[face.Number] = face.Corners;
  }
  return faces;
}

std::vector<int> EdgesToKeep::KeepAllAt(const std::vector<int>& vertices)
{
  std::vector<std::array<int, 2>> own;
  for (const int v : vertices)
  {
    if (std::binary_search(this->Piece.Own.begin(), this->Piece.Own.end(), v))
    {
      const Ring& ring = this->Piece.Mesh.Rings[v];
      std::for_each(ring.Item, ring.Item + ring.Count, [&](int w) { own.push_back({ v, w }); });
    }
  }
  std::vector<int> ends;
  for (const std::array<int, 2>& edge : GatherListsOnAll(this->Ranks, own))
  {
    this->Kept.Keep(edge[0], edge[1]);
    ends.push_back(edge[1]);
  }
  return ends;
}

void EdgesToKeep::KeepAbout(const std::vector<Proximity::FacePair>& pairs, int round)
{
  const std::map<int, Face> faces = this->FindFaces(pairs);
  std::vector<int> about;
  const auto keepOf = [&](const Face& face)
  {
    for (int k = 0; k < 3; ++k)
    {
      if (!this->IsCentre(face[k]))
      {
        continue;
      }
      const Face& own = faces.at(face[k]);
      about.insert(about.end(), own.begin(), own.end());
      const int next = face[(k + 1) % 3];
      if (this->IsCentre(next))
      {
        const Face& other = faces.at(next);
        const auto has = [&other](int v)
        { return std::find(other.begin(), other.end(), v) != other.end(); };
        for (int i = 0; i < 3; ++i)
        {
          if (has(own[i]) && has(own[(i + 1) % 3]))
          {
            this->Kept.Keep(own[i], own[(i + 1) % 3]);
          }
        }
      }
    }
  };
  for (const Proximity::FacePair& pair : pairs)
  {
    keepOf(pair.First);
    keepOf(pair.Second);
  }
  for (int ring = 0; ring < round; ++ring)
  {
    SortUnique(about);
    const std::vector<int> ends = this->KeepAllAt(about);
    about.insert(about.end(), ends.begin(), ends.end());
  }
  if (round == Rounds - 1)
  {
    this->Kept.KeepAll();
  }
  const auto findOverfull = [this]
  { return GatherListsOnAll(this->Ranks, this->Kept.FindOverfull(this->Piece.Own)); };
  for (auto full = findOverfull(); !full.empty(); full = findOverfull())
  {
    this->KeepAllAt(full);
  }
}
}
