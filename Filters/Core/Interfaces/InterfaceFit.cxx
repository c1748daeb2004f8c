// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceFit.h"

#include "Core/Common/Spans.h"
#include "Core/Interfaces/MismatchedVoxels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace volumic
{
namespace
{
constexpr int VolumeSweeps = 400; ///< damped Jacobi iterations
/** Change of the fields at a misclassified voxel, in the smallest voxel spacing. */
constexpr float PushOfMisclassified = 0.25f;

/** Regularization: if objects fill a box, only the differences of shifts are determined. */
constexpr double PullToZero = 1e-3;
/** Smaller objects are not included in the returned volume error. */
constexpr std::int64_t LeastVoxels = 8;

/** Lower bound of the slope of half the field difference. */
constexpr double LeastSlope = 0.3;
constexpr std::size_t SpanSize = 4096;

/** Return the slope of half the difference of the two fields of a face, at its centre. */
double SlopeAt(
  const InterfaceMesh& mesh, const InterfaceFields& fields, const InterfaceMesh::Face& face)
{
  Vector middle;
  for (const int v : face.Vertex)
  {
    middle += mesh.Position[static_cast<std::size_t>(v)] * (1.f / 3.f);
  }
  return Length(fields.Between(face.Behind, face.Front, middle).Gradient);
}

/** Sums over the faces between two objects. */
struct FaceSums
{
  double Volume = 0.; ///< signed volume between the faces and the origin
  double Area = 0.;   ///< area of each face divided by its slope (SlopeAt)
};
/** Keyed by the object behind and the object in front. */
using SumsOfPairs = std::map<std::array<std::size_t, 2>, FaceSums>;

SumsOfPairs SumFaces(const InterfaceMesh& mesh, const InterfaceFields& fields, Executor& executor)
{
  std::vector<SumsOfPairs> perSpan((mesh.Faces.size() + SpanSize - 1) / SpanSize);
  ForSpans(executor, mesh.Faces.size(), SpanSize,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      for (std::size_t f = begin; f < end; ++f)
      {
        const InterfaceMesh::Face& face = mesh.Faces[f];
        if (!face.IsThere())
        {
          continue;
        }
        FaceSums& sums = perSpan[span][{ face.Behind, face.Front }];
        const VectorD across = mesh.NormalOf(face);
        sums.Volume +=
          Dot(across, VectorD(mesh.Position[static_cast<std::size_t>(face.Vertex[0])])) / 6.;
        if (!mesh.IsSide(face.Front))
        {
          sums.Area += 0.5 * Length(across) / std::max(SlopeAt(mesh, fields, face), LeastSlope);
        }
      }
    });
  SumsOfPairs all;
  for (const SumsOfPairs& some : perSpan)
  {
    for (const auto& [objects, sums] : some)
    {
      all[objects].Volume += sums.Volume;
      all[objects].Area += sums.Area;
    }
  }
  return all;
}

}

double CorrectVolumes(
  const InterfaceMesh& mesh, InterfaceFields& fields, double tolerance, Executor& executor)
{
  const LabelBricks& bricks = fields.Bricks();
  const auto count = static_cast<std::size_t>(bricks.Map().NumberOfObjects) + 1;
  const std::array<double, 3>& step = fields.Step();
  const double voxelVolume = step[0] * step[1] * step[2];
  std::vector<double> missing(count, 0.);
  for (std::size_t object = 1; object < count; ++object)
  {
    missing[object] =
      voxelVolume * static_cast<double>(bricks.ExtentOf(static_cast<int>(object)).Voxels);
  }
  std::map<std::array<std::size_t, 2>, double> areas;
  for (const auto& [objects, sums] : SumFaces(mesh, fields, executor))
  {
    missing[objects[0]] -= sums.Volume;
    if (!mesh.IsSide(static_cast<int>(objects[1]))) // Sides are fixed.
    {
      missing[objects[1]] += sums.Volume;
      areas[objects] = sums.Area;
    }
  }
  double worst = 0.;
  for (std::size_t object = 1; object < count; ++object)
  {
    const std::int64_t voxels = bricks.ExtentOf(static_cast<int>(object)).Voxels;
    if (voxels >= LeastVoxels)
    {
      worst =
        std::max(worst, std::abs(missing[object]) / (voxelVolume * static_cast<double>(voxels)));
    }
  }
  std::vector<double> shifts(count, 0.);
  std::vector<double> sums(count);
  std::vector<double> weights(count);
  for (int sweep = 0; sweep < VolumeSweeps; ++sweep)
  {
    sums = missing;
    std::fill(weights.begin(), weights.end(), 0.);
    for (const auto& pair : areas)
    {
      const std::size_t a = pair.first[0];
      const std::size_t b = pair.first[1];
      const double area = 0.5 * pair.second;
      sums[a] += area * shifts[b];
      sums[b] += area * shifts[a];
      weights[a] += area;
      weights[b] += area;
    }
    for (std::size_t object = 1; object < count; ++object)
    {
      // Damping by 1/2: otherwise the shifts of two objects with one interface oscillate.
      const double weight = weights[object] * (1. + PullToZero);
      shifts[object] += 0.5 * (weight > 0. ? sums[object] / weight - shifts[object] : 0.);
    }
  }
  for (std::size_t object = 1; object < count; ++object)
  {
    fields.Shift(
      static_cast<int>(object), static_cast<float>(shifts[object]), static_cast<float>(tolerance));
  }
  return worst;
}

std::size_t PushMisclassifiedVoxels(
  const InterfaceMesh& mesh, InterfaceFields& fields, double tolerance, Executor& executor)
{
  std::size_t count = 0;
  for (const MismatchedVoxel& voxel : FindMismatchedVoxels(
         mesh, fields.Bricks().Map(), fields.Bricks().Inside(), fields.Step(), tolerance, executor))
  {
    if (voxel.IsFar)
    {
      fields.Push(voxel.MapObject, voxel.At, PushOfMisclassified);
      fields.Push(voxel.MeshObject, voxel.At, PushOfMisclassified);
      ++count;
    }
  }
  return count;
}
}
