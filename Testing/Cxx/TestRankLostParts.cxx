// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What a surface has lost, looked for by ranks in rows of their own: the same as by one in all.
#include "Core/Evolution/LostParts.h"
#include "Core/Image/VoxelNumbers.h"
#include "EvolutionTestTools.h"
#include "RankTestTools.h"
#include "ThreadRanks.h"

using namespace volumic;

namespace
{
constexpr int Size = 44;
constexpr double Centre = 21.6;
constexpr double Radius = 8.;
constexpr float Halo = 9.f; // Delta is 0.85.
const Vector Low(-2, -2, -2);
const Vector High(Size + 2, Size + 2, Size + 2);

/** So many voxels in a hundred, here and there, are of the object. */
TestVolume Noise(unsigned int percent)
{
  return MakeVolume(Size,
    [percent](double x, double y, double z)
    {
      auto hash = static_cast<std::uint32_t>(x + Size * (y + Size * z));
      for (const std::uint32_t factor : { 2654435761u, 2246822519u, 3266489917u })
      {
        hash = (hash ^ hash >> 15) * factor;
      }
      return (hash >> 8) % 100 < percent ? 1. : 0.;
    });
}

/** Balls outside of the surface, a hole in it, and a wire through the rows of all ranks. */
TestVolume Objects()
{
  return MakeVolume(Size,
    [](double x, double y, double z)
    {
      const double fromCentre = Distance(x, y, z, Centre, Centre, Centre);
      const bool isObject = (fromCentre < Radius && fromCentre > 4.) ||
        Distance(x, y, z, 6, 6, 38) < 4. || Distance(x, y, z, 37, 36, 6) < 5. ||
        (x < 4 && std::abs(y - z) < 2.);
      return isObject ? 1. : 0.;
    });
}

void Fill(SurfaceState& state)
{
  state.Mesh = MakeSphere({ Centre, Centre, Centre }, Radius, 1.2);
  state.Sizing = SizingField(0.85f);
  state.Reset(Low, High);
}

/** The rows of each rank; the last of five has none. */
std::vector<VoxelBox> RowsOf(int ranks)
{
  const auto rows = [](int y0, int y1, int z0, int z1)
  { return VoxelBox{ { 0, y0, z0 }, { Size, y1, z1 } }; };
  switch (ranks)
  {
    case 1:
      return { VoxelBox::Of({ Size, Size, Size }) };
    case 2:
      return { rows(0, Size, 0, 19), rows(0, Size, 19, Size) };
    case 3:
      return { rows(0, Size, 0, 8), rows(0, 21, 8, Size), rows(21, Size, 8, Size) };
    default:
      return { rows(0, 20, 0, 22), rows(20, Size, 0, 22), rows(0, 25, 22, Size),
        rows(25, Size, 22, Size), VoxelBox() };
  }
}

/** The vertices beside the rows of a rank are its own. */
OwnerOf ByRows(const SurfaceState& whole)
{
  return [&whole](int v, int ranks)
  {
    const Vector& p = whole.Mesh.Position[v];
    const std::array<int, 3> voxel = { 0, static_cast<int>(std::lround(p.Y)),
      static_cast<int>(std::lround(p.Z)) };
    const std::vector<VoxelBox> rows = RowsOf(ranks);
    const auto has = [&voxel](const VoxelBox& box) { return box.Contains(voxel); };
    return static_cast<int>(std::find_if(rows.begin(), rows.end(), has) - rows.begin());
  };
}

/** Looks for what is lost on so many ranks, each of which knows the voxels about its rows only. */
template <typename Work>
void OnRanks(int count, const SurfaceState& whole, const TestVolume& volume, const Work& work)
{
  ThreadRanks::Run(count,
    [&](Communicator& ranks)
    {
      TestVolume known = volume;
      known.Image.Values = known.Values.data();
      const Field field(known.Image, IsoHalf(), OnThisThread());
      const RankRows part = { ranks, RowsOf(count)[static_cast<std::size_t>(ranks.Rank())] };
      VoxelBox about = part.Rows;
      for (int axis = 1; axis < 3; ++axis)
      {
        about.First[axis] -= 1;
        about.End[axis] += 1;
      }
      const VoxelNumbers numbers(known.Image.Size);
      for (std::size_t i = 0; i < known.Values.size(); ++i)
      {
        if (!about.Contains(numbers.PlaceOf(static_cast<std::int64_t>(i))))
        {
          known.Values[i] = 1.f - known.Values[i];
        }
      }
      SurfaceState state;
      TakePart(state, whole, ByRows(whole), ranks, Halo, Low, High);
      work(part, state, field);
    });
}

using Parts = std::vector<std::vector<std::int64_t>>;

void AddParts(const LostVoxels& lost, Parts& parts)
{
  parts.resize(static_cast<std::size_t>(lost.NumberOfParts()));
  for (const auto& slab : lost.Slabs())
  {
    for (const VoxelRun& run : slab)
    {
      for (int i = 0; i < run.Length; ++i)
      {
        parts.at(static_cast<std::size_t>(run.Part)).push_back(run.First + i);
      }
    }
  }
}
}

