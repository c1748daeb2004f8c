// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/LatticeCutter.h"

#include "Core/Common/Spans.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace volumic
{
namespace
{
/** Vertices keep this share of their edge from its ends. */
constexpr float LeastShare = 0.15f;

bool IsBefore(const LatticeSite& a, const LatticeSite& b)
{
  return std::tie(a.At[2], a.At[1], a.At[0]) < std::tie(b.At[2], b.At[1], b.At[0]);
}
}

void LatticeCutter::FindMiddles(Executor& executor)
{
  ForSpans(executor, static_cast<std::size_t>(this->OfMiddles.NumberOfLayers()), 1,
    [&](std::size_t layer, std::size_t, std::size_t)
    {
      const VoxelBox box = this->OfMiddles.Layer(static_cast<int>(layer));
      std::vector<Number> objects(static_cast<std::size_t>(box.Count()));
      for (int k = box.First[2]; k < box.End[2]; ++k)
      {
        for (int j = 0; j < box.End[1]; ++j)
        {
          for (int i = 0; i < box.End[0]; ++i)
          {
            objects[static_cast<std::size_t>(box.NumberOf(i, j, k))] =
              this->ObjectBetween({ 2 * i + 1, 2 * j + 1, 2 * k + 1 });
          }
        }
      }
      this->OfMiddles.PutLayer(static_cast<int>(layer), objects.data());
    });
}

LatticeCutter::Number LatticeCutter::ObjectBetween(const std::array<int, 3>& halves) const
{
  constexpr int side = LabelBricks::Side;
  std::array<int, 3> voxel;
  for (int axis = 0; axis < 3; ++axis)
  {
    voxel[axis] = this->Pitch[axis] * halves[axis] >> 1;
  }
  if (!this->Fields.HasInterfaces(voxel[0] / side, voxel[1] / side, voxel[2] / side))
  {
    return this->ObjectOf(voxel); // All about it is the same.
  }
  std::array<Number, 8> about;
  std::size_t count = 0;
  this->ForVoxels(halves,
    [&](int i, int j, int k) {
      about[count++] = this->ObjectOf({ i, j, k });
    });
  auto* const last = about.begin() + count;
  std::sort(about.begin(), last);
  const auto* end = std::unique(about.begin(), last);
  Number best = about[0];
  float most = -std::numeric_limits<float>::max();
  for (const auto* object = about.begin(); object != end && end - about.begin() > 1; ++object)
  {
    const float value = this->ValueAt(halves, *object);
    if (value > most)
    {
      best = *object;
      most = value;
    }
  }
  return best;
}

LatticeCutter::Number LatticeCutter::ObjectOf(const std::array<int, 3>& voxel) const
{
  const std::array<int, 3> source = this->Fields.SourceOf(voxel);
  return this->Map.At(source[0], source[1], source[2]);
}

void LatticeCutter::FollowFields(Executor& executor)
{
  ForSpans(executor, static_cast<std::size_t>(this->Map.NumberOfLayers()), 1,
    [&](std::size_t layer, std::size_t, std::size_t)
    {
      this->ForVoxelsAtInterfaces(this->Map.Layer(static_cast<int>(layer)),
        [&](int i, int j, int k) { this->Map.Set(i, j, k, this->Fields.LargestAt(i, j, k)); });
    });
}

void LatticeCutter::KeepGaps()
{
  const bool areSites = this->Pitch == std::array<int, 3>{ 2, 2, 2 }; // also middles of cubes
  this->ForVoxelsAtInterfaces(VoxelBox::Of(this->Map.Size()),
    [&](int i, int j, int k)
    {
      const std::array<int, 3> voxel = { i, j, k };
      bool isSite = areSites && (i & 1) == 1 && (j & 1) == 1 && (k & 1) == 1;
      bool isCorner = true;
      for (int axis = 0; axis < 3; ++axis)
      {
        isCorner = isCorner && voxel[axis] % this->Pitch[axis] == 0;
      }
      isSite = isSite || isCorner;
      for (int axis = 0; axis < 3 && isSite; ++axis)
      {
        if (this->Pitch[axis] == 2 && voxel[axis] + 2 < this->Map.Size()[axis])
        {
          this->KeepGapAt(voxel, axis);
        }
      }
    });
}

void LatticeCutter::KeepGapAt(const std::array<int, 3>& voxel, int axis)
{
  std::array<int, 3> middle = voxel;
  ++middle[axis];
  std::array<int, 3> next = middle;
  ++next[axis];
  const Number own = this->ObjectOf(voxel);
  const Number other = this->ObjectOf(next);
  const Number between = this->ObjectOf(middle);
  if (own == other || between == own || between == other)
  {
    return;
  }
  const bool isFirstLess = this->Fields.At(own, voxel[0], voxel[1], voxel[2]) <=
    this->Fields.At(other, next[0], next[1], next[2]);
  for (const std::array<int, 3>& end : { isFirstLess ? voxel : next, isFirstLess ? next : voxel })
  {
    if (this->MayChange(end))
    {
      this->Map.Set(end[0], end[1], end[2], between);
      return;
    }
  }
}

bool LatticeCutter::MayChange(const std::array<int, 3>& voxel) const
{
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const int step : { -this->Pitch[axis], this->Pitch[axis] })
    {
      std::array<int, 3> near = voxel;
      near[axis] += step;
      if (VoxelBox::Of(this->Map.Size()).Contains(near) &&
        this->ObjectOf(near) == this->ObjectOf(voxel))
      {
        return true;
      }
    }
  }
  return false;
}

