// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Labels/LabelSurfaces.h"

#include "Host/SideBySide.h"

#include <vtkPolyData.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <numeric>
#include <string>
#include <thread>
#include <utility>

namespace volumic
{
namespace
{
/** With Gap: how often surfaces that touch those of neighbours are made again, further inside. */
constexpr int MostRoundsApart = 5;

/** What is done of all objects, and which of them are under way. */
class Course
{
public:
  Course(const std::vector<double>& sizes, const std::vector<std::string>& names)
    : Sizes(sizes), Names(names), Shares(sizes.size())
  {
    for (std::atomic<float>& share : this->Shares)
    {
      share = 0.f;
    }
    this->Whole = std::accumulate(sizes.begin(), sizes.end(), 0.0);
  }

  /** Some of the items are to be done, for the first time or anew. */
  void Expect(const std::string& title, const std::vector<std::uint8_t>& isDue)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Title = title;
    this->Finished = 0;
    this->Expected = static_cast<std::size_t>(std::count(isDue.begin(), isDue.end(), 1));
    for (std::size_t i = 0; i < isDue.size(); ++i)
    {
      this->Shares[i] = isDue[i] != 0 ? 0.f : 1.f;
    }
  }

  // The next three on any thread.

  void Begin(std::size_t item)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->UnderWay.push_back(item);
  }
  /** @return whether to go on. */
  bool Tell(std::size_t item, double share)
  {
    this->Shares[item] = static_cast<float>(share);
    return !this->IsStopped;
  }
  void End(std::size_t item)
  {
    this->Shares[item] = 1.f;
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->UnderWay.erase(std::find(this->UnderWay.begin(), this->UnderWay.end(), item));
    ++this->Finished;
  }

  double Share() const
  {
    double done = 0.0;
    for (std::size_t i = 0; i < this->Sizes.size(); ++i)
    {
      done += this->Sizes[i] * this->Shares[i];
    }
    return done / this->Whole;
  }

  /** `12 of 39, liver`: how many are finished, and that which was begun last of those under way. */
  std::string Text() const
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    const std::string text =
      this->Title + std::to_string(this->Finished) + " of " + std::to_string(this->Expected);
    return this->UnderWay.empty() ? text : text + ", " + this->Names[this->UnderWay.back()];
  }

  std::atomic<bool> IsStopped{ false };

private:
  const std::vector<double>& Sizes;
  const std::vector<std::string>& Names;
  std::vector<std::atomic<float>> Shares;
  double Whole;
  mutable std::mutex Mutex; ///< of what follows
  std::string Title;
  std::vector<std::size_t> UnderWay; ///< in the order in which they were begun
  std::size_t Finished = 0;
  std::size_t Expected = 0;
};

/** About the work that an object is: the bricks that it is in. */
std::vector<double> SizesOf(const LabelBricks& bricks, std::size_t wanted)
{
  std::vector<double> sizes;
  for (int object = 1; object <= static_cast<int>(wanted); ++object)
  {
    const LabelExtent& extent = bricks.ExtentOf(object);
    sizes.push_back(1.0 +
      std::min(static_cast<double>(extent.Voxels), static_cast<double>(extent.Bricks.Count())));
  }
  return sizes;
}

/** The work on all objects: which are made one after another and which side by side, and when. */
class Making
{
public:
  Making(LabelSurfaceMaker& maker, const LabelBricks& bricks, const std::vector<std::string>& names,
    int numberOfThreads, HostThreads& threads, const LabelSurfaceMaker::Progress& progress)
    : Maker(maker), Bricks(bricks), NumberOfThreads(numberOfThreads), Threads(threads),
      Progress(progress), Sizes(SizesOf(bricks, names.size())), State(Sizes, names),
      IsDue(names.size(), 1), Surfaces(names.size()), Seconds(names.size(), 0.0)
  {
    this->Plan();
  }

  void AddClaims();
  void MakeSurfaces(std::vector<LabelSurface> finished);
  std::vector<LabelSurface> Take();

private:
  using Work = std::function<void(std::size_t item, int numberOfThreads, HostThreads& threads)>;

  void Plan();
  /** On the calling thread. @return whether to go on. */
  bool Tell(const std::string& text);
  bool Tell() { return this->Tell(this->State.Text()); }
  /** Work on the items that are due. */
  void Do(const std::string& title, const Work& work);
  void MakeDue(const std::string& title);

  LabelSurfaceMaker& Maker;
  const LabelBricks& Bricks;
  int NumberOfThreads;
  HostThreads& Threads;
  const LabelSurfaceMaker::Progress& Progress;
  std::vector<double> Sizes;
  Course State;
  std::vector<std::uint8_t> IsDue;
  std::vector<LabelSurface> Surfaces;
  std::vector<double> Seconds;
  std::vector<std::size_t> Order; ///< large ones first
  std::size_t Alone = 0;          ///< so many of these one after another
  int Most = 1;                   ///< threads
  double Before = 0.0;            ///< share of all work that is done
  double Whole = 1.0;             ///< share of what the items' shares are of
};

