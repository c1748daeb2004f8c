// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceComponents.h"

#include "Core/Common/Box.h"
#include "Core/Common/JoinLabels.h"
#include "Core/Common/RankLists.h"
#include "Core/Common/Select.h"
#include "Core/Common/Spans.h"
#include "Core/Surface/ComponentNesting.h"
#include "Core/Surface/ComponentWatch.h"

#include <algorithm>
#include <numeric>

namespace volumic
{
namespace
{
/** Vertices that one thread looks at at a time. */
constexpr std::size_t VertexSpan = 4096;

/** All that a small component is judged by. */
struct VertexRecord
{
  int Vertex;
  float FieldValue;
  Vector Position;
  volumic::Ring Ring;
};

/** A surface of these vertices alone, in the same order. */
void Fill(SurfaceState& state, const std::vector<VertexRecord>& records)
{
  const auto placeOf = [&records](int v)
  {
    const auto found = std::lower_bound(records.begin(), records.end(), v,
      [](const VertexRecord& record, int vertex) { return record.Vertex < vertex; });
    return static_cast<int>(found - records.begin());
  };
  Vector low = records.front().Position;
  Vector high = low;
  for (const VertexRecord& record : records)
  {
    Ring ring = record.Ring;
    for (int i = 0; i < ring.Count; ++i)
    {
      ring.Item[i] = placeOf(ring.Item[i]);
    }
    state.Mesh.Position.push_back(record.Position);
    state.Mesh.Rings.push_back(ring);
    low = Minimum(low, record.Position);
    high = Maximum(high, record.Position);
  }
  state.Reset(low, high);
  for (std::size_t v = 0; v < records.size(); ++v)
  {
    state.FieldValue[v] = records[v].FieldValue;
  }
}

/** Of whole components those that must go, by their smallest vertices. */
std::vector<int> FindDegenerate(std::vector<VertexRecord> records, const SizingField& sizing)
{
  std::vector<int> found;
  if (records.empty())
  {
    return found;
  }
  std::sort(records.begin(), records.end(),
    [](const VertexRecord& a, const VertexRecord& b) { return a.Vertex < b.Vertex; });
  SurfaceState state;
  state.Sizing = SizingField(sizing.OfLevel()); // Its vertices have other numbers.
  Fill(state, records);
  std::vector<int> all(records.size());
  std::iota(all.begin(), all.end(), 0);
  constexpr float far = 1e9f;
  ComponentWatch watch;
  watch.LabelSmall(state, all, { Vector(-far, -far, -far), Vector(far, far, far) });
  std::vector<int> roots; // By component; they come in order.
  for (const int v : all)
  {
    if (roots.empty() || state.Component[v] > state.Component[roots.back()])
    {
      roots.push_back(v);
    }
  }
  watch.DeleteDegenerate(state);
  for (const int root : roots)
  {
    if (!state.Mesh.IsAlive(root))
    {
      found.push_back(records[root].Vertex);
    }
  }
  return found;
}
}

void SurfaceComponents::Mark(const SurfaceState& state, Executor& executor)
{
  const std::size_t n = state.Mesh.Rings.size();
  if (this->Marks.size() < n)
  {
    MakeZeroed(this->Marks, n);
  }
  ForSpans(executor, this->Marks.size(), VertexSpan,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        const bool isOwn = v < n && state.Mesh.IsAlive(static_cast<int>(v)) &&
          this->Piece.IsOwn(static_cast<int>(v));
        if (isOwn != (this->Marks[v] == Own))
        {
          this->Marks[v] = isOwn ? Own : 0;
        }
      }
    });
}

void SurfaceComponents::FindOwnSets(SurfaceState& state, Executor& executor)
{
  this->Connected.Label(state.Mesh, this->OwnOnes(), state.Component.AsVector(), executor);
  this->Sets.clear();
  for (std::size_t set = 0; set < this->Connected.Roots().size(); ++set)
  {
    const int root = this->Connected.Roots()[set];
    this->Sets.push_back({ root, this->Connected.Sizes()[set], state.Mesh.Position[root] });
  }
}

std::vector<SurfaceComponents::Name> SurfaceComponents::NameBorders(
  const SurfaceState& state, Executor& executor) const
{
  if (this->Piece.Ranks.NumberOfRanks() == 1)
  {
    return {}; // There are none.
  }
  const std::size_t n = state.Mesh.Rings.size();
  std::vector<std::vector<Name>> spans((n + VertexSpan - 1) / VertexSpan);
  ForSpans(executor, n, VertexSpan,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        if (this->Marks[v] != Own)
        {
          continue;
        }
        const int set = state.Component[v]; // So far.
        const std::size_t before = spans[b].size();
        const Ring& ring = state.Mesh.Rings[v];
        for (int i = 0; i < ring.Count; ++i)
        {
          if (this->Marks[ring.Item[i]] != Own)
          {
            spans[b].push_back({ ring.Item[i], set });
          }
        }
        if (spans[b].size() > before)
        {
          spans[b].push_back({ v, set }); // The others name it, too.
        }
      }
      SortUnique(spans[b]);
    });
  std::vector<Name> names = Joined(executor, spans);
  SortUnique(names);
  return names;
}

