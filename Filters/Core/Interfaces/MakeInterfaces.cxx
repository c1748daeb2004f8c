// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/MakeInterfaces.h"

#include "Core/Interfaces/InterfaceMotion.h"
#include "Core/Interfaces/InterfaceRemesher.h"
#include "Core/Interfaces/InterfaceStart.h"

namespace volumic
{
namespace
{
/** Rounds of edits and steps, */
constexpr int Rounds = 8;
/** then of flips and steps alone. */
constexpr int LastRounds = 4;
/** Edges that are split and collapsed, in the mean length. */
constexpr double LongestShare = 4. / 3.;
constexpr double ShortestShare = 4. / 5.;
/** Nearer triangles count as intersecting, in the mean length of edges. */
constexpr double ToleranceOfEdge = 1e-3;
/** How far vertices go to the middle of their neighbours. */
constexpr double StepShare = 0.7;
}

InterfaceMesh MakeInterfaces(const InterfaceFields& fields, double edge, Executor& executor,
  const std::function<bool(double share)>& progress)
{
  InterfaceMesh mesh = MakeInterfaceStart(fields, executor);
  const double tolerance = ToleranceOfEdge * edge;
  constexpr int all = Rounds + LastRounds;
  for (int round = 0; round < all && progress((round + 1.) / (all + 1.)); ++round)
  {
    {
      InterfaceRemesher remesher(mesh, ShortestShare * edge, LongestShare * edge, tolerance);
      if (round < Rounds)
      {
        remesher.SplitLongEdges();
        remesher.CollapseShortEdges();
      }
      remesher.FlipEdges();
    }
    mesh.Compact();
    MoveInterfaces(mesh, fields, StepShare, tolerance, executor);
  }
  progress(1.);
  return mesh;
}
}
