// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// A mesh that several ranks have in pieces, numbered and divided: as one rank does it.
#include "Core/Common/Select.h"
#include "Core/Evolution/EdgesToKeep.h"
#include "Core/Evolution/MeshPiece.h"
#include "Core/Evolution/RankNumbers.h"
#include "CoreTestTools.h"
#include "RankTestTools.h"
#include "ThreadRanks.h"

#include <mutex>

using namespace volumic;

namespace
{
constexpr double Cell = 0.8;
constexpr float Halo = 7.f; ///< More than three rings.

/** Two spheres and a torus, the vertices of which lie in no order, with free places between them. */
SurfaceMesh Scene()
{
  SurfaceMesh mesh = MakeSphere({ 12, 12, 12 }, 8, 1.5);
  mesh.Append(MakeSphere({ 30, 14, 12 }, 5, 1.5).ToIndexed());
  mesh.Append(MakeTorus({ 20, 32, 12 }, 9, 4, 40, 18));
  std::vector<int> order(mesh.Rings.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  mesh.Reorder(order);
  mesh.RemoveVertex(mesh.AddVertex(Vector(1, 1, 1)));
  return mesh;
}

/** A surface that is one mesh. */
void Take(SurfaceState& state, const SurfaceMesh& mesh)
{
  state.Mesh = mesh;
  state.Sizing = SizingField(1.f);
  state.Reset(Vector(-2, -2, -2), Vector(50, 50, 30));
}

std::vector<int> OwnOf(const SurfaceState& part, const OwnerOf& ownerOf, const Communicator& ranks)
{
  std::vector<int> own;
  for (int v = 0; v < part.Mesh.Size(); ++v)
  {
    if (part.Mesh.IsAlive(v) && ownerOf(v, ranks.NumberOfRanks()) == ranks.Rank())
    {
      own.push_back(v);
    }
  }
  return own;
}

/** What vertices are, put together from the pieces of all ranks. */
class Whole
{
public:
  explicit Whole(const SurfaceMesh& expected) : Expected(expected), Times(expected.Rings.size(), 0) {}

  /** On the thread of any rank. */
  void Take(const SurfaceMesh& piece, const std::vector<int>& vertices)
  {
    const std::lock_guard<std::mutex> lock(this->Taking);
    EXPECT_EQ(piece.Rings.size(), this->Expected.Rings.size());
    for (const int v : vertices)
    {
      ++this->Times[v];
      EXPECT_EQ(Length(piece.Position[v] - this->Expected.Position[v]), 0.f);
      const Ring& ring = piece.Rings[v];
      const Ring& wanted = this->Expected.Rings[v];
      EXPECT_EQ(std::vector<int>(ring.Item, ring.Item + ring.Count),
        std::vector<int>(wanted.Item, wanted.Item + wanted.Count));
    }
  }
  void ExpectEachOnce() const
  {
    EXPECT_EQ(this->Times, std::vector<int>(this->Expected.Rings.size(), 1));
  }

private:
  const SurfaceMesh& Expected;
  std::vector<int> Times;
  std::mutex Taking;
};

std::vector<int> AliveOf(const SurfaceMesh& mesh)
{
  return SelectIndices(
    OnThisThread(), mesh.Rings.size(), [&mesh](std::size_t v) { return mesh.Rings[v].Count > 0; });
}

/** For each number of ranks, and each way to share a mesh out, the piece of each rank. */
void ForPieces(const SurfaceMesh& mesh,
  const std::function<void(Communicator& ranks, const MeshPiece& piece)>& visit,
  const std::function<void()>& begin, const std::function<void()>& end)
{
  SurfaceState whole;
  Take(whole, mesh);
  for (const OwnerOf& ownerOf : { ByCubes(whole, 9.f), ByTurns(), AllOf(0), AllOf(1) })
  {
    for (const int count : { 2, 5 })
    {
      begin();
      ThreadRanks::Run(count,
        [&](Communicator& ranks)
        {
          SurfaceState part;
          TakePart(part, whole, ownerOf, ranks, Halo, Vector(-2, -2, -2), Vector(50, 50, 30));
          visit(ranks,
            RenumberOnRanks(
              ranks, part.Mesh, OwnOf(part, ownerOf, ranks), Cell, OnThisThread()));
        });
      end();
    }
  }
}

/** The numbers of kept edges of a mesh, as pairs of vertices. */
std::vector<std::array<int, 2>> KeptOf(
  const SurfaceMesh& mesh, const std::vector<int>& vertices, const KeptEdges& kept)
{
  std::vector<std::array<int, 2>> edges;
  for (const int v : vertices)
  {
    for (int i = 0; i < mesh.Rings[v].Count; ++i)
    {
      if (kept.Has(v, i))
      {
        edges.push_back({ v, mesh.Rings[v].Item[i] });
      }
    }
  }
  return edges;
}

/** Faces of the divided mesh, as if they intersected, here and there. */
std::vector<Proximity::FacePair> SomePairs(const SurfaceMesh& divided, int olds)
{
  std::vector<Proximity::FacePair> pairs;
  divided.VisitFaces(
    [&](int a, int b, int c)
    {
      if (a < olds && a % 97 == 0)
      {
        pairs.push_back({ { a, b, c }, { b, c, a } });
      }
    });
  return pairs;
}
}

TEST(MeshPiece, IsNumberedAsTheWhole)
{
  const SurfaceMesh mesh = Scene();
  const MeshPiece one = RenumberWhole(mesh, Cell, OnThisThread());
  ASSERT_EQ(one.Mesh.Size(), mesh.NumberOfVertices());
  ASSERT_GT(one.Mesh.Size(), 1500);
  EXPECT_EQ(DescribeBrokenInvariant(one.Mesh), "");
  std::unique_ptr<Whole> whole;
  ForPieces(
    mesh,
    [&](Communicator&, const MeshPiece& piece)
    {
      EXPECT_TRUE(std::is_sorted(piece.Own.begin(), piece.Own.end()));
      EXPECT_EQ(AliveOf(piece.Mesh).size(), piece.Own.size() + piece.Others.size());
      whole->Take(piece.Mesh, piece.Own);
      Whole(one.Mesh).Take(piece.Mesh, piece.Others);
    },
    [&] { whole = std::make_unique<Whole>(one.Mesh); }, [&] { whole->ExpectEachOnce(); });
}

TEST(MeshPiece, IsDividedAsTheWhole)
{
  const SurfaceMesh mesh = Scene();
  const MeshPiece one = RenumberWhole(mesh, Cell, OnThisThread());
  const SurfaceMesh divided = Divide(one.Mesh);
  std::unique_ptr<Whole> whole;
  ForPieces(
    mesh,
    [&](Communicator& ranks, const MeshPiece& piece)
    {
      const DivisionNumbers numbers =
        NumberForDivision(ranks, piece, nullptr, OnThisThread());
      EXPECT_EQ(numbers.Faces, one.Mesh.NumberOfFaces());
      const SurfaceMesh part = Divide(piece.Mesh, piece.Own, numbers);
      const std::vector<int> vertices = DividedOf(piece, numbers, nullptr);
      std::vector<int> sorted = vertices;
      std::sort(sorted.begin(), sorted.end());
      EXPECT_EQ(sorted, AliveOf(part)) << "nothing but what comes of own ones";
      whole->Take(part, vertices);
    },
    [&] { whole = std::make_unique<Whole>(divided); }, [&] { whole->ExpectEachOnce(); });
}

TEST(MeshPiece, KeepsTheEdgesThatTheWholeKeeps)
{
  const SurfaceMesh mesh = Scene();
  const MeshPiece one = RenumberWhole(mesh, Cell, OnThisThread());
  const std::vector<Proximity::FacePair> pairs =
    SomePairs(Divide(one.Mesh), one.Mesh.Size());
  ASSERT_GT(pairs.size(), 20u);
  const DivisionNumbers numbersOfOne = NumberForDivision(one.Mesh);
  std::size_t before = 0;
  for (const int round : { 0, 1, 3, EdgesToKeep::Rounds - 1 })
  {
    SCOPED_TRACE(round);
    KeptEdges keptOfOne(one.Mesh);
    EdgesToKeep(OnThisRank(), one, numbersOfOne, keptOfOne).KeepAbout(pairs, round);
    const std::size_t count = KeptOf(one.Mesh, one.Own, keptOfOne).size();
    EXPECT_GT(count, before) << "more and more";
    before = count;
    const SurfaceMesh divided = Divide(one.Mesh, &keptOfOne);
    EXPECT_EQ(DescribeBrokenInvariant(divided), "");
    std::unique_ptr<Whole> whole;
    ForPieces(
      mesh,
      [&](Communicator& ranks, const MeshPiece& piece)
      {
        const DivisionNumbers plain =
          NumberForDivision(ranks, piece, nullptr, OnThisThread());
        KeptEdges kept(piece.Mesh);
        EdgesToKeep(ranks, piece, plain, kept).KeepAbout(pairs, round);
        EXPECT_EQ(KeptOf(piece.Mesh, piece.Own, kept), KeptOf(one.Mesh, piece.Own, keptOfOne));
        const DivisionNumbers numbers =
          NumberForDivision(ranks, piece, &kept, OnThisThread());
        EXPECT_EQ(numbers.Middles, static_cast<int>(count / 2));
        whole->Take(Divide(piece.Mesh, piece.Own, numbers, &kept),
          DividedOf(piece, numbers, &kept));
      },
      [&] { whole = std::make_unique<Whole>(divided); }, [&] { whole->ExpectEachOnce(); });
  }
}

TEST(MeshPiece, HasRoomInRingsOnAllRanks)
{
  // Every other edge at the tips of two double cones: kept, they would overflow.
  constexpr int sides = Ring::Capacity;
  SurfaceMesh mesh;
  for (const double x : { 10., 30. })
  {
    IndexedSurface cone;
    cone.Points = { { x, 10, 12 }, { x, 10, 8 } };
    for (int i = 0; i < sides; ++i)
    {
      const double a = 2 * 3.14159265358979 * i / sides;
      const int next = 2 + (i + 1) % sides;
      cone.Points.push_back({ x + 2 * std::cos(a), 10 + 2 * std::sin(a), 10 });
      cone.Triangles.push_back({ 0, 2 + i, next });
      cone.Triangles.push_back({ 1, next, 2 + i });
    }
    mesh.Append(cone);
  }
  const MeshPiece one = RenumberWhole(mesh, Cell, OnThisThread());
  const auto keepSome = [&](KeptEdges& kept)
  {
    for (int v = 0; v < one.Mesh.Size(); ++v)
    {
      for (int i = 0; one.Mesh.Rings[v].Count == sides && i < sides; i += 2)
      {
        kept.Keep(v, one.Mesh.Rings[v].Item[i]);
      }
    }
  };
  const DivisionNumbers numbers = NumberForDivision(one.Mesh);
  KeptEdges keptOfOne(one.Mesh);
  keepSome(keptOfOne);
  ASSERT_EQ(keptOfOne.FindOverfull(one.Own).size(), 4u);
  EdgesToKeep(OnThisRank(), one, numbers, keptOfOne).KeepAbout({}, 0);
  EXPECT_TRUE(keptOfOne.FindOverfull(one.Own).empty());
  ForPieces(
    mesh,
    [&](Communicator& ranks, const MeshPiece& piece)
    {
      KeptEdges kept(piece.Mesh);
      keepSome(kept);
      EdgesToKeep(ranks, piece, NumberForDivision(ranks, piece, nullptr, OnThisThread()), kept)
        .KeepAbout({}, 0);
      EXPECT_EQ(KeptOf(piece.Mesh, piece.Own, kept), KeptOf(one.Mesh, piece.Own, keptOfOne));
    },
    [] {}, [] {});
}

TEST(MeshPiece, NeedsThreeRingsOfOthers)
{
  const SurfaceMesh mesh = Scene();
  SurfaceState whole;
  Take(whole, mesh);
  const OwnerOf ownerOf = ByCubes(whole, 9.f);
  for (const float halo : { 2.f, 4.f }) // Nearly one, more than two.
  {
    EXPECT_THROW(ThreadRanks::Run(2,
                   [&](Communicator& ranks)
                   {
                     SurfaceState part;
                     TakePart(part, whole, ownerOf, ranks, halo, Vector(-2, -2, -2),
                       Vector(50, 50, 30));
                     RenumberOnRanks(
                       ranks, part.Mesh, OwnOf(part, ownerOf, ranks), Cell, OnThisThread());
                   }),
      std::logic_error);
  }
}
