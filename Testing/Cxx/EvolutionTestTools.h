// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEvolutionTestTools_h
#define volumicEvolutionTestTools_h

#include "Core/Evolution/SurfaceEvolution.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "CoreTestTools.h"

namespace volumic
{
/** A ball in the middle of a cube of n voxels; the iso-value is .5. */
inline TestVolume BallVolume(int n, double radius)
{
  return MakeVolume(n,
    [n, radius](double x, double y, double z)
    { return Soft(Distance(x, y, z, 0.5 * n, 0.5 * n, 0.5 * n) - radius); });
}

/** A scene as two levels, both sampled; lengths are voxels of the finer one. */
struct LevelPair
{
  TestVolume Fine;
  TestVolume Coarse;

  /** @param shownFine, shownCoarse outside distances, of what each level shows */
  template <typename ShownFine, typename ShownCoarse>
  LevelPair(int n, const ShownFine& shownFine, const ShownCoarse& shownCoarse)
    : Fine(MakeVolume(
        n, [&](double x, double y, double z) { return Soft(shownFine(x, y, z)); }))
  {
    const int coarse = static_cast<int>(std::lround(n / std::sqrt(3.)));
    const double step = static_cast<double>(n) / coarse;
    this->Coarse = MakeVolume(coarse,
      [&](double x, double y, double z)
      { return Soft(shownCoarse(x * step, y * step, z * step) / step); });
    this->Coarse.Image.Step = { step, step, step };
    this->Coarse.Image.Unit = std::sqrt(3.);
  }
};

inline SurfaceOptions IsoHalf()
{
  SurfaceOptions options;
  options.IsoValue = 0.5;
  return options;
}

/** What most evolutions of tests run on, and who watches them: this thread, and nobody. */
inline SequentialExecutor Threads;
inline Monitor Silent;

/** Calls back after every sweep. */
class Observer final : public Monitor
{
public:
  explicit Observer(std::function<void(const Status&)> look) : Look(std::move(look)) {}
  bool Continue(const Status& status) override
  {
    this->Look(status);
    return true;
  }

private:
  std::function<void(const Status&)> Look;
};

/** Lengths of all edges, each twice. */
inline std::vector<double> EdgeLengths(const IndexedSurface& surface)
{
  std::vector<double> lengths;
  for (const Triangle& t : surface.Triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Point& a = surface.Points[t[k]];
      const Point& b = surface.Points[t[(k + 1) % 3]];
      lengths.push_back(Distance(a[0], a[1], a[2], b[0], b[1], b[2]));
    }
  }
  return lengths;
}

/** Eq. (1). */
inline void ExpectLegalEdges(const SurfaceResult& surface)
{
  const std::vector<double> lengths = EdgeLengths(surface);
  EXPECT_GE(*std::min_element(lengths.begin(), lengths.end()), surface.Delta * (1 - 1e-5));
  EXPECT_LE(*std::max_element(lengths.begin(), lengths.end()), surface.Delta * 2.5 * (1 + 1e-5));
}

/** All that rows tell, but for the seconds. */
inline void ExpectSameHistory(const std::vector<HistoryRow>& a, const std::vector<HistoryRow>& b)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    const auto numbers = [](const HistoryRow& row)
    {
      return std::vector<double>{ double(row.Iteration), double(row.Level), double(row.Vertices),
        row.KineticEnergy, row.MeanEdgeLength, row.TimeStep, double(row.ActiveVertices),
        double(row.Merges), double(row.Cuts), double(row.Splits), double(row.Collapses),
        double(row.Flips), double(row.EulerCharacteristic), double(row.Components),
        double(row.Recovered), double(row.Deletions), double(row.DeletedGenus),
        double(row.AddedEulerCharacteristic), double(row.IterationVertices),
        row.IterationMeanEdgeLength, double(row.IterationEulerCharacteristic),
        double(row.IterationComponents), double(row.RegularisationCuts),
        double(row.RegularisationDeletions) };
    };
    ASSERT_EQ(numbers(a[i]), numbers(b[i])) << "row " << i;
  }
}
}

#endif