LatticeSite LatticeCutter::SiteAt(const std::array<int, 3>& halves) const
{
  const std::array<int, 3> cube = { halves[0] >> 1, halves[1] >> 1, halves[2] >> 1 };
  const int odd = (halves[0] & 1) + (halves[1] & 1) + (halves[2] & 1);
  if (odd == 1)
  {
    return { halves, this->ObjectBetween(halves) };
  }
  return { halves,
    odd != 0 ? this->OfMiddles.At(cube[0], cube[1], cube[2])
             : this->ObjectOf({ this->Pitch[0] * cube[0], this->Pitch[1] * cube[1],
                 this->Pitch[2] * cube[2] }) };
}

void LatticeCutter::CutBrick(int i, int j, int k)
{
  std::array<int, 3> first = { i, j, k };
  std::array<int, 3> end;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int side = LabelBricks::Side / this->Pitch[axis];
    first[axis] *= side;
    end[axis] = std::min(first[axis] + side, this->Corners[axis]);
  }
  for (int z = first[2]; z < end[2]; ++z)
  {
    for (int y = first[1]; y < end[1]; ++y)
    {
      for (int x = first[0]; x < end[0]; ++x)
      {
        this->CutAbout({ x, y, z });
      }
    }
  }
}

void LatticeCutter::CutAbout(const std::array<int, 3>& cube)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const int first = (axis + 1) % 3;
    const int second = (axis + 2) % 3;
    if (cube[axis] + 1 >= this->Corners[axis] || cube[first] < 1 || cube[second] < 1 ||
      cube[first] + 1 >= this->Corners[first] || cube[second] + 1 >= this->Corners[second] ||
      !this->IsInBox(cube, axis))
    {
      continue; // All is of one object there.
    }
    const bool isAtFirst = this->Fields.HaveBox() && cube[axis] < this->Box.First[axis];
    const bool isAtLast = this->Fields.HaveBox() && cube[axis] + 1 >= this->Box.End[axis];
    LatticeEdge edge({ 2 * cube[0], 2 * cube[1], 2 * cube[2] }, axis);
    edge.From[axis] += isAtFirst ? 1 : 0;
    edge.To[axis] -= isAtLast ? 1 : 0;
    const LatticeSite own = this->SiteAt(edge.From);
    const LatticeSite next = this->SiteAt(edge.To);
    std::array<LatticeSite, 4> about;
    bool isSame = own.Object == next.Object;
    for (int turn = 0; turn < 4; ++turn)
    {
      about[turn] = this->SiteAt(edge.About[turn]);
      isSame = isSame && about[turn].Object == own.Object;
    }
    for (int turn = 0; turn < 4 && !(isSame && !isAtFirst && !isAtLast); ++turn)
    {
      Tetrahedron cell;
      cell.Corner = { own, next, about[turn], about[(turn + 1) % 4] };
      cell.FindGroups();
      this->Cut(cell);
      if (isAtFirst || isAtLast)
      {
        this->CutSide(
          { isAtFirst ? own : next, cell.Corner[2], cell.Corner[3] }, isAtFirst ? next : own, axis);
      }
    }
  }
}

