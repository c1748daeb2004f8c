// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/Remesher.h"
#include "Core/Surface/SurfaceEditor.h"
#include "LiveSurface.h"

#include "Core/Mesh/CycleCut.h"
#include "Core/Mesh/EdgeCollapse.h"
#include "Core/Mesh/EdgeFlip.h"
#include "Core/Mesh/EdgeSplit.h"
#include "Core/Mesh/StarMerge.h"
#include "Core/Mesh/VertexRemoval.h"

using namespace volumic;

namespace
{
/** Selects random alive vertices, edges and 3-cycles. */
class Dice
{
public:
  Dice(const SurfaceMesh& mesh, unsigned seed) : Mesh(mesh), Engine(seed) {}
  int Number(int n) { return static_cast<int>(this->Engine() % static_cast<unsigned>(n)); }
  int Vertex()
  {
    int v = this->Number(this->Mesh.Size());
    while (!this->Mesh.IsAlive(v))
    {
      v = this->Number(this->Mesh.Size());
    }
    return v;
  }
  int Neighbour(int v) { return this->Mesh.Rings[v].Item[this->Number(this->Mesh.Rings[v].Count)]; }

private:
  const SurfaceMesh& Mesh;
  std::mt19937 Engine;
};

/** Try a random edit. Return whether it was made. */
bool TryAny(SurfaceEditor& editor, SurfaceState& state, Dice& dice, int step)
{
  const int v = dice.Vertex();
  const int w = dice.Neighbour(v);
  const Vector shake(
    0.01f * (dice.Number(61) - 30), 0.01f * (dice.Number(61) - 30), 0.01f * (dice.Number(61) - 30));
  switch (dice.Number(8))
  {
    case 0:
      return editor.Flip(v, w, EditTolerance::Smooth).IsDone;
    case 1:
      return editor.Flip(v, w, EditTolerance::Loose).IsDone;
    case 2:
      return step % 3 != 0 && editor.Split(v, w).IsDone;
    case 3:
      return editor.Collapse(v, w, EditTolerance::Loose).IsDone;
    case 4:
      return editor.Remove(v).IsDone;
    case 5:
      return editor.Move(v, state.Mesh.Position[v] + shake, EditTolerance::Loose).IsDone;
    case 6:
      return editor.Merge(v, dice.Vertex()).IsDone;
    default:
      return editor.Cut(v, w, EdgeCollapse{ v, w }.ThirdCommonNeighbour(state.Mesh)).IsDone;
  }
}

int EditsOf(const EditCounts& counts)
{
  return counts.Splits + counts.Collapses + counts.Flips + counts.Cuts;
}

/** Run the remesher until no edit is made. Check the surface after each pass. */
void RemeshUntilConverged(LiveSurface& bench)
{
  int before = -1;
  for (int round = 0; before != EditsOf(bench.Counts); ++round)
  {
    ASSERT_LT(round, 8) << "edits undo each other";
    before = EditsOf(bench.Counts);
    Remesher remesher(bench, nullptr, true);
    std::vector<int> vertices = bench.All();
    bench.UpdateShape();
    remesher.Split(vertices);
    ASSERT_TRUE(bench.IsSound()) << "splits of round " << round;
    bench.UpdateShape();
    remesher.Collapse(bench.All());
    ASSERT_TRUE(bench.IsSound()) << "collapses of round " << round;
    bench.UpdateShape();
    remesher.Flip(bench.All());
    ASSERT_TRUE(bench.IsSound()) << "flips of round " << round;
  }
}

/** The parameter is the gradation of the sizes in per cent; 0: uniform delta. */
class RandomVerifiedEdits : public ::testing::TestWithParam<int>
{
protected:
  static float Gradation() { return 0.01f * static_cast<float>(GetParam()); }

  /** Set sizes that vary from 1 to 2.5 in waves, with the gradation as maximum slope. */
  void Grade(LiveSurface& bench, Dice& dice) const
  {
    if (GetParam() == 0)
    {
      return;
    }
    SurfaceState& s = bench;
    const float half = 0.75f;
    const Vector from = s.Mesh.Position[dice.Vertex()];
    const Vector along = Normalized(s.Mesh.Position[dice.Vertex()] - from);
    for (const int v : bench.All())
    {
      const float distance = Dot(s.Mesh.Position[v] - from, along);
      s.Size[v] = 1 + half + half * std::sin(this->Gradation() / half * distance);
    }
    s.Sizing = s.Sizing.Graded(s.Size.AsVector(), 1 + 2 * half, this->Gradation());
    bench.UpdateShape();
  }

  /** Check that few edges violate their bounds, and none is too long for delta of either end. */
  void ExpectLegalEdges(const LiveSurface& bench) const
  {
    const SurfaceState& s = bench;
    const float g = this->Gradation();
    // delta of an edge is the mean of its ends: length <= 2.5 (delta_u + g length / 2).
    const float longest = 2.5f / (1 - 1.25f * g);
    int edges = 0, outside = 0;
    for (const int u : bench.All())
    {
      for (int i = 0; i < s.Mesh.Rings[u].Count; ++i, ++edges)
      {
        const int v = s.Mesh.Rings[u].Item[i];
        const float length = Length(s.Mesh.Position[v] - s.Mesh.Position[u]);
        EXPECT_LE(std::abs(s.Sizing.At(u) - s.Sizing.At(v)), 1.1f * g * length);
        EXPECT_LE(length, longest * s.Sizing.At(u));
        outside += s.Sizing.InDelta(u, v, length) < 1 || s.Sizing.InDelta(u, v, length) > 2.5f;
      }
    }
    EXPECT_LE(outside, 0.005 * edges);
  }
};
}

