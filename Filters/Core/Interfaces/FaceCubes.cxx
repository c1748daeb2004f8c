// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/FaceCubes.h"

#include "Core/Common/Sort.h"
#include "Core/Common/Spans.h"

#include <algorithm>
#include <cstdint>
#include <tuple>

namespace volumic
{
namespace
{
/** Faces that a thread looks at at a time. */
constexpr std::size_t SpanSize = 4096;
/** Bits of a cube's number along an axis. */
constexpr int Bits = 20;
constexpr std::uint64_t Last = (std::uint64_t(1) << Bits) - 1;

/** A cube and one of its faces. */
struct Place
{
  std::uint64_t Colour; ///< its parities
  std::uint64_t Cube;   ///< its numbers along the axes
  int Face;

  bool operator<(const Place& other) const
  {
    return std::tie(this->Colour, this->Cube, this->Face) <
      std::tie(other.Colour, other.Cube, other.Face);
  }
};

Place PlaceOf(const Vector& fromLow, float side, int face)
{
  Place place = { 0, 0, face };
  for (const float length : { fromLow.Z, fromLow.Y, fromLow.X })
  {
    const auto number = std::min(Last, static_cast<std::uint64_t>(std::max(0.f, length / side)));
    place.Colour = place.Colour << 1 | (number & 1);
    place.Cube = place.Cube << Bits | number;
  }
  return place;
}

TriangleBox BoxOf(std::uint64_t cube, const Vector& low, float side)
{
  const auto along = [&](int axis)
  { return side * static_cast<float>(cube >> (Bits * axis) & Last); };
  TriangleBox box;
  box.Low = low + Vector(along(0), along(1), along(2));
  box.High = box.Low + Vector(side, side, side);
  return box;
}
}

FaceCubes::FaceCubes(const InterfaceMesh& mesh, const InterfaceClearance& clearance, float side,
  Executor& executor)
{
  const Vector low = clearance.Bounds().Low;
  std::vector<std::vector<Place>> ofSpans((mesh.Faces.size() + SpanSize - 1) / SpanSize);
  ForSpans(executor, mesh.Faces.size(), SpanSize,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      for (std::size_t f = begin; f < end; ++f)
      {
        if (mesh.Faces[f].IsThere())
        {
          const int face = static_cast<int>(f);
          ofSpans[span].push_back(PlaceOf(clearance.BoxOf(face).Middle() - low, side, face));
        }
      }
    });
  std::vector<Place> places = Joined(executor, ofSpans);
  Sort(executor, places);
  this->Faces.reserve(places.size());
  for (std::size_t n = 0; n < places.size(); ++n)
  {
    std::vector<Cube>& cubes = this->OfColour[places[n].Colour];
    if (n == 0 || places[n].Cube != places[n - 1].Cube)
    {
      cubes.push_back({ BoxOf(places[n].Cube, low, side), n, n });
    }
    ++cubes.back().Last;
    this->Faces.push_back(places[n].Face);
  }
}
}