void LatticeCutter::Cut(const Tetrahedron& cell)
{
  if (cell.Groups == 2)
  {
    this->CutInTwo(cell);
  }
  else if (cell.Groups > 2)
  {
    this->CutInMore(cell);
  }
}

void LatticeCutter::CutInTwo(const Tetrahedron& cell)
{
  const int others = cell.Group[0] + cell.Group[1] + cell.Group[2] + cell.Group[3];
  if (others != 2)
  {
    const int lone = others == 1 ? 1 : 0; // the group of one corner
    int single = 0;
    while (cell.Group[single] != lone)
    {
      ++single;
    }
    std::array<int, 3> vertices;
    int count = 0;
    int other = 0;
    for (int c = 0; c < 4; ++c)
    {
      if (c != single)
      {
        vertices[count++] = this->VertexOn(cell.Corner[single], cell.Corner[c]);
        other = c;
      }
    }
    this->AddTriangle(vertices, cell.Corner[single], cell.Corner[other]);
    return;
  }
  std::array<int, 2> own;
  std::array<int, 2> far;
  int owns = 0;
  int fars = 0;
  for (int c = 0; c < 4; ++c)
  {
    (cell.Group[c] == 0 ? own[owns++] : far[fars++]) = c;
  }
  const std::array<int, 4> quad = { this->VertexOn(cell.Corner[own[0]], cell.Corner[far[0]]),
    this->VertexOn(cell.Corner[own[0]], cell.Corner[far[1]]),
    this->VertexOn(cell.Corner[own[1]], cell.Corner[far[1]]),
    this->VertexOn(cell.Corner[own[1]], cell.Corner[far[0]]) };
  const Vector* at = this->Mesh.Position.data();
  const bool isFirstShorter =
    SquaredDistance(at[quad[0]], at[quad[2]]) <= SquaredDistance(at[quad[1]], at[quad[3]]);
  const int turn = isFirstShorter ? 0 : 1;
  for (int half = 0; half < 2; ++half)
  {
    this->AddTriangle({ quad[(turn + 2 * half) % 4], quad[(turn + 2 * half + 1) % 4],
                        quad[(turn + 2 * half + 2) % 4] },
      cell.Corner[own[0]], cell.Corner[far[0]]);
  }
}

void LatticeCutter::CutInMore(const Tetrahedron& cell)
{
  // The curves on the four faces, each a piece of the boundary between two corners' objects.
  struct Piece
  {
    int From;
    int To;
    int Behind; ///< corner
    int Front;  ///< corner
  };
  std::array<Piece, 12> pieces;
  int count = 0;
  for (int face = 0; face < 4; ++face)
  {
    const std::array<int, 3> c = { (face + 1) % 4, (face + 2) % 4, (face + 3) % 4 };
    const std::array<int, 3> group = { cell.Group[c[0]], cell.Group[c[1]], cell.Group[c[2]] };
    if (group[0] != group[1] && group[1] != group[2] && group[0] != group[2])
    {
      const int middle = this->VertexOn(cell.Corner[c[0]], cell.Corner[c[1]], cell.Corner[c[2]]);
      for (int n = 0; n < 3; ++n)
      {
        const int a = c[n];
        const int b = c[(n + 1) % 3];
        pieces[count++] = { this->VertexOn(cell.Corner[a], cell.Corner[b]), middle, a, b };
      }
      continue;
    }
    for (int n = 0; n < 3; ++n)
    {
      const int a = c[n];
      const int b = c[(n + 1) % 3];
      const int d = c[(n + 2) % 3];
      if (group[(n + 1) % 3] == group[(n + 2) % 3] && group[n] != group[(n + 1) % 3])
      {
        pieces[count++] = { this->VertexOn(cell.Corner[a], cell.Corner[b]),
          this->VertexOn(cell.Corner[a], cell.Corner[d]), a, b };
      }
    }
  }
  Vector middle;
  for (int n = 0; n < count; ++n)
  {
    middle += this->Mesh.Position[static_cast<std::size_t>(pieces[n].From)] +
      this->Mesh.Position[static_cast<std::size_t>(pieces[n].To)];
  }
  middle *= 0.5f / static_cast<float>(count);
  const int inside = this->Mesh.AddVertex(middle, Stratum::Interface);
  for (int n = 0; n < count; ++n)
  {
    this->AddTriangle({ pieces[n].From, pieces[n].To, inside }, cell.Corner[pieces[n].Behind],
      cell.Corner[pieces[n].Front]);
  }
}

