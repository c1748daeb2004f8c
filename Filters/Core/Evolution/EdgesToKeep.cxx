// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/EdgesToKeep.h"

#include "Core/Common/Select.h"

#include <algorithm>
#include <cstddef>

namespace volumic
{
EdgesToKeep::Face EdgesToKeep::FaceOf(int centre) const
{
  // Of the last vertex whose faces do not begin behind it.
  int number = centre - this->Mesh.Size();
  const LargeVector<int>& first = this->Numbers.FirstFace;
  const auto behind = std::upper_bound(first.begin(), first.end(), number);
  const auto v = static_cast<std::size_t>(behind - first.begin() - 1);
  number -= first[v];
  Face found{};
  this->Mesh.VisitFaces(v, v + 1,
    [&](int a, int b, int c)
    {
      if (number-- == 0)
      {
        found = { a, b, c };
      }
    });
  return found;
}

std::vector<int> EdgesToKeep::KeepOf(const Face& face)
{
  std::vector<int> corners;
  for (int k = 0; k < 3; ++k)
  {
    if (!this->IsCentre(face[k]))
    {
      continue;
    }
    const Face own = this->FaceOf(face[k]);
    corners.insert(corners.end(), own.begin(), own.end());
    const int next = face[(k + 1) % 3];
    if (this->IsCentre(next))
    {
      const Face other = this->FaceOf(next);
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
  return corners;
}

void EdgesToKeep::KeepAbout(const std::vector<Proximity::FacePair>& pairs, int round)
{
  std::vector<int> about;
  for (const Proximity::FacePair& pair : pairs)
  {
    for (const Face& face : { pair.First, pair.Second })
    {
      const std::vector<int> corners = this->KeepOf(face);
      about.insert(about.end(), corners.begin(), corners.end());
    }
  }
  for (int ring = 0; ring < round; ++ring)
  {
    SortUnique(about);
    const std::size_t count = about.size();
    for (std::size_t i = 0; i < count; ++i)
    {
      this->Kept.KeepAllAt(about[i]);
      const Ring& neighbours = this->Mesh.Rings[about[i]];
      about.insert(about.end(), neighbours.Item, neighbours.Item + neighbours.Count);
    }
  }
  if (round == Rounds - 1)
  {
    this->Kept.KeepAll();
  }
  for (auto full = this->Kept.FindOverfull(); !full.empty(); full = this->Kept.FindOverfull())
  {
    for (const int v : full)
    {
      this->Kept.KeepAllAt(v);
    }
  }
}
}
