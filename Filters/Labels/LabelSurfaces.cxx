// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Labels/LabelSurfaces.h"

#include "Core/Common/StandardThreads.h"
#include "Input/SurfaceFile.h"
#include "Labels/LabelCourse.h"

#include <vtkPolyData.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
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

/** A surface that another rank has made, or has not; not its seconds. */
Message Packed(const LabelSurface& made)
{
  MessageWriter writer;
  writer.Add(made.Surface != nullptr);
  if (made.Surface)
  {
    writer.Add(made.WrongVoxels);
    writer.Add(made.MissedVoxels);
    writer.Add(made.IsFinished);
    writer.AddArray(MessageOf(made.Surface));
  }
  return writer.Take();
}

LabelSurface Unpacked(const Message& message)
{
  MessageReader reader(message);
  LabelSurface made;
  if (reader.Take<bool>())
  {
    made.WrongVoxels = reader.Take<vtkIdType>();
    made.MissedVoxels = reader.Take<vtkIdType>();
    made.IsFinished = reader.Take<bool>();
    made.Surface = SurfaceFrom(reader.TakeVector<char>());
  }
  return made;
}

/**
 * The work on all objects: which rank does which, and which are done one after another, which side
 * by side. Items are the objects that get surfaces, then those about them that only claim.
 */
class Making
{
public:
  Making(Communicator& ranks, LabelSurfaceMaker& maker, const LabelBricks& bricks,
    const std::vector<std::string>& names, int numberOfThreads, HostThreads& threads,
    const LabelSurfaceMaker::Progress& progress)
    : Ranks(ranks), Maker(maker), NumberOfThreads(numberOfThreads), Threads(threads),
      Progress(progress), Objects(ObjectsOf(maker, bricks, static_cast<int>(names.size()))),
      Sizes(SizesOf(bricks, Objects)), State(Sizes, names), IsDue(Objects.size(), 1),
      Surfaces(names.size()), Seconds(Objects.size(), 0.0)
  {
  }

  void AddClaims();
  void MakeSurfaces(std::vector<LabelSurface> finished);
  std::vector<LabelSurface> Take();

private:
  using Work = std::function<void(std::size_t item, int numberOfThreads, HostThreads& threads)>;

  static std::vector<int> ObjectsOf(
    const LabelSurfaceMaker& maker, const LabelBricks& bricks, int wanted);
  static std::vector<double> SizesOf(const LabelBricks& bricks, const std::vector<int>& objects);
  /** Which rank does which of the items that are due. @return its own, large ones first */
  std::vector<std::size_t> ShareOut();
  /**
   * By all ranks, several times a second, on the calling thread: how far they are, and whether one
   * of them is to stop. @return whether there is work left anywhere
   */
  bool Tell(bool isThrough = false);
  /** Work on the items that are due. */
  void Do(const std::string& title, const Work& work);
  void MakeDue(const std::string& title);
  /** What other ranks have made goes to rank 0. */
  void Collect();

  Communicator& Ranks;
  LabelSurfaceMaker& Maker;
  int NumberOfThreads;
  HostThreads& Threads;
  const LabelSurfaceMaker::Progress& Progress;
  std::vector<int> Objects; ///< of each item
  std::vector<double> Sizes;
  LabelCourse State;
  LabelProgress Others; ///< what they had done when they told last
  std::vector<std::uint8_t> IsDue;
  std::vector<int> RankOf; ///< of each item that is due
  std::vector<LabelSurface> Surfaces;
  std::vector<double> Seconds;
  double Before = 0.0; ///< share of all work that is done
  double Whole = 1.0;  ///< share of what the items' shares are of
};

std::vector<int> Making::ObjectsOf(
  const LabelSurfaceMaker& maker, const LabelBricks& bricks, int wanted)
{
  std::vector<int> objects(static_cast<std::size_t>(wanted));
  std::iota(objects.begin(), objects.end(), 1);
  if (maker.HasClaims())
  {
    const std::vector<int> about = bricks.NeighboursOf(wanted);
    objects.insert(objects.end(), about.begin(), about.end());
  }
  return objects;
}