std::vector<Message> SurfaceComponents::JoinSets(const std::vector<Message>& ofRanks)
{
  std::vector<OwnSet> sets; // Of all ranks, one after the other.
  std::vector<Name> names;
  std::vector<std::size_t> first(1, 0);
  for (const Message& message : ofRanks)
  {
    MessageReader reader(message);
    const std::vector<OwnSet> setsOfRank = reader.TakeVector<OwnSet>();
    for (const Name& name : reader.TakeVector<Name>())
    {
      names.push_back({ name.Vertex, static_cast<int>(first.back()) + name.Set });
    }
    sets.insert(sets.end(), setsOfRank.begin(), setsOfRank.end());
    first.push_back(sets.size());
  }
  std::vector<std::pair<int, int>> joins;
  std::sort(names.begin(), names.end());
  for (std::size_t i = 1; i < names.size(); ++i)
  {
    if (names[i].Vertex == names[i - 1].Vertex)
    {
      joins.emplace_back(names[i].Set, names[i - 1].Set);
    }
  }
  std::vector<SetPiece> pieces;
  for (const OwnSet& set : sets)
  {
    pieces.push_back({ set.Root, set.Size });
  }
  const JoinedSets joined = JoinLabels(pieces, joins);
  this->All.clear();
  for (const SetPiece& whole : joined.Labels)
  {
    const int label = static_cast<int>(this->All.size());
    this->All.push_back(
      { label, static_cast<int>(whole.First), static_cast<int>(whole.Size), Vector() });
  }
  for (std::size_t set = 0; set < sets.size(); ++set)
  {
    Whole& whole = this->All[joined.LabelOf[set]];
    whole.Place = whole.Root == sets[set].Root ? sets[set].Place : whole.Place;
  }
  std::vector<Message> answers;
  for (std::size_t rank = 0; rank < ofRanks.size(); ++rank)
  {
    std::vector<Whole> wholes;
    for (std::size_t set = first[rank]; set < first[rank + 1]; ++set)
    {
      wholes.push_back(this->All[joined.LabelOf[set]]);
    }
    MessageWriter writer;
    writer.Add(static_cast<int>(this->All.size()));
    writer.AddArray(wholes);
    answers.push_back(writer.Take());
  }
  return answers;
}

void SurfaceComponents::FindWholes(const std::vector<Name>& names)
{
  Communicator& ranks = this->Piece.Ranks;
  MessageWriter writer;
  writer.AddArray(this->Sets);
  writer.AddArray(names);
  const std::vector<Message> ofRanks = ranks.Gather(writer.Take());
  const Message answer = ranks.Scatter(this->JoinSets(ofRanks));
  MessageReader reader(answer);
  this->Components = reader.Take<int>();
  reader.TakeArray(this->Wholes);
  this->SetOf.assign(static_cast<std::size_t>(this->Components), -1);
  for (std::size_t set = 0; set < this->Wholes.size(); ++set)
  {
    this->SetOf[this->Wholes[set].Label] = static_cast<int>(set);
  }
}

void SurfaceComponents::Label(SurfaceState& state, Executor& executor)
{
  this->Mark(state, executor);
  this->FindOwnSets(state, executor);
  this->FindWholes(this->NameBorders(state, executor));
  ForSpans(executor, state.Mesh.Rings.size(), VertexSpan,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        if (this->Marks[v] == Own)
        {
          state.Component[v] = this->Wholes[state.Component[v]].Label;
        }
      }
    });
}

bool SurfaceComponents::DeleteDegenerate(SurfaceState& state)
{
  std::vector<VertexRecord> whole; // Of components that no other rank has a piece of.
  std::vector<VertexRecord> pieces;
  for (int v = 0; v < state.Mesh.Size(); ++v)
  {
    if (this->Marks[v] != Own || !state.Mesh.IsAlive(v))
    {
      continue;
    }
    const int set = this->SetOf[state.Component[v]];
    if (this->Wholes[set].Size <= ComponentWatch::SmallSize)
    {
      const bool isWhole = this->Wholes[set].Size == this->Sets[set].Size;
      (isWhole ? whole : pieces)
        .push_back({ v, state.FieldValue[v], state.Mesh.Position[v], state.Mesh.Rings[v] });
    }
  }
  Communicator& ranks = this->Piece.Ranks;
  std::vector<int> found = FindDegenerate(std::move(whole), state.Sizing);
  const std::vector<int> ofParts =
    FindDegenerate(GatherLists(ranks, pieces), state.Sizing);
  found.insert(found.end(), ofParts.begin(), ofParts.end());
  found = GatherListsOnAll(ranks, found);
  std::sort(found.begin(), found.end());
  this->Remove(state, found);
  return !found.empty();
}