float LatticeCutter::ValueAt(const std::array<int, 3>& halves, int object) const
{
  float sum = 0.f;
  int count = 0;
  this->ForVoxels(halves,
    [&](int i, int j, int k)
    {
      sum += this->Fields.At(object, i, j, k);
      ++count;
    });
  return sum / static_cast<float>(count);
}

float LatticeCutter::ShareOf(const LatticeSite& from, const LatticeSite& to) const
{
  const float first = this->ValueAt(from.At, from.Object) - this->ValueAt(from.At, to.Object);
  const float last = this->ValueAt(to.At, to.Object) - this->ValueAt(to.At, from.Object);
  const float both = first + last;
  return std::clamp(both > 0.f ? first / both : 0.5f, LeastShare, 1.f - LeastShare);
}

int LatticeCutter::VertexAt(const LatticeSite& site)
{
  const auto found = this->OnEdge.emplace(LatticeKey(site.At, site.At), -1);
  if (found.second)
  {
    found.first->second = this->Mesh.AddVertex(this->PlaceOf(site), Stratum::Interface);
  }
  return found.first->second;
}

int LatticeCutter::VertexOn(const LatticeSite& a, const LatticeSite& b)
{
  const bool isInOrder = IsBefore(a, b);
  const LatticeSite& from = isInOrder ? a : b;
  const LatticeSite& to = isInOrder ? b : a;
  const auto found = this->OnEdge.emplace(LatticeKey(a.At, b.At), -1);
  if (found.second)
  {
    Vector place = this->PlaceOf(from);
    place += (this->PlaceOf(to) - place) * this->ShareOf(from, to);
    found.first->second = this->Mesh.AddVertex(place, Stratum::Interface);
  }
  return found.first->second;
}

int LatticeCutter::VertexOn(const LatticeSite& a, const LatticeSite& b, const LatticeSite& c)
{
  const auto found = this->OnFace.emplace(LatticeKey(a.At, b.At, c.At), -1);
  if (found.second)
  {
    std::array<const LatticeSite*, 3> sites = { &a, &b, &c };
    std::sort(sites.begin(), sites.end(),
      [](const LatticeSite* p, const LatticeSite* q) { return IsBefore(*p, *q); });
    const LatticeSite* p = &a;
    const LatticeSite* q = &b;
    const LatticeSite* r = &c;
    // Of the vertices on the edges, so that it is no nearer to a corner than these are.
    if (this->Fields.HaveBox())
    {
      std::tie(p, q, r) = std::tie(sites[0], sites[1], sites[2]); // as on the opposite side
    }
    const std::array<int, 3> about = { this->VertexOn(*p, *q), this->VertexOn(*q, *r),
      this->VertexOn(*p, *r) };
    Vector middle;
    for (const int v : about)
    {
      middle += this->Mesh.Position[static_cast<std::size_t>(v)] * (1.f / 3.f);
    }
    found.first->second = this->Mesh.AddVertex(this->InSidesOf(sites, middle), Stratum::Interface);
  }
  return found.first->second;
}

void LatticeCutter::AddTriangle(
  const std::array<int, 3>& vertices, const LatticeSite& behind, const LatticeSite& front)
{
  const auto isOutside = [this](Number object) { return object == 0 || this->Mesh.IsSide(object); };
  if (isOutside(behind.Object) && isOutside(front.Object))
  {
    return;
  }
  InterfaceMesh::Face face = { vertices, std::min(behind.Object, front.Object),
    std::max(behind.Object, front.Object) };
  // An edge from one side to the other passes the plane.
  const VectorD way(this->PlaceOf(front) - this->PlaceOf(behind));
  const bool pointsToFront = Dot(this->Mesh.NormalOf(face), way) > 0.;
  if (pointsToFront != (behind.Object < front.Object))
  {
    std::swap(face.Vertex[1], face.Vertex[2]);
  }
  this->Mesh.AddFace(face);
}
}