/** About the work that an object is: the bricks that it is in. */
std::vector<double> Making::SizesOf(const LabelBricks& bricks, const std::vector<int>& objects)
{
  std::vector<double> sizes;
  for (const int object : objects)
  {
    const LabelExtent& extent = bricks.ExtentOf(object);
    sizes.push_back(1.0 +
      std::min(static_cast<double>(extent.Voxels), static_cast<double>(extent.Bricks.Count())));
  }
  return sizes;
}

std::vector<std::size_t> Making::ShareOut()
{
  const std::vector<double>& sizes = this->Sizes;
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
  std::vector<double> loads(static_cast<std::size_t>(this->Ranks.NumberOfRanks()), 0.0);
  std::vector<std::size_t> own;
  this->RankOf.assign(sizes.size(), 0);
  for (const std::size_t item : order)
  {
    if (this->IsDue[item] == 0)
    {
      continue;
    }
    const auto least = std::min_element(loads.begin(), loads.end());
    *least += sizes[item];
    this->RankOf[item] = static_cast<int>(least - loads.begin());
    if (this->RankOf[item] == this->Ranks.Rank())
    {
      own.push_back(item);
    }
  }
  return own;
}

bool Making::Tell(bool isThrough)
{
  LabelProgress all = this->State.Here();
  all.Add(this->Others);
  if (!this->Progress(this->Before + this->Whole * this->State.Share(all), this->State.Text(all)))
  {
    this->State.IsStopped = true;
  }
  struct Word
  {
    LabelProgress Done;
    bool IsStopped;
    bool IsThrough;
  };
  const std::vector<Word> words =
    GatherValues(this->Ranks, Word{ this->State.Here(), this->State.IsStopped, isThrough });
  this->Others = LabelProgress();
  bool areThrough = true;
  for (int rank = 0; rank < this->Ranks.NumberOfRanks(); ++rank)
  {
    const Word& word = words[static_cast<std::size_t>(rank)];
    this->State.IsStopped = this->State.IsStopped || word.IsStopped;
    areThrough = areThrough && word.IsThrough;
    if (rank != this->Ranks.Rank())
    {
      this->Others.Add(word.Done);
    }
  }
  return !areThrough;
}

void Making::Do(const std::string& title, const Work& work)
{
  const std::vector<std::size_t> own = this->ShareOut();
  this->Others = LabelProgress();
  this->State.Expect(title, this->IsDue, own);
  this->Tell();
  const auto doItem = [&](std::size_t item, int numberOfThreads, HostThreads& threads)
  {
    if (this->State.IsStopped)
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
  const int most = this->Threads.NumberOfThreads();
  double rest = 0.0;
  for (const std::size_t item : own)
  {
    rest += this->Sizes[item];
  }
  // While one is on its own, the others would wait for it at the end.
  auto small = own.begin();
  for (; small != own.end() && this->Sizes[*small] * most > rest; ++small)
  {
    rest -= this->Sizes[*small];
  }
  const auto tell = [this]
  {
    try
    {
      this->Tell();
    }
    catch (...)
    {
      this->State.IsStopped = true; // Those that are under way are waited for.
      throw;
    }
  };
  // On the calling thread, which tells of each iteration, or, if others listen, beside it.
  const bool isOne = this->Ranks.NumberOfRanks() == 1;
  const auto large = static_cast<std::size_t>(small - own.begin());
  StandardThreads(isOne ? 1 : 2)
    .ForEach(
      large, [&](std::size_t i) { doItem(own[i], this->NumberOfThreads, this->Threads); }, tell);
  const std::size_t others = own.size() - large;
  StandardThreads(static_cast<int>(std::min(others, static_cast<std::size_t>(most))) + 1)
    .ForEach(
      others,
      [&](std::size_t i)
      {
        HostThreads one(1);
        doItem(own[large + i], 1, one);
      },
      tell);
  while (!isOne && this->Tell(true))
  {
    std::this_thread::sleep_for(StandardThreads::Pause);
  }
}

void Making::AddClaims()
{
  constexpr double claimShare = 0.1;
  this->Whole = claimShare;
  this->Do("fields: ",
    [&](std::size_t item, int, HostThreads& threads)
    { this->Maker.AddClaim(this->Objects[item], threads); });
  this->Maker.ShareClaims(this->Ranks);
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
        this->Maker.Make(this->Objects[item], numberOfThreads, threads,
          [&, item](double share, const std::string&)
          {
            this->State.Tell(item, share);
            if (std::this_thread::get_id() == caller)
            {
              this->Tell();
            }
            return !this->State.IsStopped;
          });
      if (made.Surface) // else it was stopped, and what there is stays
      {
        this->Surfaces[item] = made;
        this->Surfaces[item].IsFinished = !this->State.IsStopped;
      }
    });
  this->Collect();
}

