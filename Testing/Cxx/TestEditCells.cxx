// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Edits in cells: each item once, in order; the same surface whatever the threads do.
#include "Core/Surface/EditCells.h"
#include "Core/Surface/Remesher.h"
#include "RemeshTestTools.h"
#include "ThreadTestTools.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <set>

using namespace volumic;

namespace
{
/** Large enough for some cells of each colour. */
constexpr double Radius = 34;

IndexedSurface LargeSphere(double edge)
{
  return DividedIcosahedron({ 10, 10, 10 }, Radius, edge);
}

/** All vertices are shaken, by up to `by` along each axis, each time in the same way. */
void Shake(Bench& bench, float by)
{
  std::uint32_t number = 1;
  const auto next = [&number, by]
  {
    number = number * 1664525u + 1013904223u;
    return by * (static_cast<float>(number >> 8) / (1 << 23) - 1.f);
  };
  for (int v : bench.All())
  {
    bench.State.MoveTo(v, bench.State.Mesh.Position[v] + Vector(next(), next(), next()));
  }
  bench.UpdateShape();
}

std::uint64_t HashOf(const Bench& bench)
{
  const IndexedSurface surface = bench.State.Mesh.ToIndexed();
  return volumic::HashOf(surface.Triangles, volumic::HashOf(surface.Points));
}
}

TEST(EditCells, VisitEachItemOnceAndThoseThatAreAdded)
{
  Bench bench(LargeSphere(1.6));
  StandardThreads threads(3);
  EditCells cells(bench.State, threads);
  const int n = bench.State.Mesh.Size();
  std::vector<std::atomic<int>> visits(static_cast<std::size_t>(n));
  std::mutex mutex;
  std::set<const SurfaceEditor*> editors;
  EditCells::Pass pass;
  pass.Items = bench.All();
  pass.Items.resize(static_cast<std::size_t>(n) / 2);
  pass.Visit = [&](SurfaceEditor& editor, int v, EditCells::Lists& lists)
  {
    ++visits[v];
    if (v < n / 2)
    {
      lists.Items.push_back(v + n / 2);
    }
    lists.Kept.push_back(v);
    const std::lock_guard<std::mutex> lock(mutex);
    editors.insert(&editor);
  };
  cells.Run(pass);
  for (int v = 0; v < n / 2 * 2; ++v)
  {
    EXPECT_EQ(visits[v], 1) << v;
  }
  EXPECT_GT(editors.size(), 3u); // At the same time: one each.
  EXPECT_EQ(cells.Added().size(), static_cast<std::size_t>(n / 2));
  EXPECT_EQ(cells.Kept().size(), static_cast<std::size_t>(n / 2) * 2);
}

TEST(EditCells, KeepTheOrderOfItemsThatAreNear)
{
  Bench bench(DividedIcosahedron({ 10, 10, 10 }, 3, 1.6)); // One cell, or a few.
  SequentialExecutor thread;
  EditCells cells(bench.State, thread);
  EditCells::Pass pass;
  pass.Items = { 7, 3, 12, 5 };
  pass.VertexOf = [](int) { return 0; };
  pass.Visit = [](SurfaceEditor&, int v, EditCells::Lists& lists) { lists.Kept.push_back(v); };
  cells.Run(pass);
  EXPECT_EQ(cells.Kept(), pass.Items);
}

