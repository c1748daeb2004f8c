// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/LatticeCutter.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace volumic
{
namespace
{
/** Vertices keep this share of their edge from its ends. */
constexpr float LeastShare = 0.15f;

/** Which of the directions of the lattice's edges leads from one site to a later one. */
std::uint64_t DirectionTo(const LatticeSite& from, const LatticeSite& to)
{
  std::uint64_t code = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    code = 5 * code + static_cast<std::uint64_t>(to.At[axis] - from.At[axis] + 2);
  }
  return code; // below 5^3
}

bool IsBefore(const LatticeSite& a, const LatticeSite& b)
{
  return std::tie(a.At[2], a.At[1], a.At[0]) < std::tie(b.At[2], b.At[1], b.At[0]);
}
}

/** The corners of a tetrahedron, and which of them are of one object. */
struct Tetrahedron
{
  std::array<LatticeSite, 4> Corner;
  std::array<int, 4> Group = { 0, 0, 0, 0 }; ///< of each corner, the objects numbered from 0
  int Groups = 0;

  void FindGroups()
  {
    this->Groups = 0;
    for (int c = 0; c < 4; ++c)
    {
      int same = 0;
      while (same < c && this->Corner[same].Object != this->Corner[c].Object)
      {
        ++same;
      }
      this->Group[c] = same < c ? this->Group[same] : this->Groups++;
    }
  }
};

void LatticeCutter::FindMiddles(Executor& executor)
{
  this->ObjectOfMiddle.resize(static_cast<std::size_t>(this->Middles.Count()));
  ForBlocks(executor, static_cast<std::size_t>(this->Middles.Length(2)), 1,
    [&](std::size_t layer, std::size_t, std::size_t)
    {
      const int k = static_cast<int>(layer);
      std::size_t at = static_cast<std::size_t>(this->Middles.NumberOf(0, 0, k));
      for (int j = 0; j < this->Middles.End[1]; ++j)
      {
        for (int i = 0; i < this->Middles.End[0]; ++i)
        {
          this->ObjectOfMiddle[at++] = this->Pitch == 1
            ? this->ObjectBetween(i, j, k)
            : this->ObjectOf({ 2 * i + 1, 2 * j + 1, 2 * k + 1 });
        }
      }
    });
}

LatticeCutter::Number LatticeCutter::ObjectBetween(int i, int j, int k) const
{
  std::array<Number, 8> about;
  bool isSame = true;
  for (int c = 0; c < 8; ++c)
  {
    about[static_cast<std::size_t>(c)] =
      this->Map.At(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1));
    isSame = isSame && about[static_cast<std::size_t>(c)] == about[0];
  }
  if (isSame)
  {
    return about[0];
  }
  std::sort(about.begin(), about.end());
  const auto* end = std::unique(about.begin(), about.end());
  Number best = about[0];
  float most = -std::numeric_limits<float>::max();
  for (const auto* object = about.begin(); object != end; ++object)
  {
    float sum = 0.f;
    for (int c = 0; c < 8; ++c)
    {
      sum += this->Fields.At(*object, i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1));
    }
    if (sum > most)
    {
      best = *object;
      most = sum;
    }
  }
  return best;
}

LatticeCutter::Number LatticeCutter::ObjectOf(const std::array<int, 3>& voxel) const
{
  return this->Map.Voxels[static_cast<std::size_t>(
    VoxelBox::Of(this->Map.Size).NumberOf(voxel[0], voxel[1], voxel[2]))];
}

void LatticeCutter::FollowFields(Executor& executor)
{
  constexpr int side = LabelBricks::Side;
  ForBlocks(executor, static_cast<std::size_t>(this->Map.Size[2]), 1,
    [&](std::size_t layer, std::size_t, std::size_t)
    {
      const int k = static_cast<int>(layer);
      for (int j = 0; j < this->Map.Size[1]; ++j)
      {
        for (int i = 0; i < this->Map.Size[0]; ++i)
        {
          if (this->Fields.HasInterfaces(i / side, j / side, k / side))
          {
            this->Map.Voxels[static_cast<std::size_t>(
              VoxelBox::Of(this->Map.Size).NumberOf(i, j, k))] = this->Fields.LargestAt(i, j, k);
          }
        }
      }
    });
}

LatticeSite LatticeCutter::SiteAt(const std::array<int, 3>& halves) const
{
  const std::array<int, 3> cube = { halves[0] >> 1, halves[1] >> 1, halves[2] >> 1 };
  return { halves,
    (halves[0] & 1) != 0 ? this->ObjectOfMiddle[static_cast<std::size_t>(
                             this->Middles.NumberOf(cube[0], cube[1], cube[2]))]
                         : this->ObjectOf({ this->Pitch * cube[0], this->Pitch * cube[1],
                             this->Pitch * cube[2] }) };
}

void LatticeCutter::CutBrick(int i, int j, int k)
{
  const int side = LabelBricks::Side / this->Pitch;
  for (int z = k * side; z < std::min((k + 1) * side, this->Corners[2]); ++z)
  {
    for (int y = j * side; y < std::min((j + 1) * side, this->Corners[1]); ++y)
    {
      for (int x = i * side; x < std::min((i + 1) * side, this->Corners[0]); ++x)
      {
        this->CutAbout({ x, y, z });
      }
    }
  }
}