void Making::Collect()
{
  for (std::size_t item = 0; item < this->Surfaces.size(); ++item)
  {
    const int from = this->IsDue[item] != 0 ? this->RankOf[item] : 0;
    LabelSurface& surface = this->Surfaces[item];
    if (from != 0 && this->Ranks.Rank() == from)
    {
      this->Ranks.Pass(from, 0, Packed(std::exchange(surface, {})));
    }
    else if (from != 0 && this->Ranks.Rank() == 0)
    {
      const LabelSurface made = Unpacked(this->Ranks.Pass(from, 0));
      surface = made.Surface ? made : surface;
    }
  }
}

void Making::MakeSurfaces(std::vector<LabelSurface> finished)
{
  std::fill(this->IsDue.begin() + static_cast<std::ptrdiff_t>(this->Surfaces.size()),
    this->IsDue.end(), std::uint8_t(0));
  // With a gap those that are drawn apart later count as well.
  if (finished.size() == this->Surfaces.size() && !this->Maker.KeepsApart())
  {
    this->Surfaces = std::move(finished);
    std::transform(this->Surfaces.begin(), this->Surfaces.end(), this->IsDue.begin(),
      [](const LabelSurface& surface) { return surface.IsFinished ? 0 : 1; });
  }
  MessageWriter due;
  due.AddArray(this->IsDue);
  const Message told = this->Ranks.Broadcast(due.Take());
  MessageReader(told).TakeArray(this->IsDue);
  const double afterwards = this->Maker.KeepsApart() ? 0.3 * this->Whole : 0.0;
  this->Whole -= afterwards;
  this->MakeDue("");
  for (int round = 0; this->Maker.KeepsApart() && !this->State.IsStopped; ++round)
  {
    this->Before += this->Whole;
    this->Whole = round == 0 ? 0.5 * afterwards : 0.5 * this->Whole;
    const std::vector<int> touching =
      this->Maker.DrawApart(this->Ranks, this->Surfaces, this->Threads);
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
  MessageWriter own;
  own.AddArray(this->Seconds);
  for (const Message& of : this->Ranks.Gather(own.Take()))
  {
    MessageReader reader(of);
    const std::vector<double> seconds = reader.TakeVector<double>();
    for (std::size_t i = 0; i < this->Surfaces.size(); ++i)
    {
      this->Surfaces[i].Seconds += seconds[i]; // Those that are kept have some.
    }
  }
  return std::move(this->Surfaces);
}
}

std::vector<LabelSurface> MakeLabelSurfaces(Communicator& ranks, LabelSurfaceMaker& maker,
  const LabelBricks& bricks, const std::vector<std::string>& names, int numberOfThreads,
  HostThreads& threads, const LabelSurfaceMaker::Progress& progress,
  std::vector<LabelSurface> finished)
{
  Making making(ranks, maker, bricks, names, numberOfThreads, threads, progress);
  if (maker.HasClaims())
  {
    making.AddClaims();
  }
  making.MakeSurfaces(std::move(finished));
  return making.Take();
}
}
