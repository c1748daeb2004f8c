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
/** Target error relative to the tolerance, as later steps move vertices along the interfaces. */
constexpr float AimedFraction = 0.8f;
/** Least factor of a size change (1 / sqrt(3)): an edge is split into two or three. */
constexpr float LeastChange = 0.57735f;
/** Lower bound of the slope of half the field difference. */
constexpr float LeastSlope = 0.3f;
/** Search distance for an interface, in the smallest voxel spacing and in tolerances. */
constexpr float Furthest = 2.f;
constexpr float FurthestInTolerances = 3.f;

/** Signed distances from a face to its interface, negative on the side of the object behind. */
class FaceDistances
{
public:
  FaceDistances(const InterfaceMesh& mesh, const InterfaceFields& fields, double tolerance,
    const InterfaceMesh::Face& face)
    : Fields(fields), OwnFace(face), IsOnSide(mesh.IsSide(face.Front)),
      Near(static_cast<float>(tolerance)), Normal(Normalized(mesh.NormalOf(face)))
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      this->Corner[k] = mesh.Position[static_cast<std::size_t>(face.Vertex[k])];
    }
  }

  std::array<float, 3> AtCorners() const
  {
    return { this->At(this->Corner[0]), this->At(this->Corner[1]), this->At(this->Corner[2]) };
  }
  /** Return the distances at the middles of the edges (0-1, 1-2, 2-0) and at the face centre. */
  std::array<float, 4> AtMiddles() const
  {
    const auto& c = this->Corner;
    return { this->At((c[0] + c[1]) * 0.5f), this->At((c[1] + c[2]) * 0.5f),
      this->At((c[2] + c[0]) * 0.5f), this->At((c[0] + c[1] + c[2]) * (1.f / 3.f)) };
  }

private:
  float At(const Vector& position) const
  {
    if (this->IsOnSide)
    {
      return 0.f;
    }
    const auto sample = this->Fields.Between(this->OwnFace.Behind, this->OwnFace.Front, position);
    const float near = sample.Value / std::max(Length(sample.Gradient), LeastSlope);
    return std::abs(near) <= this->Near
      ? -near
      : SignedDistanceToZero(position, this->Normal, sample.Value,
          std::max(Furthest, FurthestInTolerances * this->Near),
          [this](const Vector& at)
          { return this->Fields.Between(this->OwnFace.Behind, this->OwnFace.Front, at).Value; });
  }

  const InterfaceFields& Fields;
  const InterfaceMesh::Face& OwnFace;
  const bool IsOnSide; ///< Whether the face is on a side of the box.
  const float Near;    ///< Smaller distances are estimated from the value and the slope.
  const Vector Normal;
  std::array<Vector, 3> Corner;
};

/** Return the maximum sag (chord error) of the edges and faces at each vertex. */
LargeVector<float> FindSags(
  const InterfaceMesh& mesh, const InterfaceFields& fields, double tolerance, Executor& executor)
{
  std::vector<std::array<float, 4>> perFace(mesh.Faces.size());
  ForSpans(executor, perFace.size(), SpanSize,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t f = begin; f < end; ++f)
      {
        const FaceDistances distances(mesh, fields, tolerance, mesh.Faces[f]);
        const std::array<float, 3> atCorners = distances.AtCorners();
        const std::array<float, 4> atMiddles = distances.AtMiddles();
        for (std::size_t k = 0; k < 3; ++k)
        {
          perFace[f][k] = std::abs(atMiddles[k] - 0.5f * (atCorners[k] + atCorners[(k + 1) % 3]));
        }
        perFace[f][3] =
          std::abs(atMiddles[3] - (atCorners[0] + atCorners[1] + atCorners[2]) * (1.f / 3.f));
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
            // Both edges at the vertex, and the face.
            sags[v] =
              std::max({ sags[v], perFace[f][at], perFace[f][(at + 2) % 3], perFace[f][3] });
          });
      }
    });
  return sags;
}

void FillGrid(
  VertexGrid& grid, const LargeVector<Vector>& positions, float cell, Executor& executor)
{
  Box box = { positions.front(), positions.front() };
  for (const Vector& p : positions)
  {
    box = box.With({ p, p });
  }
  grid.Reset(box.Low, box.High, cell);
  grid.InsertAll(
    positions, 0, [](int) { return true; }, executor);
}
}

void AdjustSizes(
  InterfaceMesh& mesh, const InterfaceFields& fields, const SizeBounds& bounds, Executor& executor)
{
  if (mesh.Position.empty())
  {
    return;
  }
  const float aimed = AimedFraction * static_cast<float>(bounds.Tolerance);
  const float growth = static_cast<float>(bounds.Growth);
  LargeVector<float> sizes = FindSags(mesh, fields, bounds.Tolerance, executor);
  for (std::size_t v = 0; v < sizes.size(); ++v)
  {
    const float change = sizes[v] > 0.f ? std::sqrt(aimed / sizes[v]) : growth;
    sizes[v] = std::clamp(
      mesh.Size[v] * std::clamp(change, LeastChange, growth), 1.f, static_cast<float>(bounds.Most));
  }
  VertexGrid grid;
  FillGrid(grid, mesh.Position, static_cast<float>(mesh.MeanEdge()), executor);
  mesh.Size =
    LimitedSizes(sizes, mesh.Position, grid, 1.f, static_cast<float>(bounds.Gradation), executor);
  for (std::size_t v = 0; v < sizes.size(); ++v)
  {
    // All images get the smallest of their sizes.
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
