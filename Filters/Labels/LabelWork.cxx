// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Labels/LabelWork.h"

#include "Core/Common/StandardThreads.h"

#include <vtkPolyData.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <thread>
#include <utility>

namespace volumic
{
namespace
{
std::vector<int> ObjectsOf(const LabelSurfaceMaker& maker, const LabelBricks& bricks, int wanted)
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

std::vector<double> SizesOf(const LabelBricks& bricks, const std::vector<int>& objects)
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
}

LabelWork::LabelWork(LabelSurfaceMaker& maker, const LabelBricks& bricks,
  const std::vector<std::string>& names, int numberOfThreads)
  : Maker(maker), NumberOfThreads(numberOfThreads), Threads(numberOfThreads),
    Objects(ObjectsOf(maker, bricks, static_cast<int>(names.size()))),
    SizeOf(SizesOf(bricks, Objects)), State(SizeOf, names), Surfaces(names.size())
{
}

void LabelWork::DoItem(Kind kind, std::size_t item, int numberOfThreads, HostThreads& threads,
  const std::function<void()>& tell)
{
  if (this->State.IsStopped)
  {
    return;
  }
  this->State.Begin(item);
  if (kind == Kind::Claim)
  {
    this->Maker.AddClaim(this->Objects[item], threads);
    this->State.End(item);
    return;
  }
  const auto started = std::chrono::steady_clock::now();
  LabelSurface made = this->Maker.Make(this->Objects[item], numberOfThreads, threads,
    [&](double share, const std::string&)
    {
      this->State.Tell(item, share);
      tell();
      return !this->State.IsStopped;
    });
  LabelSurface& surface = this->Surfaces[item];
  const double seconds = surface.Seconds +
    std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  if (made.Surface) // else it was stopped, and what there is stays
  {
    surface = std::move(made);
    surface.IsFinished = !this->State.IsStopped;
  }
  surface.Seconds = seconds;
  this->State.End(item);
}

void LabelWork::Do(Kind kind, const std::vector<std::size_t>& own, bool isBeside,
  const std::function<void()>& tell)
{
  const auto tellHere = [this, &tell]
  {
    try
    {
      tell();
    }
    catch (...)
    {
      this->State.IsStopped = true; // Those that are under way are waited for.
      throw;
    }
  };
  tellHere();
  const int most = this->Threads.NumberOfThreads();
  double rest = 0.0;
  for (const std::size_t item : own)
  {
    rest += this->SizeOf[item];
  }
  // While one is on its own, the others would wait for it at the end.
  auto small = own.begin();
  for (; small != own.end() && this->SizeOf[*small] * most > rest; ++small)
  {
    rest -= this->SizeOf[*small];
  }
  const std::thread::id caller = std::this_thread::get_id();
  const auto tellOfItem = [&]
  {
    if (std::this_thread::get_id() == caller)
    {
      tell();
    }
  };
  const auto large = static_cast<std::size_t>(small - own.begin());
  StandardThreads(isBeside ? 2 : 1)
    .ForEach(
      large,
      [&](std::size_t i)
      { this->DoItem(kind, own[i], this->NumberOfThreads, this->Threads, tellOfItem); },
      tellHere);
  const std::size_t others = own.size() - large;
  StandardThreads(static_cast<int>(std::min(others, static_cast<std::size_t>(most))) + 1)
    .ForEach(
      others,
      [&](std::size_t i)
      {
        HostThreads one(1);
        this->DoItem(kind, own[large + i], 1, one, tellOfItem);
      },
      tellHere);
}
}
