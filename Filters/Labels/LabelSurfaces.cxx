// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Labels/LabelSurfaces.h"

#include "Core/Common/StandardThreads.h"
#include "Labels/LabelHelper.h"
#include "Labels/LabelWork.h"

#include <vtkPolyData.h>

#include <algorithm>
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

/** The work on all objects, at the first rank: which rank does which, and what comes after what. */
class Making
{
public:
  Making(Ranks& ranks, LabelSurfaceMaker& maker, const LabelBricks& bricks,
    const std::vector<std::string>& names, int numberOfThreads, HostThreads& threads,
    const LabelSurfaceMaker::Progress& progress)
    : All(ranks), Maker(maker), Threads(threads), Progress(progress),
      Work(maker, bricks, names, numberOfThreads), IsDue(Work.Sizes().size(), 1)
  {
  }

  void AddClaims();
  void MakeSurfaces(std::vector<LabelSurface> finished);
  std::vector<LabelSurface> Take() { return std::move(this->Work.Surfaces); }

private:
  /** Which rank does which of the items that are due, large ones first. */
  std::vector<std::vector<std::size_t>> ShareOut() const;
  /** How far all are, and whether any is to stop. @return whether others have work left */
  bool Tell();
  /** Work on the items that are due. @param own those of each rank */
  void Do(LabelWork::Kind kind, const std::string& title,
    const std::vector<std::vector<std::size_t>>& own);
  void MakeDue(const std::string& title);

  Ranks& All;
  LabelSurfaceMaker& Maker;
  HostThreads& Threads;
  const LabelSurfaceMaker::Progress& Progress;
  LabelWork Work;
  LabelProgress Others; ///< what they had done when they told last
  bool IsShared = true; ///< Each rank does some; else all do all.
  std::vector<std::uint8_t> IsDue;
  double Before = 0.0; ///< share of all work that is done
  double Whole = 1.0;  ///< share of what the items' shares are of
};

std::vector<std::vector<std::size_t>> Making::ShareOut() const
{
  const std::vector<double>& sizes = this->Work.Sizes();
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(
    order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
  std::vector<double> loads(static_cast<std::size_t>(this->All.Count()), 0.0);
  std::vector<std::vector<std::size_t>> own(loads.size());
  for (const std::size_t item : order)
  {
    if (this->IsDue[item] != 0)
    {
      const auto least = std::min_element(loads.begin(), loads.end());
      *least += sizes[item];
      own[static_cast<std::size_t>(least - loads.begin())].push_back(item);
    }
  }
  return own;
}

bool Making::Tell()
{
  LabelCourse& state = this->Work.State;
  LabelProgress all = state.Here();
  if (this->IsShared)
  {
    all.Add(this->Others);
  }
  const double share = this->Before + this->Whole * state.Share(all);
  const std::string text = state.Text(all);
  state.IsStopped = !this->Progress(share, text) || state.IsStopped;
  if (!this->All.AreMany())
  {
    return false;
  }
  const LabelHelper::Told told = LabelHelper::Tell(this->All, share, text, state.IsStopped);
  this->Others = told.Done;
  state.IsStopped = state.IsStopped || told.Stop;
  return !told.AreThrough;
}

void Making::Do(
  LabelWork::Kind kind, const std::string& title, const std::vector<std::vector<std::size_t>>& own)
{
  this->Others = LabelProgress();
  LabelHelper::Do(this->All, kind, this->IsDue, own);
  this->Work.State.Expect(title, this->IsDue, own.front());
  this->Work.Do(kind, own.front(), this->All.AreMany(), [this] { this->Tell(); });
  while (this->All.AreMany() && this->Tell())
  {
    std::this_thread::sleep_for(StandardThreads::Pause);
  }
}

void Making::AddClaims()
{
  constexpr double claimShare = 0.1;
  this->Whole = claimShare;
  // Each rank finds those of all: what they are made of is told more slowly.
  this->IsShared = false;
  std::vector<std::size_t> all(this->IsDue.size());
  std::iota(all.begin(), all.end(), std::size_t(0));
  this->Do(LabelWork::Kind::Claim, "fields: ",
    std::vector<std::vector<std::size_t>>(static_cast<std::size_t>(this->All.Count()), all));
  this->IsShared = true;
  this->Before = claimShare;
  this->Whole = 1.0 - claimShare;
}

void Making::MakeDue(const std::string& title)
{
  const std::vector<std::vector<std::size_t>> own = this->ShareOut();
  this->Do(LabelWork::Kind::Surface, title, own);
  for (int rank = 1; rank < this->All.Count(); ++rank)
  {
    for (const std::size_t item : own[static_cast<std::size_t>(rank)])
    {
      const LabelSurface made = LabelHelper::Take(this->All, rank, item);
      LabelSurface& surface = this->Work.Surfaces[item];
      const double seconds = surface.Seconds + made.Seconds;
      surface = made.Surface ? made : surface;
      surface.Seconds = seconds;
    }
  }
}

void Making::MakeSurfaces(std::vector<LabelSurface> finished)
{
  std::vector<LabelSurface>& surfaces = this->Work.Surfaces;
  std::fill(this->IsDue.begin() + static_cast<std::ptrdiff_t>(surfaces.size()), this->IsDue.end(),
    std::uint8_t(0));
  // With a gap those that are drawn apart later count as well.
  if (finished.size() == surfaces.size() && !this->Maker.KeepsApart())
  {
    surfaces = std::move(finished);
    std::transform(surfaces.begin(), surfaces.end(), this->IsDue.begin(),
      [](const LabelSurface& surface) { return surface.IsFinished ? 0 : 1; });
  }
  const double afterwards = this->Maker.KeepsApart() ? 0.3 * this->Whole : 0.0;
  this->Whole -= afterwards;
  this->MakeDue("");
  for (int round = 0; this->Maker.KeepsApart() && !this->Work.State.IsStopped; ++round)
  {
    this->Before += this->Whole;
    this->Whole = round == 0 ? 0.5 * afterwards : 0.5 * this->Whole;
    const auto touching = this->Maker.FindTouchingVoxels(surfaces, this->Threads);
    std::transform(touching.begin(), touching.end(), this->IsDue.begin(),
      [](const auto& voxels) { return std::uint8_t(voxels.empty() ? 0 : 1); });
    if (round == MostRoundsApart ||
      std::find(this->IsDue.begin(), this->IsDue.end(), 1) == this->IsDue.end())
    {
      break;
    }
    std::vector<std::uint8_t> areFiner;
    for (const LabelSurface& surface : surfaces)
    {
      areFiner.push_back(surface.IsFiner ? 1 : 0);
    }
    this->Maker.Lower(touching, areFiner);
    LabelHelper::Lower(this->All, touching, areFiner);
    this->MakeDue("apart: ");
  }
}
}

std::vector<LabelSurface> MakeLabelSurfaces(Ranks& ranks, LabelSurfaceMaker& maker,
  const LabelBricks& bricks, vtkImageData* frame, const std::vector<std::string>& names,
  int numberOfThreads, HostThreads& threads, const LabelSurfaceMaker::Progress& progress,
  std::vector<LabelSurface> finished)
{
  LabelHelper::Begin(ranks, bricks.Map(), frame, names);
  Making making(ranks, maker, bricks, names, numberOfThreads, threads, progress);
  if (maker.HasClaims())
  {
    making.AddClaims();
  }
  making.MakeSurfaces(std::move(finished));
  return making.Take();
}
}
