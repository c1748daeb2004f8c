// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankBlocksTestTools_h
#define volumicRankBlocksTestTools_h

// A surface in blocks that belong to ranks.
#include "Core/Common/RankLists.h"
#include "Core/Surface/RankBlocks.h"
#include "CoreTestTools.h"
#include "ThreadRanks.h"

using namespace volumic;

inline constexpr float Side = 24.f;
inline constexpr float Delta = 1.f;
inline constexpr int PlaceOnlyOwnersKnow = 1000000;

/** Spheres in a row along z, and as many beside them. */
inline SurfaceMesh Row()
{
  SurfaceMesh mesh;
  for (int i = 0; i < 6; ++i)
  {
    for (const double x : { 20., 75. })
    {
      mesh.Append(MakeSphere({ x, 20., 28. + 36. * i }, 15., 1.7).ToIndexed());
    }
  }
  return mesh;
}

inline SurfaceBlocks::Frame FrameOfRow()
{
  return SurfaceBlocks::FrameOf({ 96., 40., 220. }, Side);
}

/** The spheres in pieces, of which one has active vertices in the upper half only. */
class Pieces
{
public:
  explicit Pieces(Communicator& ranks)
  {
    this->State.Sizing = SizingField(Delta);
    if (ranks.Rank() == 0)
    {
      this->State.Mesh = Row();
    }
    this->State.Reset(this->Low, this->High);
    this->Blocks = std::make_unique<SurfaceBlocks>(this->State, FrameOfRow(), OnThisThread());
    this->Owned = std::make_unique<RankBlocks>(this->State, *this->Blocks, ranks);
    const SurfaceMesh mesh = std::exchange(this->State.Mesh, SurfaceMesh());
    std::vector<int> all(mesh.Rings.size());
    std::iota(all.begin(), all.end(), 0);
    this->Owned->ChooseOwners(mesh, all);
    this->Owned->Scatter(mesh, all, this->Low, this->High);
    std::vector<int> inner; // Of the others a rank does not know the shape.
    for (int v = 0; v < this->State.Mesh.Size(); ++v)
    {
      const Ring& ring = this->State.Mesh.Rings[v];
      const auto isHere = [this](int w) { return this->State.Mesh.IsAlive(w); };
      if (isHere(v))
      {
        this->State.Active[v] = this->State.Mesh.Position[v].Z > 118.f;
        if (std::all_of(ring.Item, ring.Item + ring.Count, isHere))
        {
          inner.push_back(v);
        }
      }
    }
    this->State.UpdateShape(inner, OnThisThread());
    this->Owned->AddPlaces(OnThisThread());
    for (int block = 0; block < this->Blocks->NumberOfBlocks(); ++block)
    {
      if (this->Owned->IsOwn(block))
      {
        this->Blocks->GiveBack(block, PlaceOnlyOwnersKnow + block);
      }
    }
  }

  std::int64_t OwnWork() const
  {
    std::int64_t work = 0;
    for (int block = 0; block < this->Blocks->NumberOfBlocks(); ++block)
    {
      work += this->Owned->IsOwn(block) ? this->Blocks->WorkOf(block, true) : 0;
    }
    return work;
  }

  Vector Low{ -10.f, -10.f, -10.f };
  Vector High{ 110.f, 60.f, 240.f };
  SurfaceState State;
  std::unique_ptr<SurfaceBlocks> Blocks;
  std::unique_ptr<RankBlocks> Owned;
};

#endif
