// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Labels/LabelHelper.h"

#include "Core/Image/VoxelBox.h"

#include <vtkNew.h>
#include <vtkPolyData.h>

#include <chrono>
#include <utility>

namespace volumic
{
LabelHelper::LabelHelper(const LabelSettings& settings, int numberOfThreads, Ranks::Show show)
  : Settings(settings), NumberOfThreads(numberOfThreads), Show(std::move(show))
{
}

LabelHelper::~LabelHelper()
{
  if (this->Work)
  {
    this->Work->State.IsStopped = true;
  }
}

// ---- The first rank asks ------------------------------------------------------------------------

void LabelHelper::Begin(
  Ranks& ranks, const LabelMap& map, vtkImageData* frame, const std::vector<std::string>& names)
{
  if (!ranks.AreMany())
  {
    return;
  }
  vtkNew<vtkImageData> place;
  place->CopyStructure(frame);
  RankMessage message;
  message << Step::Begin << map.NumberOfObjects << map.Size() << map.Spacing << names;
  message.Put(place);
  ranks.AskAll(RankQuestion::Own, message);
  std::vector<LabelMap::Number> voxels;
  for (int layer = 0; layer < map.NumberOfLayers(); ++layer)
  {
    voxels.resize(static_cast<std::size_t>(map.Layer(layer).Count()));
    map.CopyLayer(layer, voxels.data());
    RankMessage part;
    part << Step::TakeLayer;
    part.Pass(voxels.data(), voxels.size() * sizeof(LabelMap::Number));
    ranks.AskAll(RankQuestion::Own, part);
  }
}

void LabelHelper::Do(Ranks& ranks, LabelWork::Kind kind, const std::vector<std::uint8_t>& isDue,
  const std::vector<std::vector<std::size_t>>& own)
{
  for (int rank = 1; rank < ranks.Count(); ++rank)
  {
    RankMessage message;
    message << Step::Do << kind << isDue << own[static_cast<std::size_t>(rank)];
    ranks.Ask(rank, RankQuestion::Own, message);
  }
}

auto LabelHelper::Tell(Ranks& ranks, double share, const std::string& text, bool isStopped) -> Told
{
  RankMessage message;
  message << Step::Tell << share << text << isStopped;
  Told told;
  for (RankMessage& answer : ranks.AskAll(RankQuestion::OwnProgress, message))
  {
    Told of;
    answer >> of;
    told.Done.Add(of.Done);
    told.Stop = told.Stop || of.Stop;
    told.AreThrough = told.AreThrough && of.AreThrough;
  }
  return told;
}

LabelSurface LabelHelper::Take(Ranks& ranks, int rank, std::size_t item)
{
  RankMessage message;
  message << Step::Give << item;
  RankMessage answer = ranks.Ask(rank, RankQuestion::Own, message);
  LabelSurface made;
  answer >> made.WrongVoxels >> made.MissedVoxels >> made.VolumeError >> made.IsFiner >>
    made.IsFinished >> made.Seconds;
  made.Surface = vtkPolyData::SafeDownCast(answer.TakeData());
  return made;
}

void LabelHelper::Lower(Ranks& ranks, const LabelSurfaceMaker::VoxelsOfObjects& voxels,
  const std::vector<std::uint8_t>& areFiner)
{
  RankMessage message;
  message << Step::Lower << voxels << areFiner;
  ranks.AskAll(RankQuestion::Own, message);
}

// ---- The others answer --------------------------------------------------------------------------

RankMessage LabelHelper::Answer(RankMessage& message)
{
  Step step = Step::Begin;
  message >> step;
  switch (step)
  {
    case Step::Begin:
      this->TakeMap(message);
      break;
    case Step::TakeLayer:
      this->TakeLayer(message);
      break;
    case Step::Do:
      this->StartWork(message);
      break;
    case Step::Tell:
      return this->TellOfWork(message);
    case Step::Give:
      return this->Give(message);
    case Step::Lower:
    {
      LabelSurfaceMaker::VoxelsOfObjects voxels;
      std::vector<std::uint8_t> areFiner;
      message >> voxels >> areFiner;
      this->Maker->Lower(voxels, areFiner);
    }
  }
  return {};
}

void LabelHelper::TakeMap(RankMessage& message)
{
  int numberOfObjects = 0;
  std::array<int, 3> size;
  message >> numberOfObjects >> size;
  this->Map = LabelMap(size);
  this->Map.NumberOfObjects = numberOfObjects;
  message >> this->Map.Spacing >> this->Names;
  this->Frame = vtkImageData::SafeDownCast(message.TakeData());
}

void LabelHelper::TakeLayer(RankMessage& message)
{
  std::vector<LabelMap::Number> voxels(
    static_cast<std::size_t>(this->Map.Layer(this->Taken).Count()));
  message.Pass(voxels.data(), voxels.size() * sizeof(LabelMap::Number));
  this->Map.PutLayer(this->Taken, voxels.data());
  ++this->Taken;
  if (this->Taken == this->Map.NumberOfLayers())
  {
    HostThreads threads(this->NumberOfThreads);
    threads.Run([&] { this->Bricks.emplace(this->Map, threads); });
    this->Maker.emplace(*this->Bricks, this->Frame, this->Settings);
    this->Work.emplace(*this->Maker, *this->Bricks, this->Names, this->NumberOfThreads);
  }
}

void LabelHelper::StartWork(RankMessage& message)
{
  LabelWork::Kind kind{};
  std::vector<std::uint8_t> isDue;
  std::vector<std::size_t> own;
  message >> kind >> isDue >> own;
  this->Work->State.Expect("", isDue, own); // Now: the first one may ask how far it is at once.
  this->Done =
    std::async(std::launch::async, [this, kind, own] { this->Work->Do(kind, own, false, [] {}); });
}

RankMessage LabelHelper::TellOfWork(RankMessage& message)
{
  double share = 0.0;
  std::string text;
  bool isStopped = false;
  message >> share >> text >> isStopped;
  LabelCourse& state = this->Work->State;
  state.IsStopped = state.IsStopped || isStopped;
  const bool isThrough = !this->Done.valid() ||
    this->Done.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  if (isThrough && this->Done.valid())
  {
    this->Done.get(); // It may have failed.
  }
  const bool stops = !this->Show(share, text);
  RankMessage answer;
  answer << Told{ state.Here(), stops, isThrough };
  return answer;
}

RankMessage LabelHelper::Give(RankMessage& message)
{
  std::size_t item = 0;
  message >> item;
  const LabelSurface made = std::exchange(this->Work->Surfaces[item], {});
  RankMessage answer;
  answer << made.WrongVoxels << made.MissedVoxels << made.VolumeError << made.IsFiner
         << made.IsFinished << made.Seconds;
  answer.Put(made.Surface);
  return answer;
}
}