std::vector<int> SurfaceComponents::FindInsideOut(const SurfaceState& state, Executor& executor)
{
  // The volumes of all pieces, by label, to rank 0, which casts the rays.
  Communicator& ranks = this->Piece.Ranks;
  const LargeVector<int>& labels = state.Component.AsVector();
  std::vector<Vector> places(this->SetOf.size());
  for (const Whole& whole : this->Wholes)
  {
    places[whole.Label] = whole.Place;
  }
  struct Volume
  {
    int Label;
    ExactSum Sum;
  };
  const std::vector<ExactSum> sums =
    VolumesOfFaces(state.Mesh, labels, this->OwnOnes(), places, executor);
  std::vector<Volume> own;
  for (int label = 0; label < this->Components; ++label)
  {
    if (this->SetOf[label] >= 0)
    {
      own.push_back({ label, sums[label] });
    }
  }
  std::vector<int> roots;
  places.clear();
  for (const Whole& component : this->All)
  {
    roots.push_back(component.Root);
    places.push_back(component.Place);
  }
  std::vector<ExactSum> volumes(roots.size());
  for (const Volume& piece : GatherLists(ranks, own))
  {
    volumes[piece.Label].Add(piece.Sum);
  }
  const std::vector<ComponentRay> rays = BroadcastList(ranks, CastRays(roots, places, volumes));
  std::vector<RayCrossing> crossings = GatherLists(
    ranks, FindCrossings(state.Mesh, labels, this->OwnOnes(), rays, executor));
  KeepOdd(crossings);
  return BroadcastList(ranks,
    ranks.Rank() == 0 ? JudgeFromOutsideIn(rays, crossings) : std::vector<int>());
}

bool SurfaceComponents::DeleteInsideOut(SurfaceState& state, Executor& executor)
{
  this->Label(state, executor);
  const std::vector<int> insideOut = this->FindInsideOut(state, executor);
  this->Remove(state, insideOut);
  if (!insideOut.empty())
  {
    this->Label(state, executor);
  }
  return !insideOut.empty();
}

std::vector<int> SurfaceComponents::LabelsOf(const std::vector<int>& roots) const
{
  std::vector<int> labels;
  for (std::size_t i = 0; this->Piece.Ranks.Rank() == 0 && i < roots.size(); ++i)
  {
    const auto found = std::lower_bound(this->All.begin(), this->All.end(), roots[i],
      [](const Whole& component, int root) { return component.Root < root; });
    labels.push_back(found->Label);
  }
  return BroadcastList(this->Piece.Ranks, labels);
}

void SurfaceComponents::Remove(SurfaceState& state, const std::vector<int>& roots)
{
  if (roots.empty())
  {
    return;
  }
  struct Removal
  {
    int Label;
    int Place; ///< Among the roots.
    int Vertices;
    std::int64_t Neighbours;
  };
  std::vector<Removal> removals; // By label.
  for (const int label : this->LabelsOf(roots))
  {
    removals.push_back({ label, static_cast<int>(removals.size()), 0, 0 });
  }
  std::sort(removals.begin(), removals.end(),
    [](const Removal& a, const Removal& b) { return a.Label < b.Label; });
  std::vector<char> isRootHere(roots.size(), 0);
  std::vector<int> removed;
  for (int v = 0; v < state.Mesh.Size(); ++v)
  {
    if (this->Marks[v] != Own || !state.Mesh.IsAlive(v))
    {
      continue;
    }
    const int label = state.Component[v];
    const auto removal = std::lower_bound(removals.begin(), removals.end(), label,
      [](const Removal& r, int wanted) { return r.Label < wanted; });
    if (removal != removals.end() && removal->Label == label)
    {
      ++removal->Vertices;
      removal->Neighbours += state.Mesh.Rings[v].Count;
      isRootHere[removal->Place] |= v == roots[removal->Place];
      removed.push_back(v);
      state.RemoveVertex(v);
      state.Mesh.RemoveVertex(v);
    }
  }
  for (const int v : GatherListsOnAll(this->Piece.Ranks, removed))
  {
    state.Forget(v); // Where it is another rank's.
  }
  std::vector<Removal> whole(roots.size());
  for (const Removal& piece : GatherListsOnAll(this->Piece.Ranks, removals))
  {
    whole[piece.Place].Vertices += piece.Vertices;
    whole[piece.Place].Neighbours += piece.Neighbours;
  }
  for (std::size_t i = 0; i < roots.size(); ++i)
  {
    const int characteristic = whole[i].Vertices - static_cast<int>(whole[i].Neighbours / 6);
    state.EulerCharacteristic -= isRootHere[i] ? characteristic : 0;
    ++state.Counts.Removed;
    state.Counts.RemovedGenus += 1 - characteristic / 2;
  }
  this->Components -= static_cast<int>(roots.size());
}
}
