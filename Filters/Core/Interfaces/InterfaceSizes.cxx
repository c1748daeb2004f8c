// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceSizes.h"

#include "Core/Common/Box.h"
#include "Core/Common/Spans.h"
#include "Core/Image/DistanceToZero.h"
#include "Core/Mesh/LimitedSizes.h"
#include "Core/Mesh/VertexGrid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace volumic
{
namespace
{
constexpr std::size_t SpanSize = 1024;
/** Share of the tolerance that is aimed at: steps move vertices along the interfaces. */
constexpr float AimedShare = 0.8f;
/** The least factor of a change, so that an edge is split into two or three. */
constexpr float LeastChange = 0.57735f;
/** Where fields differ less from place to place nothing is said by how much. */
constexpr float LeastSlope = 0.3f;
/** How far an interface is looked for, in smallest distances of voxels or tolerances. */
constexpr float Furthest = 2.f;
constexpr float FurthestInTolerances = 3.f;

/** How far a face's interface is, negative on the side of the object behind it. */
class FaceDistances
{
public:
  FaceDistances(const InterfaceMesh& mesh, const InterfaceFields& fields, double tolerance,
    const InterfaceMesh::Face& face)
    : Fields(fields), Of(face), IsOnSide(mesh.IsSide(face.Front)),
      Near(static_cast<float>(tolerance)), Normal(Normalized(mesh.NormalOf(face)))
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      this->Corner[k] = mesh.Position[static_cast<std::size_t>(face.Vertex[k])];
    }
  }

  /** At its corners. */
  std::array<float, 3> AtCorners() const
  {
    return { this->At(this->Corner[0]), this->At(this->Corner[1]), this->At(this->Corner[2]) };
  }
  /** At the middles of its edges, each from the corner of its number on, and at its own. */
  std::array<float, 4> AtMiddles() const
  {
    const auto& c = this->Corner;
    return { this->At((c[0] + c[1]) * 0.5f), this->At((c[1] + c[2]) * 0.5f),
      this->At((c[2] + c[0]) * 0.5f), this->At((c[0] + c[1] + c[2]) * (1.f / 3.f)) };
  }

private:
  float At(const Vector& place) const
  {
    if (this->IsOnSide)
    {
      return 0.f;
    }
    const auto sample = this->Fields.Between(this->Of.Behind, this->Of.Front, place);
    const float near = sample.Value / std::max(Length(sample.Gradient), LeastSlope);
    return std::abs(near) <= this->Near
      ? -near
      : SignedDistanceToZero(place, this->Normal, sample.Value,
          std::max(Furthest, FurthestInTolerances * this->Near),
          [this](const Vector& at)
          { return this->Fields.Between(this->Of.Behind, this->Of.Front, at).Value; });
  }

  const InterfaceFields& Fields;
  const InterfaceMesh::Face& Of;
  const bool IsOnSide; ///< of a box
  const float Near;    ///< Distances up to this are told from values and slopes.
  const Vector Normal;
  std::array<Vector, 3> Corner;
};

/** Of each vertex by how far what is about it would be off if its corners were not. */
LargeVector<float> FindSags(
  const InterfaceMesh& mesh, const InterfaceFields& fields, double tolerance, Executor& executor)
{
  std::vector<std::array<float, 4>> ofFaces(mesh.Faces.size());
  ForSpans(executor, ofFaces.size(), SpanSize,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t f = begin; f < end; ++f)
      {
        const FaceDistances distances(mesh, fields, tolerance, mesh.Faces[f]);
        const std::array<float, 3> off = distances.AtCorners();
        const std::array<float, 4> there = distances.AtMiddles();
        for (std::size_t k = 0; k < 3; ++k)
        {
          ofFaces[f][k] = std::abs(there[k] - 0.5f * (off[k] + off[(k + 1) % 3]));
        }
        ofFaces[f][3] = std::abs(there[3] - (off[0] + off[1] + off[2]) * (1.f / 3.f));
      }
    });
  LargeVector<float> sags(mesh.Size.size(), 0.f);
  ForSpans(executor, sags.size(), SpanSize,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        mesh.ForFaces(static_cast<int>(v),
          [&](int face)
          {
            const auto f = static_cast<std::size_t>(face);
            const std::array<int, 3>& corners = mesh.Faces[f].Vertex;
            const auto at = static_cast<std::size_t>(
              std::find(corners.begin(), corners.end(), static_cast<int>(v)) - corners.begin());
            // Of the edges those that begin and end at it.
            sags[v] =
              std::max({ sags[v], ofFaces[f][at], ofFaces[f][(at + 2) % 3], ofFaces[f][3] });
          });
      }
    });
  return sags;
}

/** The vertices at their places. */
void LayGrid(VertexGrid& grid, const LargeVector<Vector>& places, float cell, Executor& executor)
{
  Box box = { places.front(), places.front() };
  for (const Vector& p : places)
  {
    box = box.With({ p, p });
  }
  grid.Reset(box.Low, box.High, cell);
  grid.InsertAll(
    places, 0, [](int) { return true; }, executor);
}
}

void AdjustSizes(
  InterfaceMesh& mesh, const InterfaceFields& fields, const SizeBounds& bounds, Executor& executor)
{
  if (mesh.Position.empty())
  {
    return;
  }
  const float aimed = AimedShare * static_cast<float>(bounds.Tolerance);
  const float growth = static_cast<float>(bounds.Growth);
  LargeVector<float> sizes = FindSags(mesh, fields, bounds.Tolerance, executor);
  for (std::size_t v = 0; v < sizes.size(); ++v)
  {
    const float change = sizes[v] > 0.f ? std::sqrt(aimed / sizes[v]) : growth;
    sizes[v] = std::clamp(
      mesh.Size[v] * std::clamp(change, LeastChange, growth), 1.f, static_cast<float>(bounds.Most));
  }
  VertexGrid grid;
  LayGrid(grid, mesh.Position, static_cast<float>(mesh.MeanEdge()), executor);
  mesh.Size =
    LimitedSizes(sizes, mesh.Position, grid, 1.f, static_cast<float>(bounds.Gradation), executor);
  for (std::size_t v = 0; v < sizes.size(); ++v)
  {
    // Round its ring it meets the least one, and so has each.
    for (int w = mesh.NextImage[v]; w != static_cast<int>(v);
         w = mesh.NextImage[static_cast<std::size_t>(w)])
    {
      mesh.Size[v] = std::min(mesh.Size[v], mesh.Size[static_cast<std::size_t>(w)]);
    }
  }
}

Fit MeasureFit(const InterfaceMesh& mesh, const InterfaceFields& fields,
  const std::vector<int>& faces, double tolerance)
{
  Fit fit;
  std::size_t within = 0;
  std::size_t all = 0;
  for (const int f : faces)
  {
    const FaceDistances distances(mesh, fields, tolerance, mesh.Faces[static_cast<std::size_t>(f)]);
    for (const float distance : distances.AtMiddles())
    {
      fit.LargestDistance = std::max(fit.LargestDistance, static_cast<double>(std::abs(distance)));
      within += std::abs(distance) <= static_cast<float>(tolerance) ? 1 : 0;
      ++all;
    }
  }
  fit.WithinTolerance = all > 0 ? static_cast<double>(within) / static_cast<double>(all) : 1.;
  return fit;
}
}
