// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEvolutionTestTools_h
#define volumicEvolutionTestTools_h

#include "Core/Evolution/Evolution.h"
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
    : Fine(MakeVolume(n, [&](double x, double y, double z) { return Soft(shownFine(x, y, z)); }))
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
inline Executor Threads;
inline Monitor Silent;

/** The steps of EvolveOnLevel(), one by one, level after level. */
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

  LevelTask Task; ///< Of the levels to come.
  ConvergedSurface Rest;
  std::function<void()> AfterSweep;
  std::unique_ptr<Evolution> Now; ///< On the level.

  void StartEnclosing(const LevelImage& image, int level) { this->Start(image, level, {}); }
  /** @return how many there are */
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
  /** @return false where it was stopped before: then it is on the level before. */
  bool Divide(const LevelImage& image, int level)
  {
    this->Leave();
    return this->Come(image, level, nullptr);
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
    this->Come(image, level, &start);
  }
  bool Come(const LevelImage& image, int level, const SurfaceStart* start)
  {
    this->Task.Image = image;
    this->Task.Level = level;
    this->Task.Start = start;
    auto before = std::exchange(this->Now,
      std::make_unique<Evolution>(this->Task, this->Rest.History, this->Executing, this->Listener));
    const bool hasCome = ReachLevel(*this->Now, this->Rest);
    if (!hasCome)
    {
      before->State.Mesh = std::move(this->Rest.Mesh);
      before->Stopped = true;
      this->Now = std::move(before);
    }
    return hasCome;
  }

  Executor& Executing;
  Monitor& Listener;
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
}

#endif
