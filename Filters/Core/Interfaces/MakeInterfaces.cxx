// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/MakeInterfaces.h"

#include "Core/Interfaces/InterfaceMotion.h"
#include "Core/Interfaces/InterfaceRemesher.h"
#include "Core/Interfaces/InterfaceStart.h"
#include "Core/Image/VoxelNumbers.h"
#include "Core/Labels/WrongVoxels.h"
#include <chrono>
#include <map>
#include <array>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace volumic
{
namespace
{
/** Rounds of edits and steps, */
static int Steps=getenv("VS")?atoi(getenv("VS")):2; static int FirstPush=getenv("VF")?atoi(getenv("VF")):3; static int Rounds = getenv("VR")?atoi(getenv("VR")):8;
/** then of flips and steps alone. */
static int LastRounds = getenv("VL")?atoi(getenv("VL")):4;
/** Edges that are split and collapsed, in the mean length. */
constexpr double LongestShare = 4. / 3.;
constexpr double ShortestShare = 4. / 5.;
/** No step makes an edge shorter, in the same. */
constexpr double LeastShare = 0.5;
/** Nearer triangles count as intersecting, in the mean length of edges. */
constexpr double ToleranceOfEdge = 1e-3;
/** How far vertices go to the middle of their neighbours. */
constexpr double StepShare = 0.7;
/** Sweeps over the equations of the shifts. */
constexpr int VolumeSweeps = 200;
/** Fields are shifted at most by that, in smallest distances of voxels: their signs are to stay. */
constexpr double MostShift = 0.08;
/** By how much fields are changed at a voxel on the wrong side, in smallest distances of voxels. */
static float PushOfWrong = getenv("VW")?atof(getenv("VW")):.2f;

/** Of each object the voxels that its surface has on the wrong side. */
std::vector<std::vector<std::int64_t>> FindWrong(
  const InterfaceMesh& mesh, const InterfaceFields& fields, Executor& executor)
{
  const std::vector<std::vector<int>> faces = mesh.FindFacesOfObjects();
  // The last one is what is about all others, and has no end.
  std::vector<std::vector<std::int64_t>> wrong(
    static_cast<std::size_t>(fields.Bricks().Map().NumberOfObjects));
  ForBlocks(executor, std::min(wrong.size(), faces.size()), 1,
    [&](std::size_t object, std::size_t, std::size_t)
    {
      std::vector<int> vertices;
      IndexedSurface surface =
        mesh.SurfaceOf(static_cast<int>(object), faces[object], vertices);
      for (Point& p : surface.Points)
      {
        for (int axis = 0; axis < 3; ++axis)
        {
          p[axis] /= fields.Step()[axis];
        }
      }
      wrong[object] =
        FindWrongVoxels(fields.Bricks(), static_cast<int>(object), surface);
    });
  return wrong;
}

/**
 * Shifts all fields so that, to first order, each object but the last gets the volume of its voxels:
 * an interface moves by half of what its two fields are shifted by.
 */
void CorrectVolumes(const InterfaceMesh& mesh, InterfaceFields& fields)
{
  const LabelBricks& bricks = fields.Bricks();
  const auto last = static_cast<std::size_t>(bricks.Map().NumberOfObjects);
  const std::array<double, 3>& step = fields.Step();
  const double ofVoxel = step[0] * step[1] * step[2];
  std::vector<double> missing(last + 1, 0.);
  std::map<std::array<std::size_t, 2>, double> areas;
  for (std::size_t object = 1; object < last; ++object)
  {
    missing[object] =
      ofVoxel * static_cast<double>(bricks.ExtentOf(static_cast<int>(object)).Voxels);
  }
  for (const InterfaceMesh::Face& face : mesh.Faces)
  {
    if (face.IsThere())
    {
      const VectorD across = mesh.NormalOf(face);
      const double volume =
        Dot(across, VectorD(mesh.Position[static_cast<std::size_t>(face.Vertex[0])])) / 6.;
      missing[face.Behind] -= volume;
      missing[face.Front] += volume;
      areas[{ face.Behind, face.Front }] += 0.5 * Length(across);
    }
  }
  std::vector<double> shifts(last + 1, 0.);
  std::vector<double> sums(last + 1);
  std::vector<double> weights(last + 1);
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
    for (std::size_t object = 1; object < last; ++object)
    {
      shifts[object] = weights[object] > 0. ? sums[object] / weights[object] : 0.;
    }
  }
  for (std::size_t object = 1; object < last; ++object)
  {
    fields.Shift(static_cast<int>(object),
      static_cast<float>(std::clamp(shifts[object], -MostShift, MostShift)));
  }
}

/** Has interfaces pass wrong voxels on the other side, after a step. @return how many there are */
std::size_t PushWrong(const InterfaceMesh& mesh, InterfaceFields& fields, Executor& executor)
{
  const LabelMap& map = fields.Bricks().Map();
  const VoxelNumbers numbers(map.Size);
  const std::vector<std::vector<std::int64_t>> wrong = FindWrong(mesh, fields, executor);
  std::size_t count = 0;
  const int outside = map.NumberOfObjects;
  for (std::size_t object = 0; object < wrong.size(); ++object)
  {
    for (const std::int64_t voxel : wrong[object])
    {
      fields.Push(static_cast<int>(object), numbers.PlaceOf(voxel), PushOfWrong);
      if (map.Voxels[static_cast<std::size_t>(voxel)] == outside)
      {
        fields.Push(outside, numbers.PlaceOf(voxel), PushOfWrong);
      }
    }
    count += wrong[object].size();
  }
  return count;
}
}

InterfaceMesh MakeInterfaces(InterfaceFields& fields, double edge, Executor& executor,
  const std::function<bool(double share)>& progress)
{
  clock_t last = clock();
  const auto lap = [&](const char* n) { if (getenv("VT")) printf("  %s %.3f\n", n, double(clock()-last)/CLOCKS_PER_SEC); last = clock(); };
  InterfaceMesh mesh = MakeInterfaceStart(fields, getenv("VP") ? atoi(getenv("VP")) : 1, executor);
  lap("start");
  const double tolerance = ToleranceOfEdge * edge;
  int all = Rounds + LastRounds;
  for (int round = 0; round < all && progress((round + 1.) / (all + 1.)); ++round)
  {
    {
      InterfaceRemesher remesher(mesh, ShortestShare * edge, LongestShare * edge, tolerance);
      int a=0,b=0;
      if (round < Rounds)
      {
        a=remesher.SplitLongEdges();
        b=remesher.CollapseShortEdges();
      }
      lap("edits");
      int c=remesher.FlipEdges();
      lap("flips");
      if (getenv("VT")) printf("round %d: splits %d collapses %d flips %d faces %zu\n", round,a,b,c,mesh.Faces.size());
    }
    mesh.Compact();
    lap("compact");
    if (round >= FirstPush && round < all-1)
    {
      CorrectVolumes(mesh, fields);
      auto w=PushWrong(mesh, fields, executor);
      if (getenv("VT")) printf("wrong %zu\n", w);
      lap("push");
    }
    MoveInterfaces(mesh, fields, round>0 ? Steps : 1, StepShare, LeastShare * edge, tolerance, executor);
    lap("move");
  }
  progress(1.);
  return mesh;
}
}
