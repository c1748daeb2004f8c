// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Executor.h"
#include "Core/Surface/SurfaceEditor.h"
#include "CoreTestTools.h"

#include "Core/Mesh/CycleCut.h"
#include "Core/Mesh/EdgeCollapse.h"
#include "Core/Mesh/EdgeFlip.h"
#include "Core/Mesh/EdgeSplit.h"
#include "Core/Mesh/StarMerge.h"
#include "Core/Mesh/VertexRemoval.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

using namespace volumic;

namespace
{
/** Picks alive vertices, edges and 3-cycles at random. */
class Dice
{
public:
  Dice(const SurfaceMesh& mesh, unsigned seed)
    : Mesh(mesh)
    , Engine(seed)
  {
  }
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

SurfaceMesh RandomMesh(unsigned seed)
{
  SurfaceMesh mesh;
  mesh.Append(MakeTorus({ 0, 0, 0 }, 6, 2, 12 + static_cast<int>(seed % 5), 7));
  mesh.Append(DividedIcosahedron({ 20, 0, 0 }, 4, 2));
  return mesh;
}
}

TEST(RandomEdits, OfTheConnectivityKeepEveryInvariantAndCountChi)
{
  int done[6] = {};
  for (unsigned seed = 1; seed <= 4; ++seed)
  {
    SurfaceMesh mesh = RandomMesh(seed);
    Dice dice(mesh, seed);
    int chi = mesh.CountEulerCharacteristic();
    for (int step = 0; step < 1500 && mesh.NumberOfVertices() > 30; ++step)
    {
      const int v = dice.Vertex();
      const int w = dice.Neighbour(v);
      const int kind = dice.Number(6);
      bool legal = false;
      if (kind == 0)
      {
        const EdgeFlip flip = EdgeFlip::Of(mesh, v, w);
        if ((legal = flip.IsLegal(mesh)))
        {
          flip.Apply(mesh);
        }
      }
      else if (kind == 1)
      {
        const EdgeSplit split{ v, w };
        if ((legal = split.IsLegal(mesh)))
        {
          split.Apply(mesh, (mesh.Position[v] + mesh.Position[w]) * 0.5f);
        }
      }
      else if (kind == 2)
      {
        const EdgeCollapse collapse{ v, w };
        if ((legal = collapse.IsLegal(mesh)))
        {
          collapse.Apply(mesh);
        }
      }
      else if (kind == 3)
      {
        const VertexRemoval removal{ v };
        if ((legal = removal.IsLegal(mesh)))
        {
          removal.Apply(mesh);
        }
      }
      else if (kind == 4)
      {
        StarMerge merge;
        merge.U = v;
        merge.V = dice.Vertex();
        if ((legal = merge.U != merge.V && step % 20 == 0 && merge.Plan(mesh)))
        {
          merge.Apply(mesh);
          chi -= 2;
        }
      }
      else
      {
        const int c = EdgeCollapse{ v, w }.ThirdCommonNeighbour(mesh);
        const CycleCut cut{ v, w, c };
        if ((legal = c >= 0 && cut.IsLegal(mesh)))
        {
          cut.Apply(mesh);
          chi += 2;
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
    EXPECT_GT(done[kind], 5) << "kind " << kind << " was hardly tried";
  }
}

TEST(RandomEdits, VerifiedOnesNeverMakeTheSurfaceIntersectItself)
{
  SequentialExecutor threads;
  int edits = 0;
  for (unsigned seed = 1; seed <= 3; ++seed)
  {
    SurfaceState state;
    state.Mesh.Append(MakeTorus({ 0, 0, 0 }, 4, 1.3, 18, 6));
    state.Mesh.Append(DividedIcosahedron({ 0, 0, 0 }, 1.6, 1.2));
    state.Sizing = SizingField(1);
    state.Reset(Vector(-10, -10, -10), Vector(10, 10, 10));
    std::vector<int> all(state.Mesh.Size());
    std::iota(all.begin(), all.end(), 0);
    state.UpdateShape(all, threads);
    SurfaceEditor editor(state);
    Dice dice(state.Mesh, seed);
    for (int step = 0; step < 800 && state.Mesh.NumberOfVertices() > 20; ++step)
    {
      const int v = dice.Vertex();
      const int w = dice.Neighbour(v);
      const Vector shake(0.01f * (dice.Number(61) - 30), 0.01f * (dice.Number(61) - 30),
        0.01f * (dice.Number(61) - 30));
      bool did = false;
      switch (dice.Number(8))
      {
        case 0:
          did = editor.Flip(v, w, EditTolerance::Smooth).IsDone;
          break;
        case 1:
          did = editor.Flip(v, w, EditTolerance::Loose).IsDone;
          break;
        case 2:
          did = step % 3 != 0 && editor.Split(v, w).IsDone;
          break;
        case 3:
          did = editor.Collapse(v, w, EditTolerance::Loose).IsDone;
          break;
        case 4:
          did = editor.Remove(v).IsDone;
          break;
        case 5:
          did = editor.Move(v, state.Mesh.Position[v] + shake, EditTolerance::Loose).IsDone;
          break;
        case 6:
          did = editor.Merge(v, dice.Vertex()).IsDone;
          break;
        default:
          did = editor.Cut(v, w, EdgeCollapse{ v, w }.ThirdCommonNeighbour(state.Mesh)).IsDone;
      }
      if (did)
      {
        ++edits;
        ASSERT_EQ(DescribeBrokenInvariant(state.Mesh), "") << "step " << step;
        ASSERT_EQ(state.Mesh.CountEulerCharacteristic(), state.EulerCharacteristic);
        ASSERT_EQ(CountSelfIntersections(state.Mesh.ToIndexed(), 1), 0) << "step " << step;
      }
    }
  }
  EXPECT_GT(edits, 300);
}
