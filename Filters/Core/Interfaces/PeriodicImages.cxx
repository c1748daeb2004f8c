// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Functions of InterfaceMesh for the opposite sides of a periodic box.

#include "Core/Interfaces/InterfaceMesh.h"

#include <map>
#include <stdexcept>

namespace volumic
{
namespace
{
using Coordinates = std::array<float, 3>;

Coordinates CoordinatesOf(const Vector& coordinates)
{
  return { coordinates.X, coordinates.Y, coordinates.Z };
}
}

void InterfaceMesh::JoinImages(const std::vector<int>& images)
{
  for (std::size_t n = 0; n < images.size(); ++n)
  {
    this->NextImage[static_cast<std::size_t>(images[n])] = images[(n + 1) % images.size()];
  }
}

void InterfaceMesh::MatchSides()
{
  std::map<Coordinates, std::vector<int>> found; // keyed by the position moved to the first sides
  for (std::size_t v = 0; v < this->Position.size(); ++v)
  {
    Coordinates coordinates = CoordinatesOf(this->Position[v]);
    bool isOnSide = false;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      const float first = this->Planes[2 * axis];
      const float last = this->Planes[2 * axis + 1];
      isOnSide = isOnSide || coordinates[axis] == first || coordinates[axis] == last;
      coordinates[axis] = coordinates[axis] == last ? first : coordinates[axis];
    }
    if (isOnSide)
    {
      found[coordinates].push_back(static_cast<int>(v));
    }
  }
  for (const auto& [coordinates, images] : found)
  {
    std::size_t requested = 1;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      requested *= coordinates[axis] == this->Planes[2 * axis] ? 2 : 1;
    }
    if (images.size() != requested)
    {
      throw std::logic_error("opposite sides of a periodic box do not match");
    }
    this->JoinImages(images);
  }
}

int InterfaceMesh::NumberOfImages(int v) const
{
  int count = 1;
  for (int w = this->NextImage[static_cast<std::size_t>(v)]; w != v;
       w = this->NextImage[static_cast<std::size_t>(w)])
  {
    ++count;
  }
  return count;
}

void InterfaceMesh::FindImages(int u, int v, std::vector<std::array<int, 2>>& images) const
{
  images.assign(1, { u, v });
  if (!this->HasImages(u) || !this->HasImages(v))
  {
    return;
  }
  std::array<bool, 3> isInSide = { false, false, false };
  this->ForFaces(u,
    [&](int f)
    {
      const Face& face = this->Faces[static_cast<std::size_t>(f)];
      if (face.Has(v) && this->IsSide(face.Front))
      {
        isInSide[static_cast<std::size_t>(this->AxisOf(face.Front))] = true;
      }
    });
  const auto at = [this](int w)
  { return CoordinatesOf(this->Position[static_cast<std::size_t>(w)]); };
  const auto next = [this](int w) { return this->NextImage[static_cast<std::size_t>(w)]; };
  for (int p = next(u); p != u; p = next(p))
  {
    for (int q = next(v); q != v; q = next(q))
    {
      bool isImage = true;
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        isImage = isImage &&
          (isInSide[axis] ? at(p)[axis] == at(q)[axis]
                          : at(p)[axis] == at(u)[axis] && at(q)[axis] == at(v)[axis]);
      }
      if (isImage)
      {
        images.push_back({ p, q });
      }
    }
  }
}
}
