// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/ComponentWatch.h"

#include "Core/Mesh/SurfaceMeasures.h"

#include <algorithm>
#include <cstddef>

namespace volumic
{
namespace
{
/** Components up to this size are deleted if they lie wholly on the wrong side. */
constexpr int TinySize = 24;
/** Components up to this size have vanished. */
constexpr int VanishedSize = 5;

/** Temporary label of tested vertices. */
constexpr int Seen = -2;
/** Labels of LabelSmall are greater than all others. */
constexpr int FirstOwnLabel = SurfaceState::Unlabelled + 1;

bool IsVolumePositive(const SurfaceMesh& mesh, const std::vector<int>& vertices)
{
  SignedVolume volume(mesh.Position[vertices.front()]);
  for (int v : vertices)
  {
    volume.Add(mesh, v);
  }
  return volume.Value() > 0;
}
}

bool ComponentWatch::IsSmall(
  SurfaceState& state, int v, const Box& within, const LargeComponents& large)
{
  const SurfaceMesh& mesh = state.Mesh;
  this->Stack.assign(1, v);
  this->Pending.assign(1, v);
  state.Marks[v] |= IsSeen;
  bool isSmall = within.Contains(mesh.Position[v]);
  while (isSmall && !this->Pending.empty())
  {
    // Depth first, which soon leaves the box.
    const Ring& ring = mesh.Rings[this->Pending.back()];
    this->Pending.pop_back();
    for (int k = 0; k < ring.Count && isSmall; ++k)
    {
      const int w = ring.Item[k];
      isSmall = !(state.Marks[w] & IsOfLarge) && !large.Has(state.Component[w]) &&
        within.Contains(mesh.Position[w]);
      if (isSmall && !(state.Marks[w] & IsSeen))
      {
        state.Marks[w] |= IsSeen;
        this->Stack.push_back(w);
        this->Pending.push_back(w);
      }
    }
    isSmall = isSmall && this->Stack.size() <= SmallSize;
  }
  if (!isSmall)
  {
    for (const int w : this->Stack)
    {
      state.Marks[w] |= IsOfLarge;
    }
  }
  this->AllSeen.insert(this->AllSeen.end(), this->Stack.begin(), this->Stack.end());
  return isSmall;
}

void ComponentWatch::LabelSmall(
  SurfaceState& state, int begin, int end, const Box& within, const LargeComponents& large)
{
  this->Watched.clear();
  const auto isBesideLarge = [&state](int v)
  {
    const Ring& ring = state.Mesh.Rings[v];
    return std::any_of(ring.Item, ring.Item + ring.Count,
      [&state](int w) { return (state.Marks[w] & IsOfLarge) != 0; });
  };
  for (int v = begin; v < end; ++v)
  {
    if (large.Has(state.Component[v]) || (state.Marks[v] & IsSeen))
    {
      continue;
    }
    if (isBesideLarge(v))
    {
      state.Marks[v] |= IsSeen | IsOfLarge;
      continue;
    }
    if (!state.Mesh.IsAlive(v) || !this->IsSmall(state, v, within, large))
    {
      continue;
    }
    this->Watched.emplace_back();
    SmallComponent& small = this->Watched.back();
    small.Vertices = this->Stack;
    std::sort(small.Vertices.begin(), small.Vertices.end());
    small.Label = FirstOwnLabel + small.Vertices.front();
    small.IsPositive = IsVolumePositive(state.Mesh, small.Vertices);
    for (const int w : small.Vertices)
    {
      state.Component[w] = small.Label;
    }
  }
  const auto forget = [&state](int v)
  { state.Marks[v] &= static_cast<std::uint8_t>(~(IsSeen | IsOfLarge)); };
  std::for_each(this->AllSeen.begin(), this->AllSeen.end(), forget);
  for (int v = begin; v < end; ++v)
  {
    forget(v);
  }
  this->AllSeen.clear();
}

bool ComponentWatch::FindVertices(SurfaceState& state, const SmallComponent& small)
{
  // Collapses and splits change the vertices of a component but not its label.
  const auto seed = std::find_if(small.Vertices.begin(), small.Vertices.end(),
    [&](int v) { return state.Mesh.IsAlive(v) && state.Component[v] == small.Label; });
  if (seed == small.Vertices.end())
  {
    return false;
  }
  this->Stack.assign(1, *seed);
  state.Component[*seed] = Seen;
  for (std::size_t i = 0; i < this->Stack.size(); ++i)
  {
    const Ring& ring = state.Mesh.Rings[this->Stack[i]];
    for (int k = 0; k < ring.Count; ++k)
    {
      if (state.Component[ring.Item[k]] != Seen)
      {
        state.Component[ring.Item[k]] = Seen;
        this->Stack.push_back(ring.Item[k]);
      }
    }
  }
  for (int v : this->Stack)
  {
    state.Component[v] = small.Label;
  }
  return true;
}

bool ComponentWatch::DeleteDegenerate(SurfaceState& state, EditContext* context)
{
  bool deleted = false;
  for (SmallComponent& small : this->Watched)
  {
    if (!this->FindVertices(state, small))
    {
      continue;
    }
    if (this->Stack.size() > 2 * SmallSize)
    {
      small.Vertices.clear(); // It has grown.
      continue;
    }
    small.Vertices = this->Stack;
    const int size = static_cast<int>(small.Vertices.size());
    const bool positive = IsVolumePositive(state.Mesh, small.Vertices);
    const auto isOnWrongSide = [&](int v)
    { return positive ? state.FieldValue[v] < 0 : state.FieldValue[v] > 0; };
    if (positive != small.IsPositive || size <= VanishedSize ||
      (size <= TinySize &&
        std::all_of(small.Vertices.begin(), small.Vertices.end(), isOnWrongSide)))
    {
      if (context)
      {
        const SurfaceState::RemovedComponent removed =
          state.EraseComponent(small.Vertices.front(), &context->Slots);
        context->EulerCharacteristic -= removed.EulerCharacteristic;
        ++context->Counts.Removed;
      }
      else
      {
        state.RemoveComponent(small.Vertices.front());
      }
      small.Vertices.clear();
      deleted = true;
    }
  }
  return deleted;
}
}
