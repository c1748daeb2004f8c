// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/MakeInterfaces.h"

#include "Core/Common/CancellableExecutor.h"
#include "Core/Interfaces/InterfaceFit.h"
#include "Core/Interfaces/InterfaceMotion.h"
#include "Core/Interfaces/InterfaceRemesher.h"
#include "Core/Interfaces/InterfaceSizes.h"
#include "Core/Interfaces/InterfaceStart.h"
#include "Core/Interfaces/NearDegenerateRegions.h"
#include "Core/Interfaces/TriangleShape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace volumic
{
namespace
{
/** Number of first rounds, in which short edges are collapsed. */
constexpr int Rounds = 2;
/**
 * Without a tolerance: minimum and maximum number of last rounds, which only split, flip and move.
 * They end when misclassified voxels are few (relative to the vertices) and volume errors small.
 */
constexpr int LeastLastRounds = 1;
constexpr int MostLastRounds = 6;
constexpr double FewMisclassified = 0.01;
constexpr double FairVolumeError = 0.005;
/** With a tolerance: maximum growth factor of the sizes in each of the last rounds. */
constexpr std::array<double, 3> Growths = { 2.5, 1.5, 1.1 };
/** First round in which vertices are near enough to the interfaces to correct the fields. */
constexpr int FirstFit = 1;
/** Passes of sliver removal at the end, as one pass may create new slivers. */
constexpr int LastSliverRounds = 3;
/** Steps of vertices per round; the first round has one, as it has more vertices. */
constexpr int Steps = 2;
/** Edge lengths below LeastCollapsed get StepsOfFine additional first steps. */
constexpr double LeastCollapsed = 1.25;
constexpr int StepsOfFine = 6;
/** Maximum length of each of these steps, relative to the shortest edge of the vertex. */
constexpr double FineStep = 0.2;
/** Lengths of edges that are split and collapsed, relative to the mean edge length. */
constexpr double LongestFactor = 4. / 3.;
constexpr double ShortestFactor = 4. / 5.;
/** The same for splits in the last rounds. */
constexpr double LongestLastFactor = 1.8;
constexpr double MostGrowth = 3.; ///< of the edge length in a round
/** Least length to which a step may shorten an edge, relative to the desired edge length. */
constexpr double LeastEdgeFactor = 0.5;
/** Distance below which triangles count as intersecting, relative to the desired edge length. */
constexpr double ToleranceOfEdge = 1e-3;
constexpr double StepRelaxation = 0.7; ///< see MoveInterfaces()

/** Maximum edge length of a small object, relative to the radius of a ball of the same volume. */
constexpr double EdgeInRadius = 0.8;
/** Least size: shorter edges would make the search near long edges slow. */
constexpr double LeastSize = 0.35;
/** Least edge length in computational space: sufficient for a single voxel. */
constexpr double LeastEdge = 0.48;

/** Shorten the edges of small objects, so that these are round and keep their volumes. */
void ShortenEdgesOfSmall(InterfaceMesh& mesh, const InterfaceFields& fields, double edge)
{
  const std::array<double, 3>& step = fields.Step();
  const double voxelVolume = step[0] * step[1] * step[2];
  for (const InterfaceMesh::Face& face : mesh.Faces)
  {
    for (const int object : { static_cast<int>(face.Behind), static_cast<int>(face.Front) })
    {
      if (object == 0 || mesh.IsSide(object))
      {
        continue;
      }
      const auto voxels = static_cast<double>(fields.Bricks().ExtentOf(object).Voxels);
      const double radius = std::cbrt(voxels * voxelVolume * 0.2387324); // 3 / (4 pi)
      const auto size =
        static_cast<float>(std::max({ EdgeInRadius * radius / edge, LeastEdge / edge, LeastSize }));
      for (const int v : face.Vertex)
      {
        float& vertexSize = mesh.Size[static_cast<std::size_t>(v)];
        vertexSize = size < 1.f ? std::min(vertexSize, size) : vertexSize;
      }
    }
  }
}

/** Make the edits of a round. @param hasCollapses if false, only very long edges are split */
void Edit(InterfaceMesh& mesh, double requested, bool hasCollapses, int sliverRounds,
  Executor& executor, const std::function<bool()>& shouldContinue)
{
  // Search cost grows with the squared edge length, so that lengths grow gradually.
  const double edge = std::min(requested, MostGrowth * mesh.MeanEdge());
  const double longest = (hasCollapses ? LongestFactor : LongestLastFactor) * edge;
  InterfaceRemesher remesher(
    mesh, ShortestFactor * edge, longest, ToleranceOfEdge * requested, executor, shouldContinue);
  remesher.SplitLongEdges();
  if (hasCollapses)
  {
    remesher.CollapseShortEdges();
  }
  remesher.FlipEdges();
  for (int n = 0; n < sliverRounds; ++n)
  {
    remesher.RemoveSlivers();
  }
}
/**
 * Run all rounds. @param fraction completed fraction
 * @throws OperationCancelled if cancelled; the mesh is then free of intersections
 */
void RunRounds(InterfaceMesh& mesh, InterfaceFields& fields, const InterfaceOptions& options,
  Executor& executor, double& fraction, const std::function<bool()>& shouldContinue)
{
  // The first round takes half of the time, as the initial mesh has many short edges.
  constexpr int all = 2 * (Rounds + LeastLastRounds);
  const bool isGraded = options.Tolerance > 0.;
  const int rounds = Rounds + (isGraded ? static_cast<int>(Growths.size()) : MostLastRounds);
  const double straightening =
    isGraded ? std::min(options.Tolerance, MostStraightening) : MostStraightening;
  const auto move = [&](int steps, double relaxation, double leastAngle)
  {
    MoveInterfaces(mesh, fields, steps, relaxation, LeastEdgeFactor * options.Edge,
      ToleranceOfEdge * options.Edge, leastAngle, executor, straightening);
  };
  mesh = StartInterfaces(fields, executor);
  ShortenEdgesOfSmall(mesh, fields, options.Edge);
  // Fine meshes have no short edges to collapse, so that moves must remove the staircase. The steps
  // are short, as vertices of faces that turn too far are moved back.
  for (int step = 0; step < StepsOfFine && options.Edge < LeastCollapsed; ++step)
  {
    MoveInterfaces(mesh, fields, 1, StepRelaxation, 0., ToleranceOfEdge * options.Edge, 0.,
      executor, straightening, FineStep);
  }
  std::size_t misclassified = 0;
  double worstVolume = 0.;
  for (int round = 0; round < rounds; ++round)
  {
    const bool hasFewMisclassified = static_cast<double>(misclassified) <=
      FewMisclassified * static_cast<double>(mesh.Position.size());
    const bool isLast = round >= Rounds;
    if (!isGraded && round >= Rounds + LeastLastRounds && hasFewMisclassified &&
      worstVolume < FairVolumeError)
    {
      break;
    }
    if (isGraded && isLast)
    {
      AdjustSizes(mesh, fields,
        { options.Tolerance, Growths[static_cast<std::size_t>(round - Rounds)], options.MostSize,
          options.Gradation },
        executor);
      ShortenEdgesOfSmall(mesh, fields, options.Edge);
    }
    Edit(
      mesh, options.Edge, isGraded || !isLast, round >= FirstFit ? 1 : 0, executor, shouldContinue);
    mesh.Compact();
    if (round >= FirstFit)
    {
      worstVolume = CorrectVolumes(mesh, fields, options.Tolerance, executor);
      misclassified = PushMisclassifiedVoxels(
        mesh, fields, options.VoxelTolerance + (isLast ? options.Tolerance : 0.), executor);
    }
    move(round == 0 ? 1 : Steps, StepRelaxation, 0.);
    fraction = std::min(1., static_cast<double>(all / 2 + round) / all);
  }
  // Remove the slivers of the last steps, and correct the volumes that this changes.
  Edit(mesh, options.Edge, false, LastSliverRounds, executor, shouldContinue);
  mesh.Compact();
  CorrectVolumes(mesh, fields, options.Tolerance, executor);
  move(1, 0., SliverAngle);
  NearDegenerateRegions(mesh, fields, options.Edge, ToleranceOfEdge * options.Edge,
    options.VoxelTolerance + options.Tolerance)
    .Open(executor, shouldContinue);
}
}

InterfaceMesh MakeInterfaces(InterfaceFields& fields, const InterfaceOptions& options,
  Executor& executor, const std::function<bool(double fraction)>& progress)
{
  double fraction = 0.;
  const auto shouldContinue = [&] { return progress(fraction); };
  CancellableExecutor cancellable(executor, shouldContinue);
  InterfaceMesh mesh;
  try
  {
    RunRounds(mesh, fields, options, cancellable, fraction, shouldContinue);
    fraction = 1.;
  }
  catch (const OperationCancelled&)
  {
    mesh.Compact();
  }
  if (fields.ArePeriodic())
  {
    mesh.Compact(true); // Opposite sides get the same vertex order.
  }
  shouldContinue();
  return mesh;
}
}