void LatticeCutter::CutAbout(const std::array<int, 3>& cube)
{
  // Each tetrahedron has one edge between corners of cubes, and one between middles of cubes: it belongs to
  // the lower end of the former.
  for (int axis = 0; axis < 3; ++axis)
  {
    const int first = (axis + 1) % 3;
    const int second = (axis + 2) % 3;
    if (cube[axis] + 1 >= this->Corners[axis] || cube[first] < 1 || cube[second] < 1 ||
      cube[first] + 1 >= this->Corners[first] || cube[second] + 1 >= this->Corners[second])
    {
      continue; // All is of one object there.
    }
    std::array<int, 3> halves = { 2 * cube[0], 2 * cube[1], 2 * cube[2] };
    const LatticeSite own = this->SiteAt(halves);
    halves[axis] += 2;
    const LatticeSite next = this->SiteAt(halves);
    halves[axis] -= 1;
    std::array<LatticeSite, 4> about;
    bool isSame = own.Object == next.Object;
    for (int turn = 0; turn < 4; ++turn)
    {
      std::array<int, 3> middle = halves;
      middle[first] += turn == 0 || turn == 3 ? -1 : 1;
      middle[second] += turn == 0 || turn == 1 ? -1 : 1;
      about[turn] = this->SiteAt(middle);
      isSame = isSame && about[turn].Object == own.Object;
    }
    for (int turn = 0; turn < 4 && !isSame; ++turn)
    {
      Tetrahedron cell;
      cell.Corner = { own, next, about[turn], about[(turn + 1) % 4] };
      cell.FindGroups();
      this->Cut(cell);
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
      const int middle =
        this->VertexOn(cell.Corner[c[0]], cell.Corner[c[1]], cell.Corner[c[2]]);
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
  const int inside =
    this->Mesh.AddVertex(middle * (0.5f / static_cast<float>(count)), Stratum::Interface);
  for (int n = 0; n < count; ++n)
  {
    this->AddTriangle({ pieces[n].From, pieces[n].To, inside }, cell.Corner[pieces[n].Behind],
      cell.Corner[pieces[n].Front]);
  }
}

float LatticeCutter::ValueAt(const LatticeSite& site, int object) const
{
  // In halves of voxels; with a pitch of 2 all sites are voxels.
  const int i = this->Pitch * site.At[0] >> 1;
  const int j = this->Pitch * site.At[1] >> 1;
  const int k = this->Pitch * site.At[2] >> 1;
  if (this->Pitch == 2 || (site.At[0] & 1) == 0)
  {
    return this->Fields.At(object, i, j, k);
  }
  float sum = 0.f;
  for (int c = 0; c < 8; ++c)
  {
    sum += this->Fields.At(object, i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1));
  }
  return 0.125f * sum;
}

Vector LatticeCutter::PlaceOf(const LatticeSite& site) const
{
  const std::array<double, 3>& step = this->Fields.Step();
  const double half = 0.5 * this->Pitch;
  return Vector(static_cast<float>(half * step[0] * site.At[0]),
    static_cast<float>(half * step[1] * site.At[1]),
    static_cast<float>(half * step[2] * site.At[2]));
}

LatticeCutter::Key LatticeCutter::KeyOf(const LatticeSite& site) const
{
  const Key x = static_cast<Key>(site.At[0]);
  const Key y = static_cast<Key>(site.At[1]);
  const Key z = static_cast<Key>(site.At[2]);
  return x + static_cast<Key>(2 * this->Map.Size[0]) * (y + static_cast<Key>(2 * this->Map.Size[1]) * z);
}

int LatticeCutter::VertexOn(const LatticeSite& a, const LatticeSite& b)
{
  const bool isInOrder = IsBefore(a, b);
  const LatticeSite& from = isInOrder ? a : b;
  const LatticeSite& to = isInOrder ? b : a;
  const auto found = this->OnEdge.emplace(this->KeyOf(from) * 128 + DirectionTo(from, to), -1);
  if (found.second)
  {
    const float first = this->ValueAt(from, from.Object) - this->ValueAt(from, to.Object);
    const float last = this->ValueAt(to, to.Object) - this->ValueAt(to, from.Object);
    const float both = first + last;
    const float share =
      std::clamp(both > 0.f ? first / both : 0.5f, LeastShare, 1.f - LeastShare);
    const Vector place = this->PlaceOf(from);
    found.first->second = this->Mesh.AddVertex(
      place + (this->PlaceOf(to) - place) * share, Stratum::Interface);
  }
  return found.first->second;
}

int LatticeCutter::VertexOn(const LatticeSite& a, const LatticeSite& b, const LatticeSite& c)
{
  std::array<const LatticeSite*, 3> sites = { &a, &b, &c };
  std::sort(sites.begin(), sites.end(),
    [](const LatticeSite* p, const LatticeSite* q) { return IsBefore(*p, *q); });
  const Key key = (this->KeyOf(*sites[0]) * 128 + DirectionTo(*sites[0], *sites[1])) * 128 +
    DirectionTo(*sites[0], *sites[2]);
  const auto found = this->OnFace.emplace(key, -1);
  if (found.second)
  {
    // Of the vertices on the edges, so that it is no nearer to a corner than these are.
    const std::array<int, 3> about = { this->VertexOn(a, b), this->VertexOn(b, c),
      this->VertexOn(a, c) };
    Vector middle;
    for (const int v : about)
    {
      middle += this->Mesh.Position[static_cast<std::size_t>(v)] * (1.f / 3.f);
    }
    found.first->second = this->Mesh.AddVertex(middle, Stratum::Interface);
  }
  return found.first->second;
}

void LatticeCutter::AddTriangle(
  const std::array<int, 3>& vertices, const LatticeSite& behind, const LatticeSite& front)
{
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