TEST(EditCells, RefuseWhatIsFarFromTheCell)
{
  Bench bench(LargeSphere(1.6));
  SequentialExecutor thread;
  EditCells cells(bench.State, thread);
  const int far = bench.Nearest(Vector(10 + Radius, 10, 10), 0, bench.State.Mesh.Size());
  const int near = bench.Nearest(Vector(10 - Radius, 10, 10), 0, bench.State.Mesh.Size());
  int visits = 0;
  EditCells::Pass pass;
  pass.PlacesPerCell = 4;
  pass.Items = { near };
  pass.Visit = [&](SurfaceEditor& editor, int, EditCells::Lists&)
  {
    ++visits;
    EXPECT_FALSE(editor.Split(far, bench.State.Mesh.Rings[far].Item[0]));
    EXPECT_FALSE(editor.Collapse(near, far, EditTolerance::Loose));
    EXPECT_FALSE(editor.Flip(far, bench.State.Mesh.Rings[far].Item[0], EditTolerance::Smooth));
    EXPECT_FALSE(editor.Move(far, bench.State.Mesh.Position[far], EditTolerance::Loose));
    EXPECT_FALSE(editor.Merge(near, far));
  };
  cells.Run(pass);
  EXPECT_EQ(visits, 1); // Nothing has changed: it would be refused again.
  EXPECT_TRUE(cells.Changed().empty());
}

TEST(EditCells, GivePlacesUntilAllItemsHaveTheirs)
{
  Bench bench(LargeSphere(1.6));
  StandardThreads threads(2);
  EditCells cells(bench.State, threads);
  const int before = bench.State.Mesh.NumberOfVertices();
  EditCells::Pass pass;
  pass.PlacesPerCell = 3; // For far more items than that.
  for (int v : bench.All())
  {
    if (v % 9 == 0)
    {
      pass.Items.push_back(v);
    }
  }
  std::vector<std::uint8_t> isDone(bench.State.Mesh.Rings.size(), 0);
  pass.Visit = [&](SurfaceEditor& editor, int v, EditCells::Lists&)
  {
    if (!isDone[v] && editor.Split(v, bench.State.Mesh.Rings[v].Item[0]))
    {
      isDone[v] = 1;
    }
  };
  cells.Run(pass);
  const int splits = static_cast<int>(std::count(isDone.begin(), isDone.end(), 1));
  EXPECT_EQ(splits, static_cast<int>(pass.Items.size()));
  EXPECT_EQ(bench.State.Mesh.NumberOfVertices(), before + splits);
  EXPECT_EQ(bench.State.Counts.Splits, splits);
  EXPECT_TRUE(bench.IsSound());
  // What was given away and not used is nobody's: neither active nor counted.
  for (int v = 0; v < bench.State.Mesh.Size(); ++v)
  {
    EXPECT_EQ(bench.State.Active[v] != 0, bench.State.Mesh.IsAlive(v)) << v;
  }
}

TEST(EditCells, EndWherePlacesAreNeverEnough)
{
  Bench bench(LargeSphere(2.6));
  SequentialExecutor thread;
  EditCells cells(bench.State, thread);
  EditCells::Pass pass; // Gives none.
  pass.Items = bench.All();
  pass.Visit = [&](SurfaceEditor& editor, int v, EditCells::Lists&)
  { EXPECT_FALSE(editor.Split(v, bench.State.Mesh.Rings[v].Item[0])); };
  cells.Run(pass);
  EXPECT_TRUE(cells.Changed().empty());
}

TEST(EditCells, TakeNoPlaceOfAVertexThatTheSamePassHasRemoved)
{
  Bench bench(LargeSphere(1.6));
  StandardThreads threads(3);
  EditCells cells(bench.State, threads);
  std::mutex mutex;
  std::set<int> removed;
  std::set<int> added;
  EditCells::Pass pass;
  pass.Items = bench.All();
  pass.PlacesPerItem = 1;
  pass.Visit = [&](SurfaceEditor& editor, int v, EditCells::Lists&)
  {
    SurfaceMesh& mesh = bench.State.Mesh;
    if (!mesh.IsAlive(v))
    {
      return;
    }
    const int w = mesh.Rings[v].Item[0];
    const Edit edit =
      v % 2 == 0 ? editor.Collapse(v, w, EditTolerance::Loose) : editor.Split(v, w);
    const std::lock_guard<std::mutex> lock(mutex);
    if (edit && v % 2 == 0)
    {
      removed.insert(w);
    }
    else if (edit)
    {
      added.insert(edit.Vertex);
    }
  };
  cells.Run(pass);
  EXPECT_GT(removed.size(), 50u);
  EXPECT_GT(added.size(), 50u);
  for (int v : added)
  {
    EXPECT_EQ(removed.count(v), 0u) << v;
  }
  EXPECT_TRUE(bench.IsSound());
  // But of the next one.
  const int size = bench.State.Mesh.Size();
  pass.Items.assign(1, *added.begin() % 2 == 1 ? *added.begin() : *added.rbegin());
  cells.Run(pass);
  EXPECT_EQ(bench.State.Mesh.Size(), size);
}

