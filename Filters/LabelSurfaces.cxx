// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelSurfaces.h"

#include <vtkPolyData.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <numeric>
#include <string>
#include <system_error>
#include <thread>

namespace volumic
{
namespace
{
/** How often the calling thread tells progress while others work. */
constexpr std::chrono::milliseconds Pause(50);

/** With Gap: how often surfaces that touch those of neighbours are made again, further inside. */
constexpr int MostRoundsApart = 5;

/** What is done of all objects. */
class Course
{
public:
  explicit Course(const std::vector<double>& sizes) : Sizes(sizes), Shares(sizes.size())
  {
    for (std::atomic<float>& share : this->Shares)
    {
      share = 0.f;
    }
    this->Whole = std::accumulate(sizes.begin(), sizes.end(), 0.0);
  }

  /** On any thread. @return whether to go on. */
  bool Tell(std::size_t item, double share)
  {
    this->Shares[item] = static_cast<float>(share);
    return !this->IsStopped;
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

  std::atomic<bool> IsStopped{ false };

private:
  const std::vector<double>& Sizes;
  std::vector<std::atomic<float>> Shares;
  double Whole;
};

/** Work on items, each on one thread, while the calling one tells how it goes. */
class SideBySide
{
public:
  SideBySide(std::vector<std::size_t> items, std::function<void(std::size_t)> work)
    : Items(std::move(items)), Work(std::move(work))
  {
  }

  /** @param tell called on the calling thread now and then */
  void Run(int numberOfThreads, const std::function<void()>& tell)
  {
    std::vector<std::thread> others;
    try
    {
      for (int t = 0; t < numberOfThreads && others.size() < this->Items.size(); ++t)
      {
        ++this->Running;
        others.emplace_back([this] { this->WorkOn(); });
      }
    }
    catch (const std::system_error&)
    {
      --this->Running; // The system denies a thread: those that there are do the work.
    }
    if (others.empty())
    {
      ++this->Running;
      this->WorkOn();
    }
    {
      std::unique_lock<std::mutex> lock(this->Mutex);
      while (!this->Finished.wait_for(lock, Pause, [this] { return this->Running == 0; }))
      {
        lock.unlock();
        tell();
        lock.lock();
      }
    }
    for (std::thread& thread : others)
    {
      thread.join();
    }
    if (this->Exception)
    {
      std::rethrow_exception(this->Exception);
    }
  }

private:
  void WorkOn()
  {
    try
    {
      for (std::size_t next = this->Next++; next < this->Items.size(); next = this->Next++)
      {
        this->Work(this->Items[next]);
      }
    }
    catch (...)
    {
      this->Next = this->Items.size();
      const std::lock_guard<std::mutex> lock(this->Mutex);
      this->Exception = this->Exception ? this->Exception : std::current_exception();
    }
    const std::lock_guard<std::mutex> lock(this->Mutex);
    --this->Running;
    this->Finished.notify_all();
  }

  std::vector<std::size_t> Items;
  std::function<void(std::size_t)> Work;
  std::atomic<std::size_t> Next{ 0 };
  std::atomic<int> Running{ 0 };
  std::mutex Mutex;
  std::condition_variable Finished;
  std::exception_ptr Exception;
};

/** About the work that an object is: the bricks that it is in. */
std::vector<double> SizesOf(const LabelBricks& bricks, int wanted)
{
  std::vector<double> sizes;
  for (int object = 1; object <= wanted; ++object)
  {
    const LabelExtent& extent = bricks.ExtentOf(object);
    sizes.push_back(1.0 +
      std::min(static_cast<double>(extent.Voxels), static_cast<double>(extent.Bricks.Count())));
  }
  return sizes;
}
}

std::vector<LabelSurface> MakeLabelSurfaces(LabelSurfaceMaker& maker, const LabelBricks& bricks,
  int wanted, int numberOfThreads, HostThreads& threads,
  const LabelSurfaceMaker::Progress& progress)
{
  const std::vector<double> sizes = SizesOf(bricks, wanted);
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
  const int hardware = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int most = numberOfThreads > 0 ? std::min(numberOfThreads, hardware) : hardware;
  // While one is on its own, the others would wait for it at the end.
  std::size_t alone = 0;
  double rest = std::accumulate(sizes.begin(), sizes.end(), 0.0);
  while (alone < order.size() && sizes[order[alone]] * most > rest)
  {
    rest -= sizes[order[alone++]];
  }

  std::vector<LabelSurface> surfaces(sizes.size());
  std::vector<std::uint8_t> isDue(sizes.size(), 1);
  Course course(sizes);
  constexpr double claimShare = 0.1;
  double before = 0.0;
  double whole = 1.0;
  const auto tell = [&](const std::string& text)
  {
    if (!progress(before + whole * course.Share(), text))
    {
      course.IsStopped = true;
    }
    return !course.IsStopped;
  };
  const auto doAll = [&](const std::string& text,
                       const std::function<void(std::size_t, int, HostThreads&)>& work)
  {
    if (!tell(text))
    {
      return;
    }
    for (std::size_t i = 0; i < alone && tell(text); ++i)
    {
      work(order[i], numberOfThreads, threads);
    }
    SideBySide others({ order.begin() + static_cast<std::ptrdiff_t>(alone), order.end() },
      [&](std::size_t item)
      {
        HostThreads one(1);
        work(item, 1, one);
      });
    others.Run(most, [&] { tell(text); });
  };
  if (maker.HasClaims())
  {
    whole = claimShare;
    doAll("Fields of the labels",
      [&](std::size_t item, int, HostThreads& own)
      {
        if (!course.IsStopped)
        {
          maker.AddClaim(static_cast<int>(item) + 1, own);
          course.Tell(item, 1.0);
        }
      });
    for (const int neighbour : bricks.NeighboursOf(wanted))
    {
      if (tell("Fields of the labels about them"))
      {
        maker.AddClaim(neighbour, threads);
      }
    }
    before = claimShare;
    whole = 1.0 - claimShare;
    for (std::size_t i = 0; i < sizes.size(); ++i)
    {
      course.Tell(i, 0.0);
    }
  }
  const std::thread::id caller = std::this_thread::get_id();
  const auto makeDue = [&](const std::string& text)
  {
    doAll(text,
      [&](std::size_t item, int number, HostThreads& own)
      {
        if (course.IsStopped || isDue[item] == 0)
        {
          return;
        }
        const LabelSurface made = maker.Make(static_cast<int>(item) + 1, number, own,
          [&, item](double share, const std::string&)
          {
            const bool goesOn = course.Tell(item, share);
            return std::this_thread::get_id() == caller ? tell(text) : goesOn;
          });
        if (made.Surface) // else it was stopped, and what there is stays
        {
          surfaces[item] = made;
        }
        course.Tell(item, 1.0);
      });
  };
  const double afterwards = maker.KeepsApart() ? 0.3 * whole : 0.0;
  whole -= afterwards;
  makeDue("Surfaces of the labels");
  for (int round = 0; maker.KeepsApart() && !course.IsStopped; ++round)
  {
    before += whole;
    whole = round == 0 ? 0.5 * afterwards : 0.5 * whole;
    const std::vector<int> touching = maker.DrawApart(surfaces, threads);
    if (touching.empty() || round == MostRoundsApart)
    {
      break;
    }
    std::fill(isDue.begin(), isDue.end(), std::uint8_t(0));
    for (const int object : touching)
    {
      isDue[static_cast<std::size_t>(object) - 1] = 1;
      course.Tell(static_cast<std::size_t>(object) - 1, 0.0);
    }
    makeDue("Drawing neighbours apart");
  }
  return surfaces;
}
}
