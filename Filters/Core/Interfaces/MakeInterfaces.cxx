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
/** Rounds in which short edges are collapsed, */
constexpr int Rounds = 2;
/** then those of splits, flips and steps alone, at least and at most: */
constexpr int LeastLastRounds = 1;
constexpr int MostLastRounds = 6;
/** while more voxels are on the wrong side than this share of the vertices, */
constexpr double FewWrong = 0.01;
/** or the volume of an object is off by more than this share. */
constexpr double FairVolume = 0.005;
/** With a tolerance there are other last rounds; by what factor sizes may grow in each of them. */
constexpr std::array<double, 3> Growths = { 2.5, 1.5, 1.1 };
/** The round from which on vertices are so near to their places that fields are changed. */
constexpr int FirstFit = 1;
/** Rounds of slivers' repair at the end: one makes some anew. */
constexpr int LastSliverRounds = 3;
/** Steps of vertices in a round; the first one has too many of them. */
constexpr int Steps = 2;
/** Shorter edge lengths get additional first steps, */
constexpr double LeastCollapsed = 1.25;
/** of this number, */
constexpr int StepsOfFine = 6;
/** each at most this long, in the shortest edge of a vertex. */
constexpr double FineStep = 0.2;
/** Edges that are split and collapsed, in the mean length. */
constexpr double LongestShare = 4. / 3.;
constexpr double ShortestShare = 4. / 5.;
/** In the last rounds those are split that steps have drawn out. */
constexpr double LongestLast = 1.8;
/** How much longer than they are edges are made in a round. */
constexpr double MostGrowth = 3.;
/** No step makes an edge shorter than that, in the same. */
constexpr double LeastShare = 0.5;
/** Nearer triangles count as intersecting, in the same. */
constexpr double ToleranceOfEdge = 1e-3;
/** How far vertices go to the middle of their neighbours. */
constexpr double StepShare = 0.7;

/** Edges about a part of an object, at most, in the radius of a ball of its volume, */
constexpr double EdgeInRadius = 0.8;
/** and at least, in the wanted edge: much shorter ones make searches near long ones slow, */
constexpr double LeastSize = 0.35;
/** and in the workspace: a single voxel needs no shorter ones. */
constexpr double LeastEdge = 0.48;

/** Small objects get shorter edges, to be round and keep their volumes. */
void ShortenEdgesOfSmall(InterfaceMesh& mesh, const InterfaceFields& fields, double edge)
{
  const std::array<double, 3>& step = fields.Step();
  const double ofVoxel = step[0] * step[1] * step[2];
  for (const InterfaceMesh::Face& face : mesh.Faces)
  {
    for (const int object : { static_cast<int>(face.Behind), static_cast<int>(face.Front) })
    {
      if (object == 0 || mesh.IsSide(object))
      {
        continue;
      }
      const auto voxels = static_cast<double>(fields.Bricks().ExtentOf(object).Voxels);
      const double radius = std::cbrt(voxels * ofVoxel * 0.2387324); // 3 / (4 pi)
      const auto size =
        static_cast<float>(std::max({ EdgeInRadius * radius / edge, LeastEdge / edge, LeastSize }));
      for (const int v : face.Vertex)
      {
        float& of = mesh.Size[static_cast<std::size_t>(v)];
        of = size < 1.f ? std::min(of, size) : of;
      }
    }
  }
}

/** A round's edits. @param hasCollapses else edges are split that steps have drawn out */
void Edit(InterfaceMesh& mesh, double requested, bool hasCollapses, int sliverRounds,
  Executor& executor, const std::function<bool()>& goOn)
{
  // What is searched near goes with the square of the lengths: they grow by rounds.
  const double edge = std::min(requested, MostGrowth * mesh.MeanEdge());
  const double longest = (hasCollapses ? LongestShare : LongestLast) * edge;
  InterfaceRemesher remesher(
    mesh, ShortestShare * edge, longest, ToleranceOfEdge * requested, executor, goOn);
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
/** All rounds. @param goOn as MakeInterfaces(); throws OperationCancelled, with the mesh safe */
void Work(InterfaceMesh& mesh, InterfaceFields& fields, const InterfaceOptions& options,
  Executor& executor, double& share, const std::function<bool()>& mayResume)
{
  // The first round is as much work as all others, as the start has many short edges.
  constexpr int all = 2 * (Rounds + LeastLastRounds);
  const bool isGraded = options.Tolerance > 0.;
  const int rounds = Rounds + (isGraded ? static_cast<int>(Growths.size()) : MostLastRounds);
  const double straightening =
    isGraded ? std::min(options.Tolerance, MostStraightening) : MostStraightening;
  const auto move = [&](int steps, double stepShare, double leastAngle)
  {
    MoveInterfaces(mesh, fields, steps, stepShare, LeastShare * options.Edge,
      ToleranceOfEdge * options.Edge, leastAngle, executor, straightening);
  };
  mesh = StartInterfaces(fields, executor);
  ShortenEdgesOfSmall(mesh, fields, options.Edge);
  // Short edges are not collapsed, so that steps alone have to make stairs flat, by and by: what
  // turns too far at once is taken back.
  for (int step = 0; step < StepsOfFine && options.Edge < LeastCollapsed; ++step)
  {
    MoveInterfaces(mesh, fields, 1, StepShare, 0., ToleranceOfEdge * options.Edge, 0., executor,
      straightening, FineStep);
  }
  std::size_t wrong = 0;
  double worstVolume = 0.;
  for (int round = 0; round < rounds; ++round)
  {
    const bool hasFewWrong =
      static_cast<double>(wrong) <= FewWrong * static_cast<double>(mesh.Position.size());
    const bool isLast = round >= Rounds;
    if (!isGraded && round >= Rounds + LeastLastRounds && hasFewWrong && worstVolume < FairVolume)
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
    Edit(mesh, options.Edge, isGraded || !isLast, round >= FirstFit ? 1 : 0, executor, mayResume);
    mesh.Compact();
    if (round >= FirstFit)
    {
      worstVolume = CorrectVolumes(mesh, fields, options.Tolerance, executor);
      wrong = PushMisclassifiedVoxels(
        mesh, fields, options.VoxelTolerance + (isLast ? options.Tolerance : 0.), executor);
    }
    move(round == 0 ? 1 : Steps, StepShare, 0.);
    share = std::min(1., static_cast<double>(all / 2 + round) / all);
  }
  // Of the last steps some slivers are left; without them volumes are a little different again.
  Edit(mesh, options.Edge, false, LastSliverRounds, executor, mayResume);
  mesh.Compact();
  CorrectVolumes(mesh, fields, options.Tolerance, executor);
  move(1, 0., SliverAngle);
  NearDegenerateRegions(mesh, fields, options.Edge, ToleranceOfEdge * options.Edge,
    options.VoxelTolerance + options.Tolerance)
    .Open(executor, mayResume);
}
}

InterfaceMesh MakeInterfaces(InterfaceFields& fields, const InterfaceOptions& options,
  Executor& executor, const std::function<bool(double share)>& goOn)
{
  double share = 0.;
  const auto mayResume = [&] { return goOn(share); };
  CancellableExecutor asking(executor, mayResume);
  InterfaceMesh mesh;
  try
  {
    Work(mesh, fields, options, asking, share, mayResume);
    share = 1.;
  }
  catch (const OperationCancelled&)
  {
    mesh.Compact(); // What is removed is not handed out.
  }
  if (fields.ArePeriodic())
  {
    mesh.Compact(true); // In both of two opposite sides vertices are numbered in the same order.
  }
  mayResume();
  return mesh;
}
}