TEST(RankLostVoxels, AreThoseOfOneRankInTheSameParts)
{
  SurfaceState whole;
  Fill(whole);
  for (const unsigned int percent : { 3u, 28u, 34u, 97u })
  {
    const TestVolume volume = Noise(percent);
    const Field field(volume.Image, IsoHalf(), OnThisThread());
    for (const PartKind kind : { PartKind::Object, PartKind::Cavity })
    {
      for (const int minimumSize : { 1, 2, 20 })
      {
        Parts expected;
        AddParts(
          LostVoxels(whole, field, kind, minimumSize, OnThisThread(), NeverStop), expected);
        for (const int count : { 1, 2, 3, 5 })
        {
          Parts found;
          std::mutex lock;
          OnRanks(count, whole, volume,
            [&](const RankRows& part, const SurfaceState& state, const Field& ofRank)
            {
              const LostVoxels lost(
                state, ofRank, kind, minimumSize, OnThisThread(), NeverStop, &part);
              const std::lock_guard<std::mutex> locked(lock);
              AddParts(lost, found);
            });
          for (std::vector<std::int64_t>& part : found)
          {
            std::sort(part.begin(), part.end());
          }
          EXPECT_EQ(found, expected)
            << percent << " %, at least " << minimumSize << ", " << count << " ranks";
        }
      }
    }
  }
}

TEST(RankLostParts, GetTheCoverAndTheBoundaryOfOneRank)
{
  SurfaceState whole;
  Fill(whole);
  const TestVolume volumes[] = { Objects(), Noise(34) };
  const int numbers[2][2] = { { 3, 0 }, { 1, 1 } }; // Of objects and cavities, at least.
  for (int i = 0; i < 2; ++i)
  {
    const Field field(volumes[i].Image, IsoHalf(), OnThisThread());
    for (const PartKind kind : { PartKind::Object, PartKind::Cavity })
    {
      const LostPartCover expected = FindLostParts(whole, field, kind, 10, OnThisThread());
      const LostBoundary::Missing missing =
        expected.Boundary.MissedBy(whole, field, OnThisThread());
      EXPECT_GE(expected.Found, numbers[i][kind == PartKind::Cavity]);
      for (const int count : { 1, 2, 3, 5 })
      {
        SCOPED_TRACE(std::to_string(count) + " ranks");
        OnRanks(count, whole, volumes[i],
          [&](const RankRows& part, const SurfaceState& state, const Field& ofRank)
          {
            const LostPartCover cover =
              FindLostParts(state, ofRank, kind, 10, OnThisThread(), NeverStop, &part);
            EXPECT_EQ(cover.Found, expected.Found);
            EXPECT_EQ(cover.Covered, expected.Covered);
            EXPECT_EQ(cover.Surface.Points, expected.Surface.Points);
            EXPECT_EQ(cover.Surface.Triangles, expected.Surface.Triangles);
            const LostBoundary::Missing ofRanks =
              cover.Boundary.MissedBy(whole, field, OnThisThread());
            const bool isFirst = part.Ranks.Rank() == 0;
            EXPECT_EQ(ofRanks.Parts, isFirst ? missing.Parts : 0);
            EXPECT_EQ(ofRanks.Share, isFirst ? missing.Share : 0.);
          });
      }
    }
  }
}

TEST(RankLostParts, AreNotToldWhenOneRankIsAskedToStop)
{
  SurfaceState whole;
  Fill(whole);
  const TestVolume volume = Objects();
  for (const double from : { 0., 0.71, 0.95 })
  {
    OnRanks(3, whole, volume,
      [&](const RankRows& part, const SurfaceState& state, const Field& field)
      {
        const LostPartCover cover = FindLostParts(state, field, PartKind::Object, 1,
          OnThisThread(),
          [&](double share) { return part.Ranks.Rank() != 1 || share < from; }, &part);
        EXPECT_TRUE(cover.IsStopped);
        EXPECT_TRUE(cover.Surface.Points.empty());
      });
  }
}
