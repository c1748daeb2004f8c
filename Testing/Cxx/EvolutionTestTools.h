// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEvolutionTestTools_h
#define volumicEvolutionTestTools_h

#include "Core/Evolution/Evolution.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "CoreTestTools.h"

namespace volumic
{
/** Ball at the centre of n x n x n voxels; iso-value .5. */
inline TestVolume BallVolume(int n, double radius)
{
  return MakeVolume(n,
    [n, radius](double x, double y, double z)
    { return Soft(Distance(x, y, z, 0.5 * n, 0.5 * n, 0.5 * n) - radius); });
}

/** Two sampled levels of a scene. Lengths are voxels of the finer level. */
struct LevelPair
{
  TestVolume Fine;
  TestVolume Coarse;

  /** @param fine, coarse signed distances of each level, positive outside */
  template <typename FineDistance, typename CoarseDistance>
  LevelPair(int n, const FineDistance& fine, const CoarseDistance& coarse)
    : Fine(MakeVolume(n, [&](double x, double y, double z) { return Soft(fine(x, y, z)); }))
  {
    const int size = static_cast<int>(std::lround(n / std::sqrt(3.)));
    const double step = static_cast<double>(n) / size;
    this->Coarse = MakeVolume(size,
      [&](double x, double y, double z)
      { return Soft(coarse(x * step, y * step, z * step) / step); });
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

/** Default executor (one thread) and monitor (never cancels). */
inline Executor Threads;
inline Monitor Silent;

/** Runs the steps of EvolveOnLevel() one by one. */
class TestEvolution
{
public:
  TestEvolution(const SurfaceOptions& options, Executor& executor, Monitor& monitor)
    : Executing(executor), Listener(monitor)
  {
    this->Task.Options = options;
    this->Task.Observe = [this](int iteration, const std::function<SurfaceResult()>&)
    {
      if (iteration > 0 && this->AfterSweep)
      {
        this->AfterSweep();
      }
    };
  }

  LevelTask Task; ///< for the next levels
  ConvergedSurface Rest;
  std::function<void()> AfterSweep;
  std::unique_ptr<Evolution> Now; ///< on the current level

  void StartEnclosing(const LevelImage& image, int level) { this->Start(image, level, {}); }
  /** @return number of seeds */
  int StartSeeds(const LevelImage& image, int level, const std::vector<Point>& seeds)
  {
    this->Start(image, level, { SurfaceStart::Kind::Seeds, seeds, {} });
    return this->Now->Components.NumberOfComponents();
  }
  void StartSurface(const LevelImage& image, int level, const IndexedSurface& surface)
  {
    this->Start(image, level, { SurfaceStart::Kind::Surface, {}, surface });
  }
  void StartIsoSurface(const LevelImage& image, int level)
  {
    this->Start(image, level, { SurfaceStart::Kind::IsoSurface, {}, {} });
    LabelComponents(*this->Now);
  }
  /** @return false if cancelled; the evolution then stays on the coarser level */
  bool Divide(const LevelImage& image, int level)
  {
    this->Leave();
    return this->Enter(image, level, nullptr);
  }
  StopReason Run() { return RunLevel(*this->Now); }
  void Leave()
  {
    if (this->Now)
    {
      ForgetBlocks(*this->Now);
      this->Rest.Mesh = std::move(this->Now->State.Mesh);
      this->Rest.Level = this->Now->Task.Level;
      this->Rest.Delta = this->Now->State.Sizing.OfLevel();
      this->Rest.Unchecked = this->Now->Unchecked;
    }
  }

  SurfaceResult Result() const { return this->Now->Result(); }
  const std::vector<HistoryRow>& History() const { return this->Rest.History.Rows; }
  int Iterations() const { return this->Rest.History.Iterations(); }
  MissedParts Missed() const { return this->Now->Missed; }
  Verdict Verified() const { return this->Now->Verified; }
  bool IsStopped() const { return this->Now->Stopped; }

private:
  void Start(const LevelImage& image, int level, const SurfaceStart& start)
  {
    this->Enter(image, level, &start);
  }
  bool Enter(const LevelImage& image, int level, const SurfaceStart* start)
  {
    this->Task.Image = image;
    this->Task.Level = level;
    this->Task.Start = start;
    auto before = std::exchange(this->Now,
      std::make_unique<Evolution>(this->Task, this->Rest.History, this->Executing, this->Listener));
    const bool hasReached = ReachLevel(*this->Now, this->Rest);
    if (!hasReached)
    {
      before->State.Mesh = std::move(this->Rest.Mesh);
      before->Stopped = true;
      this->Now = std::move(before);
    }
    return hasReached;
  }

  Executor& Executing;
  Monitor& Listener;
};

/** Return the lengths of all edges, each twice. */
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

inline void ExpectEdgesWithin(const IndexedSurface& surface, double shortest, double longest)
{
  const std::vector<double> lengths = EdgeLengths(surface);
  EXPECT_GE(*std::min_element(lengths.begin(), lengths.end()), shortest);
  EXPECT_LE(*std::max_element(lengths.begin(), lengths.end()), longest);
}

/** Expect edge lengths within the bounds of eq. (1). */
inline void ExpectLegalEdges(const SurfaceResult& surface)
{
  ExpectEdgesWithin(surface, surface.Delta * (1 - 1e-5), surface.Delta * 2.5 * (1 + 1e-5));
}
}

#endif
