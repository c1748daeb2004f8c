// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The edits of SurfaceEditor that change the topology: merge and cut.

#include "Core/Mesh/CycleCut.h"
#include "Core/Mesh/StarMerge.h"
#include "Core/Surface/FaceShape.h"
#include "Core/Surface/SurfaceEditor.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
/** Move of each corner of a cut, as a fraction of the way to the mean of its other neighbours. */
constexpr float SeparationFraction = 0.25f;

/** A cut that can be undone until the next edit. */
class TentativeCut
{
public:
  TentativeCut(SurfaceState& state, const CycleCut& cut, VertexSlots* slots)
    : State(state), Slots(slots), Corner{ cut.A, cut.B, cut.C }
  {
    for (int k = 0; k < 3; ++k)
    {
      const Ring& ring = state.Mesh.Rings[this->Corner[k]];
      this->OldPosition[k] = state.Mesh.Position[this->Corner[k]];
      this->Saved.emplace_back(this->Corner[k], ring);
      for (int i = 0; i < ring.Count; ++i)
      {
        this->Saved.emplace_back(ring.Item[i], state.Mesh.Rings[ring.Item[i]]);
      }
    }
    const std::array<int, 3> copy = cut.Apply(state.Mesh, slots);
    for (int k = 0; k < 3; ++k)
    {
      state.AddVertex(copy[k], this->Corner[k]);
      state.NearOthers[copy[k]] = state.NearOthers[this->Corner[k]] = 1;
    }
    this->All = { cut.A, cut.B, cut.C, copy[0], copy[1], copy[2] };
  }

  /** Return the corners of one side, then those of the other. */
  const std::array<int, 6>& Corners() const { return this->All; }

  /** Move each corner towards the rest of its star. */
  void Separate()
  {
    const SurfaceMesh& mesh = this->State.Mesh;
    for (int n = 0; n < 6; ++n)
    {
      const int* side = &this->All[n / 3 * 3];
      const Ring& ring = mesh.Rings[this->All[n]];
      Vector sum;
      int count = 0;
      for (int i = 0; i < ring.Count; ++i)
      {
        const int y = ring.Item[i];
        if (y != side[0] && y != side[1] && y != side[2])
        {
          sum += mesh.Position[y];
          ++count;
        }
      }
      const Vector mean = sum * (1.f / static_cast<float>(std::max(count, 1)));
      const Vector& old = this->OldPosition[n % 3];
      this->State.MoveTo(this->All[n], old + (mean - old) * SeparationFraction);
    }
  }

  /** Append the faces of all corners. */
  void AddFaces(std::vector<MeshTriangle>& faces) const
  {
    const SurfaceMesh& mesh = this->State.Mesh;
    for (int n = 0; n < 6; ++n)
    {
      const int* side = &this->All[n / 3 * 3];
      const int* own = &this->All[n];
      // Take a face with several corners of the side from the first of them only.
      const auto isEarlier = [&](int y) { return std::find(side, own, y) != own; };
      const Ring& ring = mesh.Rings[*own];
      for (int i = 0; i < ring.Count; ++i)
      {
        const int b = ring.Item[i];
        const int c = ring.Next(i);
        if (!isEarlier(b) && !isEarlier(c))
        {
          faces.push_back(TriangleOf(mesh, *own, b, c));
        }
      }
    }
  }

  void Undo()
  {
    SurfaceMesh& mesh = this->State.Mesh;
    for (int k = 3; k < 6; ++k)
    {
      this->State.RemoveVertex(this->All[k]);
      mesh.RemoveVertex(this->All[k], this->Slots);
    }
    if (this->Slots)
    {
      this->Slots->Next -= 3; // Rejected cuts would use up all slots.
    }
    for (const auto& entry : this->Saved)
    {
      mesh.Rings[entry.first] = entry.second;
    }
    for (int k = 0; k < 3; ++k)
    {
      this->State.MoveTo(this->Corner[k], this->OldPosition[k]);
    }
  }

private:
  SurfaceState& State;
  VertexSlots* Slots;
  std::array<int, 3> Corner;
  Vector OldPosition[3];
  std::array<int, 6> All;
  std::vector<std::pair<int, Ring>> Saved; ///< All rings that the cut changes.
};
}

Edit SurfaceEditor::Merge(int u, int v)
{
  SurfaceState& s = this->State;
  StarMerge merge;
  merge.U = u;
  merge.V = v;
  const float longest = s.Sizing.LongestEdge(u, v, LongestBridgeEdge);
  if (!this->MayEdit({ u, v }) || !merge.Plan(s.Mesh) ||
    merge.SquaredLongestBridgeEdge() > longest * longest)
  {
    return {};
  }
  this->Faces.clear();
  for (const auto& t : merge.Strip())
  {
    this->Faces.push_back(TriangleOf(s.Mesh, t[0], t[1], t[2]));
    if (!IsWellShaped(this->Faces.back()))
    {
      return {};
    }
  }
  if (NewFacesIntersect(s, this->Faces, { { u, v }, 2, false }))
  {
    return {};
  }
  const std::size_t first = this->Log.size();
  s.RemoveVertex(u);
  s.RemoveVertex(v);
  merge.Apply(s.Mesh, this->Slots());
  this->AddToEulerCharacteristic(-2);
  ++this->Counts().Merges;
  for (const auto& t : merge.Strip())
  {
    for (int w : t)
    {
      this->MarkChanged(w);
      s.NearOthers[w] = 1;
    }
  }
  return this->Done(first);
}

Edit SurfaceEditor::Cut(int u, int v, int w)
{
  SurfaceState& s = this->State;
  const CycleCut cut{ u, v, w };
  if (!this->MayEdit({ u, v, w }) || !cut.IsLegal(s.Mesh) || !this->HasSlots(3))
  {
    return {};
  }
  TentativeCut tentative(s, cut, this->Slots());
  tentative.Separate();
  this->Faces.clear();
  tentative.AddFaces(this->Faces);
  const RemovedFaces removed = { tentative.Corners(), 6, false };
  if (!std::all_of(this->Faces.begin(), this->Faces.end(), IsWellShaped) ||
    NewFacesIntersect(s, this->Faces, removed))
  {
    tentative.Undo();
    return {};
  }
  const std::size_t first = this->Log.size();
  this->AddToEulerCharacteristic(2);
  ++this->Counts().Cuts;
  for (int x : tentative.Corners())
  {
    this->MarkStarChanged(x);
  }
  return this->Done(first);
}
}