TEST(RandomEdits, PreserveInvariantsAndEulerCharacteristic)
{
  int done[6] = {};
  for (unsigned seed = 1; seed <= 4; ++seed)
  {
    SurfaceMesh mesh = MeshOf(MakeTorus({ 0, 0, 0 }, 6, 2, 12 + static_cast<int>(seed), 7));
    mesh.Append(DividedIcosahedron({ 20, 0, 0 }, 4, 2));
    Dice dice(mesh, seed);
    int chi = mesh.CountEulerCharacteristic();
    for (int step = 0; step < 1500 && mesh.NumberOfVertices() > 30; ++step)
    {
      const int v = dice.Vertex();
      const int w = dice.Neighbour(v);
      const int kind = dice.Number(6);
      const auto isDone = [&mesh](auto edit, auto... arguments)
      {
        const bool isLegal = edit.IsLegal(mesh);
        if (isLegal)
        {
          edit.Apply(mesh, arguments...);
        }
        return isLegal;
      };
      bool legal = false;
      switch (kind)
      {
        case 0:
          legal = isDone(EdgeFlip::Of(mesh, v, w));
          break;
        case 1:
          legal = isDone(EdgeSplit{ v, w }, (mesh.Position[v] + mesh.Position[w]) * 0.5f);
          break;
        case 2:
          legal = isDone(EdgeCollapse{ v, w });
          break;
        case 3:
          legal = isDone(VertexRemoval{ v });
          break;
        case 4:
        {
          StarMerge merge;
          merge.U = v;
          merge.V = dice.Vertex();
          legal = merge.U != merge.V && step % 20 == 0 && merge.Plan(mesh);
          if (legal)
          {
            merge.Apply(mesh);
            chi -= 2;
          }
          break;
        }
        default:
        {
          const int c = EdgeCollapse{ v, w }.ThirdCommonNeighbour(mesh);
          legal = c >= 0 && isDone(CycleCut{ v, w, c });
          chi += legal ? 2 : 0;
        }
      }
      done[kind] += legal;
      if (legal)
      {
        ASSERT_EQ(DescribeBrokenInvariant(mesh), "") << "kind " << kind << " step " << step;
        ASSERT_EQ(mesh.CountEulerCharacteristic(), chi) << "kind " << kind << " step " << step;
      }
    }
  }
  for (int kind = 0; kind < 6; ++kind)
  {
    EXPECT_GT(done[kind], 5) << "kind " << kind << " was tried too rarely";
  }
}

TEST_P(RandomVerifiedEdits, NeverCauseSelfIntersections)
{
  int edits = 0;
  for (unsigned seed = 1; seed <= 3; ++seed)
  {
    IndexedSurface surface = MakeTorus({ 0, 0, 0 }, 4, 1.3, 18, 6);
    AddSurface(surface, DividedIcosahedron({ 0, 0, 0 }, 1.6, 1.2));
    LiveSurface bench(surface);
    Dice dice(bench.Mesh, seed);
    this->Grade(bench, dice);
    SurfaceEditor editor(bench);
    for (int step = 0; step < 800 && bench.Mesh.NumberOfVertices() > 20; ++step)
    {
      if (TryAny(editor, bench, dice, step))
      {
        ++edits;
        ASSERT_TRUE(bench.IsSound()) << "step " << step;
      }
    }
  }
  EXPECT_GT(edits, 300);
}

TEST_P(RandomVerifiedEdits, RemesherConvergesAfterwards)
{
  for (unsigned seed = 1; seed <= 3; ++seed)
  {
    SCOPED_TRACE(seed);
    LiveSurface bench(MakeTorus({ 10, 10, 10 }, 16, 6, 80, 30));
    SurfaceState& s = bench;
    Dice dice(s.Mesh, seed);
    this->Grade(bench, dice);
    for (int turn = 0; turn < 2; ++turn) // The second turn begins with legal edges.
    {
      SurfaceEditor editor(s);
      for (int step = 0; step < 200; ++step)
      {
        const bool isDone = TryAny(editor, s, dice, step);
        ASSERT_TRUE(!isDone || bench.IsSound()) << "step " << step << " of turn " << turn;
      }
      RemeshUntilConverged(bench);
      ASSERT_FALSE(HasFatalFailure());
      this->ExpectLegalEdges(bench);
    }
    EXPECT_GT(EditsOf(s.Counts), 300);
  }
}

INSTANTIATE_TEST_SUITE_P(WithAGradationOf, RandomVerifiedEdits, ::testing::Values(0, 20, 30),
  [](const ::testing::TestParamInfo<int>& info) { return std::to_string(info.param) + "Percent"; });
