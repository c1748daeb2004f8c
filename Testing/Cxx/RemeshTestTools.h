// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRemeshTestTools_h
#define volumicRemeshTestTools_h

#include "Core/Common/Executor.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "Core/Image/Field.h"
#include "Core/Surface/SurfaceState.h"
#include "CoreTestTools.h"

namespace volumic
{
/** A surface state with delta 1, without an evolution. */
struct Bench
{
  SurfaceState State;
  Executor Threads;

  explicit Bench(const IndexedSurface& surface)
  {
    this->State.Mesh.Append(surface);
    this->State.Sizing = SizingField(1);
    this->State.Reset(Vector(-20, -20, -20), Vector(40, 40, 40));
    this->UpdateShape();
  }

  std::vector<int> All() const
  {
    std::vector<int> all;
    for (int v = 0; v < this->State.Mesh.Size(); ++v)
    {
      if (this->State.Mesh.IsAlive(v))
      {
        all.push_back(v);
      }
    }
    return all;
  }

  void UpdateShape() { this->State.UpdateShape(this->All(), this->Threads); }

  void MoveTo(int v, const Vector& position)
  {
    this->State.MoveTo(v, position);
    this->UpdateShape();
  }

  /** Return the lengths of all edges, each twice. */
  std::vector<float> Edges() const
  {
    std::vector<float> edges;
    const SurfaceMesh& mesh = this->State.Mesh;
    for (int v : this->All())
    {
      for (int i = 0; i < mesh.Rings[v].Count; ++i)
      {
        edges.push_back(Length(mesh.Position[mesh.Rings[v].Item[i]] - mesh.Position[v]));
      }
    }
    return edges;
  }
  float Longest() const
  {
    const std::vector<float> edges = this->Edges();
    return *std::max_element(edges.begin(), edges.end());
  }
  float Shortest() const
  {
    const std::vector<float> edges = this->Edges();
    return *std::min_element(edges.begin(), edges.end());
  }

  /** Test the invariants after edits. */
  bool IsSound() const
  {
    return DescribeBrokenInvariant(this->State.Mesh).empty() &&
      CountSelfIntersections(this->State.Mesh.ToIndexed(), 1) == 0 &&
      this->State.Mesh.CountEulerCharacteristic() == this->State.EulerCharacteristic;
  }
};
}

#endif