TEST(EditCells, StopBetweenColoursWithASoundSurface)
{
  Bench bench(LargeSphere(2.6));
  StandardThreads threads(2);
  EditCells cells(bench.State, threads);
  int asked = 0;
  EditCells::Pass pass;
  pass.Items = bench.All();
  pass.PlacesPerItem = 1;
  pass.GoOn = [&asked] { return ++asked < 4; };
  pass.Visit = [&](SurfaceEditor& editor, int v, EditCells::Lists&)
  { editor.Split(v, bench.State.Mesh.Rings[v].Item[0]); };
  const int before = bench.State.Mesh.NumberOfVertices();
  cells.Run(pass);
  EXPECT_EQ(asked, 4);
  EXPECT_GT(bench.State.Counts.Splits, 0);
  EXPECT_LT(bench.State.Counts.Splits, static_cast<int>(pass.Items.size()));
  EXPECT_EQ(bench.State.Mesh.NumberOfVertices(), before + bench.State.Counts.Splits);
  EXPECT_TRUE(bench.IsSound());
}

TEST(EditCells, MakeTheSameSurfaceWhateverTheThreadsDo)
{
  std::set<std::uint64_t> hashes;
  EditCounts counts;
  for (const int threads : { 1, 2, 3, 4, 7 })
  {
    Bench bench(LargeSphere(1.4));
    Shake(bench, 0.33f);
    DelayedThreads executor(threads, static_cast<unsigned>(threads), 200);
    Remesher remesher(bench.State, nullptr, true, executor);
    for (int pass = 0; pass < 3; ++pass)
    {
      std::vector<int> all = bench.All();
      remesher.Split(all);
      bench.UpdateShape();
      remesher.Collapse(bench.All());
      bench.UpdateShape();
      remesher.Flip(bench.All());
      bench.State.RollbackCount.Fill(9);
      remesher.Unstick(bench.All());
      bench.UpdateShape();
      Shake(bench, 0.2f);
    }
    counts = bench.State.Counts;
    const std::vector<int> changed = remesher.TakeChanged();
    hashes.insert(volumic::HashOf(changed, HashOf(bench)));
    EXPECT_EQ(DescribeBrokenInvariant(bench.State.Mesh), "");
  }
  EXPECT_EQ(hashes.size(), 1u);
  EXPECT_GT(counts.Splits, 100);
  EXPECT_GT(counts.Collapses, 100);
  EXPECT_GT(counts.Flips, 100);
}

TEST(EditCells, AreLargerWhereEdgesAre)
{
  // Edges of five times the legal length: their ends are written to from far away.
  std::set<std::uint64_t> hashes;
  for (const int threads : { 1, 4 })
  {
    Bench bench(LargeSphere(12));
    DelayedThreads executor(threads, 5, 100);
    Remesher remesher(bench.State, nullptr, true, executor);
    std::vector<int> all = bench.All();
    remesher.Split(all);
    hashes.insert(HashOf(bench));
    EXPECT_LE(bench.Longest(), 2.5001f);
    EXPECT_EQ(bench.State.LongestEdge, 0.f); // There are none any more.
    EXPECT_TRUE(bench.IsSound());
  }
  EXPECT_EQ(hashes.size(), 1u);
}
