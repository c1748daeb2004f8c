// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/CellSurface.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace volumic
{
namespace
{
using Offset = std::array<int, 3>;

/** A face of the cell about the origin, counter-clockwise seen from outside. */
struct Face
{
  Offset Neighbour; ///< Indices of the cell beyond it, relative.
  std::vector<Offset> Corners;
};

std::vector<Face> MakeFaces()
{
  std::vector<Face> faces;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int side : { 1, -1 })
    {
      Face face;
      face.Neighbour = { 0, 0, 0 };
      face.Neighbour[axis] = 2 * side;
      const int square[4][2] = { { 1, 0 }, { 0, 1 }, { -1, 0 }, { 0, -1 } };
      for (const auto& c : square)
      {
        Offset corner;
        corner[axis] = 2 * side;
        corner[(axis + 1) % 3] = c[0];
        corner[(axis + 2) % 3] = side * c[1];
        face.Corners.push_back(corner);
      }
      faces.push_back(face);
    }
  }
  for (int octant = 0; octant < 8; ++octant)
  {
    const Offset sign = { octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1 };
    Face face;
    face.Neighbour = sign;
    face.Corners = { { 2, 1, 0 }, { 1, 2, 0 }, { 0, 2, 1 }, { 0, 1, 2 }, { 1, 0, 2 }, { 2, 0, 1 } };
    for (Offset& corner : face.Corners)
    {
      for (int k = 0; k < 3; ++k)
      {
        corner[k] *= sign[k];
      }
    }
    if (sign[0] * sign[1] * sign[2] < 0)
    {
      std::reverse(face.Corners.begin(), face.Corners.end());
    }
    faces.push_back(face);
  }
  return faces;
}

const std::vector<Face>& Faces()
{
  static const std::vector<Face> faces = MakeFaces();
  return faces;
}

/** The nearest of the numbers 2 k + parity. */
int Nearest(double x, int parity)
{
  return 2 * static_cast<int>(std::lround(0.5 * (x - parity))) + parity;
}
}

CellLattice::CellLattice(double edge) : Scale(edge / std::sqrt(2.)) {}

CellLattice::Cell CellLattice::CellAt(const Point& place) const
{
  Cell best{};
  double nearest = -1.;
  for (int parity : { 0, 1 })
  {
    Cell cell;
    double squared = 0.;
    for (int k = 0; k < 3; ++k)
    {
      const double x = place[k] / (2. * this->Scale);
      cell[k] = Nearest(x, parity);
      squared += (x - cell[k]) * (x - cell[k]);
    }
    if (nearest < 0. || squared < nearest)
    {
      nearest = squared;
      best = cell;
    }
  }
  return best;
}

Point CellLattice::Centre(const Cell& cell) const
{
  return { 2. * this->Scale * cell[0], 2. * this->Scale * cell[1], 2. * this->Scale * cell[2] };
}

Point CellLattice::Corner(const Cell& cell, int index) const
{
  // The first six faces, the squares, have each corner once.
  const Offset& offset = Faces()[index / 4].Corners[index % 4];
  return { this->Scale * (2 * cell[0] + offset[0]), this->Scale * (2 * cell[1] + offset[1]),
    this->Scale * (2 * cell[2] + offset[2]) };
}

namespace
{
/** For each cell a bit for each of its faces, set where no cell of the set lies beyond it. */
std::vector<std::uint16_t> BareFaces(
  const std::vector<CellLattice::Cell>& cells, Executor& executor)
{
  constexpr std::size_t spanSize = 1024;
  const std::vector<Face>& faces = Faces();
  std::vector<std::uint16_t> bare(cells.size(), 0);
  ForSpans(executor, cells.size(), spanSize,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        for (std::size_t f = 0; f < faces.size(); ++f)
        {
          const CellLattice::Cell& cell = cells[i];
          const Offset& n = faces[f].Neighbour;
          const bool isBare = !std::binary_search(cells.begin(), cells.end(),
            CellLattice::Cell{ cell[0] + n[0], cell[1] + n[1], cell[2] + n[2] });
          bare[i] = static_cast<std::uint16_t>(bare[i] | (isBare ? 1u << f : 0u));
        }
      }
    });
  return bare;
}
}

IndexedSurface CellLattice::Boundary(const std::vector<Cell>& cells, Executor& executor) const
{
  IndexedSurface surface;
  std::unordered_map<std::uint64_t, int> places;
  const auto place = [&](const Cell& cell, const Offset& offset)
  {
    const Offset at = { 2 * cell[0] + offset[0], 2 * cell[1] + offset[1], 2 * cell[2] + offset[2] };
    const auto found = places.emplace(LatticeKey(at), static_cast<int>(surface.Points.size()));
    if (found.second)
    {
      surface.Points.push_back({ this->Scale * at[0], this->Scale * at[1], this->Scale * at[2] });
    }
    return found.first->second;
  };
  const std::vector<Face>& faces = Faces();
  const std::vector<std::uint16_t> bare = BareFaces(cells, executor);
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    const Cell& cell = cells[i];
    for (std::size_t f = 0; f < faces.size(); ++f)
    {
      if ((bare[i] >> f & 1u) == 0)
      {
        continue;
      }
      const Face& face = faces[f];
      int corner[6];
      const int count = static_cast<int>(face.Corners.size());
      for (int k = 0; k < count; ++k)
      {
        corner[k] = place(cell, face.Corners[k]);
      }
      if (count == 4)
      {
        surface.Triangles.push_back({ corner[0], corner[1], corner[2] });
        surface.Triangles.push_back({ corner[2], corner[3], corner[0] });
        continue;
      }
      const int centre = place(cell, face.Neighbour);
      for (int k = 0; k < count; ++k)
      {
        surface.Triangles.push_back({ centre, corner[k], corner[(k + 1) % count] });
      }
    }
  }
  return surface;
}
}
