// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEvolutionTestTools_h
#define volumicEvolutionTestTools_h

#include "Core/Evolution/Evolution.h"
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
  return WithIso(0.5);
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

  LevelTask Task;             ///< for the next levels
  ConvergedSurface Converged; ///< result of the previous level
  std::function<void()> AfterSweep;
  std::unique_ptr<Evolution> Current;

  void StartEnclosing(const LevelImage& image, int level) { this->Start(image, level, {}); }
  StopReason RunEnclosing(const LevelImage& image, int level)
  {
    this->StartEnclosing(image, level);
    return this->Run();
  }
  /** @return number of seeds */
  int StartSeeds(const LevelImage& image, int level, const std::vector<Point>& seeds)
  {
    this->Start(image, level, { SurfaceStart::Kind::Seeds, seeds, {} });
    return this->Current->Components.NumberOfComponents();
  }
  void StartSurface(const LevelImage& image, int level, const IndexedSurface& surface)
  {
    this->Start(image, level, { SurfaceStart::Kind::Surface, {}, surface });
  }
  void StartIsoSurface(const LevelImage& image, int level)
  {
    this->Start(image, level, { SurfaceStart::Kind::IsoSurface, {}, {} });
    LabelComponents(*this->Current);
  }
  /** @return false if cancelled; the evolution then stays on the coarser level */
  bool Divide(const LevelImage& image, int level)
  {
    this->Leave();
    return this->Enter(image, level, nullptr);
  }
  StopReason Run() { return RunLevel(*this->Current); }
  void Leave()
  {
    if (this->Current)
    {
      ForgetBlocks(*this->Current);
      this->Converged.Mesh = std::move(this->Current->State.Mesh);
      this->Converged.Level = this->Current->Task.Level;
      this->Converged.Delta = this->Current->State.Sizing.OfLevel();
      this->Converged.Unchecked = this->Current->Unchecked;
    }
  }

  SurfaceResult Result() const { return this->Current->Result(); }
  const std::vector<HistoryRow>& History() const { return this->Converged.History.Rows; }
  int Iterations() const { return this->Converged.History.Iterations(); }
  MissedParts Missed() const { return this->Current->Missed; }
  Verdict Verified() const { return this->Current->Verified; }
  bool IsStopped() const { return this->Current->Stopped; }

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
    auto before = std::exchange(this->Current,
      std::make_unique<Evolution>(
        this->Task, this->Converged.History, this->Executing, this->Listener));
    const bool hasReached = ReachLevel(*this->Current, this->Converged);
    if (!hasReached)
    {
      before->State.Mesh = std::move(this->Converged.Mesh);
      before->Stopped = true;
      this->Current = std::move(before);
    }
    return hasReached;
  }

  Executor& Executing;
  Monitor& Listener;
};

/** Expect edge lengths within the bounds of eq. (1). */
inline void ExpectLegalEdges(const SurfaceResult& surface)
{
  ExpectEdgesWithin(surface, surface.Delta * (1 - 1e-5), surface.Delta * 2.5 * (1 + 1e-5));
}
}

#endif
