// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/NearDegenerateRegions.h"

#include "Core/Common/Select.h"
#include "Core/Interfaces/InterfaceCrossings.h"
#include "Core/Interfaces/JunctionWedges.h"
#include "Core/Interfaces/TriangleShape.h"
#include "Core/Mesh/TriangleDistance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace volumic
{
namespace
{
/** Angles of triangles and wedges below which they are opened, in radians (25 and 11 degrees). */
constexpr double NarrowAngle = 0.44;
constexpr double NarrowWedge = 0.2;
/** Width of gaps below which they are opened, relative to the desired edge length. */
constexpr double NarrowGap = 0.15;
/** Two triangles of one interface at a vertex form no gap if their normals have a larger cosine. */
constexpr double FlatCosine = 0.5;
constexpr std::size_t SpanSize = 1024;
constexpr std::size_t GapSpanSize = 64; ///< smaller, as gaps take longer
constexpr std::size_t VerticesPerProgressCall = 256;
constexpr int Rounds = 4;
/** First and smallest step of a vertex, relative to its desired edge length. */
constexpr double LargestStep = 0.15;
constexpr double SmallestStep = 0.015;
/** Maximum distance of a vertex from its initial position, in the smallest voxel spacing. */
constexpr float MostMove = 0.5f;
/** Maximum volume change of an object: a fraction of its volume, or a number of voxels. */
constexpr double MostGainFraction = 0.001;
constexpr double MostGain = 2.;
/** Step of the finite differences, relative to the desired edge length. */
constexpr float Probe = 1e-3f;
/** Least cosine of the angle by which a step may turn a face. */
constexpr double LeastTurnCosine = 0.4;

/** Return the square of the relative difference to the requested value; 0 if it is reached. */
double SquaredDeficit(double value, double requested)
{
  const double deficit = 1. - value / requested;
  return deficit > 0. ? deficit * deficit : 0.;
}

/** Return whether a triangle has a distance of more than `by` from the plane of another one. */
bool IsBeyond(const MeshTriangle& plane, const MeshTriangle& other, double by)
{
  const VectorD normal = Normalized(NormalOf(plane));
  const auto [low, high] = std::minmax({ Dot(normal, other.Corner[0] - plane.Corner[0]),
    Dot(normal, other.Corner[1] - plane.Corner[0]),
    Dot(normal, other.Corner[2] - plane.Corner[0]) });
  return low > by || high < -by;
}

/** Return six times the signed volume of a tetrahedron. */
double VolumeOf(const VectorD& a, const VectorD& b, const VectorD& c, const VectorD& d)
{
  return Dot(Cross(b - a, c - a), d - a);
}
}

NearDegenerateRegions::NearDegenerateRegions(InterfaceMesh& mesh, const InterfaceFields& fields,
  double edge, double tolerance, double voxelTolerance)
  : Mesh(mesh), Fields(fields), Edge(edge), VoxelTolerance(voxelTolerance),
    Clearance(mesh, tolerance), Start(mesh.Position),
    Gains(static_cast<std::size_t>(fields.Bricks().Map().NumberOfObjects) + 1, 0.)
{
}

void NearDegenerateRegions::Open(Executor& executor, const std::function<bool()>& shouldContinue)
{
  this->Clearance.Reset(executor);
  std::vector<int> vertices = this->FindVertices(executor);
  for (int round = 0; round < Rounds && !vertices.empty() && shouldContinue(); ++round)
  {
    // Only vertices of changed faces can be moved in the next round.
    std::vector<int> next;
    std::size_t visited = 0;
    for (const int v : vertices)
    {
      if (++visited % VerticesPerProgressCall == 0 && !shouldContinue())
      {
        return;
      }
      if (this->TryMove(v))
      {
        for (const int f : this->Changed)
        {
          const std::array<int, 3>& corners = this->Mesh.Faces[static_cast<std::size_t>(f)].Vertex;
          next.insert(next.end(), corners.begin(), corners.end());
        }
      }
    }
    SortUnique(next);
    vertices.swap(next);
  }
}

std::vector<int> NearDegenerateRegions::FindVertices(Executor& executor)
{
  const LargeVector<InterfaceMesh::Face>& faces = this->Mesh.Faces;
  // There are no gaps in one sheet, as the margin is smaller than the cubes of FindCrossings().
  const std::vector<int> candidates =
    FindCrossings(this->Mesh, NarrowGap * this->Edge, executor).Candidates;
  auto vertices = CollectInSpans<int>(executor, faces.size(), SpanSize,
    [&](std::size_t f, std::vector<int>& some)
    {
      const std::array<int, 3>& v = faces[f].Vertex;
      if (faces[f].IsThere() && SmallestAngle(TriangleOf(this->Mesh, v)) < NarrowAngle)
      {
        some.insert(some.end(), v.begin(), v.end());
      }
    });
  const auto atGaps = CollectInSpans<int>(executor, candidates.size(), GapSpanSize,
    [&](std::size_t n, std::vector<int>& some)
    {
      bool isNarrow = false;
      this->ForGapsAt(candidates[n], this->FindGaps(candidates[n], 0.), 0.,
        [&](double deficit) { isNarrow = isNarrow || deficit > 0.; }); // found by both
      const std::array<int, 3>& v = faces[static_cast<std::size_t>(candidates[n])].Vertex;
      some.insert(some.end(), v.begin(), isNarrow ? v.end() : v.begin());
    });
  vertices.insert(vertices.end(), atGaps.begin(), atGaps.end());
  for (const std::array<int, 2>& edge : this->Mesh.FindLines())
  {
    this->Mesh.FindFaces(edge[0], edge[1], this->AtEdge);
    const JunctionWedge wedge = NarrowestWedgeAt(this->Mesh, edge, this->AtEdge);
    if (wedge.Angle < NarrowWedge)
    {
      for (const int f : wedge.Faces)
      {
        const std::array<int, 3>& corners = this->Mesh.Faces[static_cast<std::size_t>(f)].Vertex;
        vertices.insert(vertices.end(), corners.begin(), corners.end());
      }
    }
  }
  SortUnique(vertices);
  return vertices;
}

NearDegenerateRegions::Gaps NearDegenerateRegions::FindGaps(int face, double move) const
{
  const InterfaceMesh::Face& here = this->Mesh.Faces[static_cast<std::size_t>(face)];
  const std::array<int, 3>& v = here.Vertex;
  const MeshTriangle triangle = TriangleOf(this->Mesh, v);
  const double reach = NarrowGap * this->Edge * this->Mesh.SizeOf(v[0], v[1]) + move;
  std::vector<int> near;
  this->Clearance.FindNear(BoxOf(triangle).Grown(static_cast<float>(reach)), near);
  Gaps gaps;
  for (const int other : near)
  {
    const InterfaceMesh::Face& there = this->Mesh.Faces[static_cast<std::size_t>(other)];
    const MeshTriangle facing = TriangleOf(this->Mesh, there.Vertex);
    const bool isAdjacent = there.Behind == here.Behind && there.Front == here.Front &&
      (there.Has(v[0]) || there.Has(v[1]) || there.Has(v[2]));
    if (isAdjacent || !(IsBeyond(triangle, facing, reach) || IsBeyond(facing, triangle, reach)))
    {
      gaps.emplace_back(other, isAdjacent ? -1. : std::sqrt(SquaredGapBetween(triangle, facing)));
    }
  }
  return gaps;
}

template <typename Visitor>
void NearDegenerateRegions::ForGapsAt(
  int face, const Gaps& gaps, double moved, Visitor&& visit) const
{
  const MeshTriangle triangle = TriangleAt(this->Mesh, face);
  const double requested =
    NarrowGap * this->Edge * this->Mesh.SizeOf(triangle.Vertex[0], triangle.Vertex[1]);
  for (const auto& [other, width] : gaps)
  {
    const MeshTriangle facing = TriangleAt(this->Mesh, other);
    // The face itself, or a flat neighbour. Distances of two faces that move change twice as much.
    const bool isFlat = width < 0. && CosineOf(NormalOf(triangle), NormalOf(facing)) > FlatCosine;
    if (!isFlat && width - 2. * moved <= requested)
    {
      visit(SquaredDeficit(std::sqrt(SquaredGapBetween(triangle, facing)), requested));
    }
  }
}

double NearDegenerateRegions::Narrowness(double moved)
{
  const auto isOnLine = [this](int w)
  { return this->Mesh.StratumOf[static_cast<std::size_t>(w)] != Stratum::Interface; };
  double sum = 0.;
  for (const std::array<int, 2>& image : this->Images)
  {
    this->Mesh.ForFaces(image[0],
      [&](int f)
      {
        const std::array<int, 3>& corners = this->Mesh.Faces[static_cast<std::size_t>(f)].Vertex;
        sum += SquaredDeficit(SmallestAngle(TriangleOf(this->Mesh, corners)), NarrowAngle);
        this->ForGapsAt(f, this->GapsAt[f], moved, [&](double deficit) { sum += deficit; });
        for (int k = 0; k < 3; ++k)
        {
          const std::array<int, 2> edge = { corners[k], corners[(k + 1) % 3] };
          if (!isOnLine(edge[0]) || !isOnLine(edge[1]))
          {
            continue;
          }
          this->Mesh.FindFaces(edge[0], edge[1], this->AtEdge);
          if (this->Mesh.IsLine(this->AtEdge))
          {
            sum +=
              SquaredDeficit(NarrowestWedgeAt(this->Mesh, edge, this->AtEdge).Angle, NarrowWedge);
          }
        }
      });
  }
  return sum;
}

void NearDegenerateRegions::MoveTo(const Vector& target)
{
  for (const std::array<int, 2>& image : this->Images)
  {
    this->Mesh.Position[static_cast<std::size_t>(image[0])] =
      this->Mesh.ProjectToSides(image[0], target);
  }
}

bool NearDegenerateRegions::TryMove(int v)
{
  this->Mesh.FindImages(v, v, this->Images);
  const float edge = static_cast<float>(this->Edge) * this->Mesh.Size[static_cast<std::size_t>(v)];
  this->GapsAt.clear();
  for (const std::array<int, 2>& image : this->Images)
  {
    this->Mesh.ForFaces(
      image[0], [&](int f) { this->GapsAt[f] = this->FindGaps(f, (LargestStep + Probe) * edge); });
  }
  const double before = this->Narrowness(0.);
  if (before == 0.)
  {
    return false;
  }
  const Vector position = this->Mesh.Position[static_cast<std::size_t>(v)];
  const auto differenceAlong = [&](const Vector& offset)
  {
    this->MoveTo(position + offset);
    const double ahead = this->Narrowness(2. * Probe * edge);
    this->MoveTo(position - offset);
    return static_cast<float>(this->Narrowness(2. * Probe * edge) - ahead);
  };
  const float probe = Probe * edge;
  const Vector slope(differenceAlong(Vector(probe, 0.f, 0.f)),
    differenceAlong(Vector(0.f, probe, 0.f)), differenceAlong(Vector(0.f, 0.f, probe)));
  this->MoveTo(position);
  if (!(SquaredLength(slope) > 0.f))
  {
    return false;
  }
  for (double step = LargestStep; step > SmallestStep; step *= 0.5)
  {
    const Vector target = position + Normalized(slope) * (static_cast<float>(step) * edge);
    this->MoveTo(target);
    const double after = this->Narrowness((step + Probe) * edge);
    this->MoveTo(position);
    if (after < before && this->TryMoveTo(v, target))
    {
      return true;
    }
  }
  return false;
}

bool NearDegenerateRegions::TryMoveTo(int v, const Vector& requested)
{
  const Vector target = this->Mesh.ProjectToSides(v, requested);
  if (SquaredDistance(target, this->Start[static_cast<std::size_t>(v)]) > MostMove * MostMove)
  {
    return false;
  }
  this->Made.clear();
  this->Changed.clear();
  bool isFair = true;
  for (const std::array<int, 2>& image : this->Images)
  {
    this->Mesh.ForFaces(image[0],
      [&](int f)
      {
        const InterfaceMesh::Face& face = this->Mesh.Faces[static_cast<std::size_t>(f)];
        FaceCoordinates t = FaceCoordinatesOf(this->Mesh, face);
        const MeshTriangle old = t;
        const std::ptrdiff_t moved = std::find(t.Vertex, t.Vertex + 3, image[0]) - t.Vertex;
        t.Corner[moved] = VectorD(this->Mesh.ProjectToSides(image[0], target));
        isFair = isFair && CosineOf(NormalOf(old), NormalOf(t)) > LeastTurnCosine &&
          this->KeepsVoxels(face, moved, old, t);
        this->Changed.push_back(f);
        this->Made.push_back(t);
      });
  }
  if (!isFair || !this->Clearance.AreClear(this->Made, this->Changed, this->Near) ||
    !this->AddGains())
  {
    return false;
  }
  this->MoveTo(target);
  for (const int f : this->Changed)
  {
    this->Clearance.Change(f);
  }
  return true;
}

bool NearDegenerateRegions::AddGains()
{
  std::map<int, double> gains;
  const std::array<double, 3>& step = this->Fields.Step();
  for (std::size_t n = 0; n < this->Made.size(); ++n)
  {
    const FaceCoordinates& face = this->Made[n];
    const MeshTriangle old = TriangleAt(this->Mesh, this->Changed[n]);
    double volume = 0.;
    for (int k = 0; k < 3; ++k)
    {
      volume +=
        VolumeOf(old.Corner[k], old.Corner[(k + 1) % 3], old.Corner[(k + 2) % 3], face.Corner[k]);
    }
    volume /= 6. * step[0] * step[1] * step[2];
    gains[face.Behind] += volume;
    if (!this->Mesh.IsSide(face.Front))
    {
      gains[face.Front] -= volume;
    }
  }
  gains.erase(0);
  const auto isFair = [this](const auto& gain)
  {
    const double voxels = static_cast<double>(this->Fields.Bricks().ExtentOf(gain.first).Voxels);
    const double before = this->Gains[static_cast<std::size_t>(gain.first)];
    const double after = std::abs(before + gain.second);
    return after <= std::max(MostGain, MostGainFraction * voxels) || after <= std::abs(before);
  };
  if (!std::all_of(gains.begin(), gains.end(), isFair))
  {
    return false;
  }
  for (const auto& gain : gains)
  {
    this->Gains[static_cast<std::size_t>(gain.first)] += gain.second;
  }
  return true;
}

bool NearDegenerateRegions::KeepsVoxels(const InterfaceMesh::Face& face, std::ptrdiff_t moved,
  const MeshTriangle& before, const MeshTriangle& after) const
{
  const VectorD& from = before.Corner[moved];
  const VectorD& to = after.Corner[moved];
  const VectorD& a = before.Corner[(moved + 1) % 3];
  const VectorD& b = before.Corner[(moved + 2) % 3];
  const double all = VolumeOf(from, a, b, to);
  // The swept volume goes to the object behind the face if the face moves forward.
  const int taker = all > 0. ? face.Behind : face.Front;
  const VectorD normal = Normalized(NormalOf(after));
  const std::array<double, 3>& step = this->Fields.Step();
  VoxelBox box;
  int axis = 0;
  for (double VectorD::*c : { &VectorD::X, &VectorD::Y, &VectorD::Z })
  {
    const auto [low, high] = std::minmax({ from.*c, to.*c, a.*c, b.*c });
    box.First[axis] = static_cast<int>(std::ceil(low / step[axis]));
    box.End[axis] = static_cast<int>(std::floor(high / step[axis])) + 1;
    ++axis;
  }
  bool areKept = true;
  box.ForVoxels(
    [&](int i, int j, int k)
    {
      const VectorD centre(i * step[0], j * step[1], k * step[2]);
      const auto isWithin = [all](double volume) { return volume * all >= 0.; };
      areKept = areKept &&
        !(isWithin(VolumeOf(centre, a, b, to)) && isWithin(VolumeOf(from, centre, b, to)) &&
          isWithin(VolumeOf(from, a, centre, to)) && isWithin(VolumeOf(from, a, b, centre)) &&
          std::abs(Dot(normal, centre - to)) > this->VoxelTolerance &&
          this->Fields.Bricks().Map().At(i, j, k) != taker);
    });
  return areKept;
}
}