void Making::Plan()
{
  const std::vector<double>& sizes = this->Sizes;
  this->Order.resize(sizes.size());
  std::iota(this->Order.begin(), this->Order.end(), std::size_t(0));
  std::stable_sort(this->Order.begin(), this->Order.end(),
    [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
  const int hardware = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  this->Most = this->NumberOfThreads > 0 ? std::min(this->NumberOfThreads, hardware) : hardware;
  // While one is on its own, the others would wait for it at the end.
  double rest = std::accumulate(sizes.begin(), sizes.end(), 0.0);
  while (this->Alone < sizes.size() && sizes[this->Order[this->Alone]] * this->Most > rest)
  {
    rest -= sizes[this->Order[this->Alone++]];
  }
}

bool Making::Tell(const std::string& text)
{
  if (!this->Progress(this->Before + this->Whole * this->State.Share(), text))
  {
    this->State.IsStopped = true;
  }
  return !this->State.IsStopped;
}

void Making::Do(const std::string& title, const Work& work)
{
  this->State.Expect(title, this->IsDue);
  if (!this->Tell())
  {
    return;
  }
  const auto doItem = [&](std::size_t item, int numberOfThreads, HostThreads& threads)
  {
    if (this->State.IsStopped || this->IsDue[item] == 0)
    {
      return;
    }
    const auto started = std::chrono::steady_clock::now();
    this->State.Begin(item);
    work(item, numberOfThreads, threads);
    this->State.End(item);
    this->Seconds[item] +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  };
  for (std::size_t i = 0; i < this->Alone && this->Tell(); ++i)
  {
    doItem(this->Order[i], this->NumberOfThreads, this->Threads);
  }
  SideBySide others(
    { this->Order.begin() + static_cast<std::ptrdiff_t>(this->Alone), this->Order.end() },
    [&](std::size_t item)
    {
      HostThreads one(1);
      doItem(item, 1, one);
    });
  try
  {
    others.Run(this->Most, [this] { this->Tell(); });
  }
  catch (...)
  {
    this->State.IsStopped = true; // Those that are under way are waited for.
    throw;
  }
}

void Making::AddClaims()
{
  constexpr double claimShare = 0.1;
  this->Whole = claimShare;
  this->Do("fields: ",
    [&](std::size_t item, int, HostThreads& threads)
    { this->Maker.AddClaim(static_cast<int>(item) + 1, threads); });
  for (const int neighbour : this->Bricks.NeighboursOf(static_cast<int>(this->Sizes.size())))
  {
    if (this->Tell("fields of the labels about them"))
    {
      this->Maker.AddClaim(neighbour, this->Threads);
    }
  }
  this->Before = claimShare;
  this->Whole = 1.0 - claimShare;
}

void Making::MakeDue(const std::string& title)
{
  const std::thread::id caller = std::this_thread::get_id();
  this->Do(title,
    [&](std::size_t item, int numberOfThreads, HostThreads& threads)
    {
      const LabelSurface made =
        this->Maker.Make(static_cast<int>(item) + 1, numberOfThreads, threads,
          [&, item](double share, const std::string&)
          {
            const bool goesOn = this->State.Tell(item, share);
            return std::this_thread::get_id() == caller ? this->Tell() : goesOn;
          });
      if (made.Surface) // else it was stopped, and what there is stays
      {
        this->Surfaces[item] = made;
        this->Surfaces[item].IsFinished = !this->State.IsStopped;
      }
    });
}

void Making::MakeSurfaces(std::vector<LabelSurface> finished)
{
  // With a gap those that are drawn apart later count as well.
  if (finished.size() == this->Surfaces.size() && !this->Maker.KeepsApart())
  {
    this->Surfaces = std::move(finished);
    std::transform(this->Surfaces.begin(), this->Surfaces.end(), this->IsDue.begin(),
      [](const LabelSurface& surface) { return surface.IsFinished ? 0 : 1; });
  }
  const double afterwards = this->Maker.KeepsApart() ? 0.3 * this->Whole : 0.0;
  this->Whole -= afterwards;
  this->MakeDue("");
  for (int round = 0; this->Maker.KeepsApart() && !this->State.IsStopped; ++round)
  {
    this->Before += this->Whole;
    this->Whole = round == 0 ? 0.5 * afterwards : 0.5 * this->Whole;
    const std::vector<int> touching = this->Maker.DrawApart(this->Surfaces, this->Threads);
    if (touching.empty() || round == MostRoundsApart)
    {
      break;
    }
    std::fill(this->IsDue.begin(), this->IsDue.end(), std::uint8_t(0));
    for (const int object : touching)
    {
      this->IsDue[static_cast<std::size_t>(object) - 1] = 1;
    }
    this->MakeDue("apart: ");
  }
}

std::vector<LabelSurface> Making::Take()
{
  for (std::size_t i = 0; i < this->Surfaces.size(); ++i)
  {
    this->Surfaces[i].Seconds += this->Seconds[i]; // Those that are kept have some.
  }
  return std::move(this->Surfaces);
}
}

std::vector<LabelSurface> MakeLabelSurfaces(LabelSurfaceMaker& maker, const LabelBricks& bricks,
  const std::vector<std::string>& names, int numberOfThreads, HostThreads& threads,
  const LabelSurfaceMaker::Progress& progress, std::vector<LabelSurface> finished)
{
  Making making(maker, bricks, names, numberOfThreads, threads, progress);
  if (maker.HasClaims())
  {
    making.AddClaims();
  }
  making.MakeSurfaces(std::move(finished));
  return making.Take();
}
}
