// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Labels/LabelHelper.h"

#include "Core/Image/VoxelBox.h"

#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkUnsignedShortArray.h>

#include <algorithm>
#include <type_traits>
#include <utility>

namespace volumic
{
namespace
{
static_assert(std::is_same_v<LabelMap::Number, unsigned short>, "sent as such");

template <typename T>
T TakeWord(RankMessage& message)
{
  T word{};
  message.Words >> word;
  return word;
}

std::size_t TakeCount(RankMessage& message)
{
  return static_cast<std::size_t>(TakeWord<vtkTypeInt64>(message));
}

void PutCount(RankMessage& message, std::size_t count)
{
  message.Words << static_cast<vtkTypeInt64>(count);
}
}

LabelHelper::LabelHelper(const LabelSettings& settings, int numberOfThreads, Ranks::Show show)
  : Settings(settings), NumberOfThreads(numberOfThreads), Show(std::move(show))
{
}

LabelHelper::~LabelHelper()
{
  this->Wait();
}

void LabelHelper::Wait()
{
  if (this->Worker.joinable())
  {
    this->Work->State.IsStopped = this->Work->State.IsStopped || !this->IsThrough;
    this->Worker.join();
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
  RankMessage message;
  message.Words << static_cast<int>(Step::Begin) << map.NumberOfObjects;
  for (int axis = 0; axis < 3; ++axis)
  {
    message.Words << map.Size[axis] << map.Spacing[axis];
  }
  PutPlace(message, PlaceOf(frame));
  PutCount(message, names.size());
  for (const std::string& name : names)
  {
    message.Words << name;
  }
  ranks.AskAll(RankQuestion::Own, message);
  const auto slice = static_cast<std::size_t>(VoxelBox::Of(map.Size).NumberOf(0, 0, 1));
  for (std::size_t first = 0; first < map.Voxels.size(); first += slice)
  {
    RankMessage part;
    part.Words << static_cast<int>(Step::TakeSlice);
    vtkNew<vtkUnsignedShortArray> voxels;
    constexpr int isOurs = 1;
    voxels->SetArray(const_cast<LabelMap::Number*>(map.Voxels.data()) + first,
      static_cast<vtkIdType>(slice), isOurs);
    part.Put(voxels);
    ranks.AskAll(RankQuestion::Own, part);
  }
}

void LabelHelper::Do(Ranks& ranks, LabelWork::Kind kind, const std::vector<std::uint8_t>& isDue,
  const std::vector<std::vector<std::size_t>>& own)
{
  for (int rank = 1; rank < ranks.Count(); ++rank)
  {
    RankMessage message;
    message.Words << static_cast<int>(Step::Do) << static_cast<int>(kind);
    PutCount(message, isDue.size());
    for (const std::uint8_t due : isDue)
    {
      message.Words << due;
    }
    const std::vector<std::size_t>& items = own[static_cast<std::size_t>(rank)];
    PutCount(message, items.size());
    for (const std::size_t item : items)
    {
      PutCount(message, item);
    }
    ranks.Ask(rank, RankQuestion::Own, message);
  }
}

auto LabelHelper::Tell(Ranks& ranks, double share, const std::string& text, bool isStopped) -> Told
{
  RankMessage message;
  message.Words << static_cast<int>(Step::Tell) << share << text << isStopped;
  std::vector<RankMessage> answers = ranks.AskAll(RankQuestion::OwnProgress, message);
  Told told;
  for (std::size_t rank = 1; rank < answers.size(); ++rank)
  {
    LabelProgress of;
    vtkTypeInt64 finished = 0;
    vtkTypeInt64 underWay = -1;
    bool stops = false;
    bool isThrough = false;
    answers[rank].Words >> of.Done >> finished >> underWay >> stops >> isThrough;
    of.Finished = finished;
    of.UnderWay = underWay;
    told.Done.Add(of);
    told.Stop = told.Stop || stops;
    told.AreThrough = told.AreThrough && isThrough;
  }
  return told;
}

LabelSurface LabelHelper::Take(Ranks& ranks, int rank, std::size_t item)
{
  RankMessage message;
  message.Words << static_cast<int>(Step::Give);
  PutCount(message, item);
  RankMessage answer = ranks.Ask(rank, RankQuestion::Own, message);
  LabelSurface made;
  vtkTypeInt64 wrong = 0;
  vtkTypeInt64 missed = 0;
  answer.Words >> wrong >> missed >> made.VolumeError >> made.IsFinished >> made.Seconds;
  made.WrongVoxels = wrong;
  made.MissedVoxels = missed;
  made.Surface = vtkPolyData::SafeDownCast(answer.TakeData());
  return made;
}

void LabelHelper::Lower(Ranks& ranks, const std::vector<std::vector<std::array<int, 3>>>& voxels)
{
  RankMessage message;
  message.Words << static_cast<int>(Step::Lower);
  PutCount(message, voxels.size());
  for (const auto& ofObject : voxels)
  {
    PutCount(message, ofObject.size());
    for (const std::array<int, 3>& voxel : ofObject)
    {
      message.Words << voxel[0] << voxel[1] << voxel[2];
    }
  }
  ranks.AskAll(RankQuestion::Own, message);
}

// ---- The others answer --------------------------------------------------------------------------

RankMessage LabelHelper::Answer(RankMessage& message)
{
  switch (static_cast<Step>(TakeWord<int>(message)))
  {
    case Step::Begin:
      this->TakeMap(message);
      break;
    case Step::TakeSlice:
      this->TakeSlice(message);
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
      std::vector<std::vector<std::array<int, 3>>> voxels(TakeCount(message));
      for (auto& ofObject : voxels)
      {
        ofObject.resize(TakeCount(message));
        for (std::array<int, 3>& voxel : ofObject)
        {
          message.Words >> voxel[0] >> voxel[1] >> voxel[2];
        }
      }
      this->Maker->Lower(voxels);
    }
  }
  return {};
}

void LabelHelper::TakeMap(RankMessage& message)
{
  message.Words >> this->Map.NumberOfObjects;
  for (int axis = 0; axis < 3; ++axis)
  {
    message.Words >> this->Map.Size[axis] >> this->Map.Spacing[axis];
  }
  Place place = TakePlace(message);
  this->Frame = vtkSmartPointer<vtkImageData>::New();
  this->Frame->SetExtent(place.Extent.data());
  this->Frame->SetOrigin(place.Origin.data());
  this->Frame->SetSpacing(place.Spacing.data());
  this->Frame->SetDirectionMatrix(place.Direction.data());
  this->Names.resize(TakeCount(message));
  for (std::string& name : this->Names)
  {
    message.Words >> name;
  }
  this->Map.Voxels.resize(static_cast<std::size_t>(VoxelBox::Of(this->Map.Size).Count()));
}

void LabelHelper::TakeSlice(RankMessage& message)
{
  const auto slice = vtkUnsignedShortArray::SafeDownCast(message.TakeArray());
  const auto count = static_cast<std::size_t>(slice->GetNumberOfTuples());
  std::copy_n(slice->GetPointer(0), count, this->Map.Voxels.data() + this->Taken);
  this->Taken += count;
  if (this->Taken == this->Map.Voxels.size())
  {
    HostThreads threads(this->NumberOfThreads);
    threads.Run([&] { this->Bricks.emplace(this->Map, threads); });
    this->Maker.emplace(*this->Bricks, this->Frame, this->Settings);
    this->Work.emplace(*this->Maker, *this->Bricks, this->Names, this->NumberOfThreads);
  }
}

void LabelHelper::StartWork(RankMessage& message)
{
  this->Wait(); // It is through.
  const auto kind = static_cast<LabelWork::Kind>(TakeWord<int>(message));
  std::vector<std::uint8_t> isDue(TakeCount(message));
  for (std::uint8_t& due : isDue)
  {
    message.Words >> due;
  }
  std::vector<std::size_t> own(TakeCount(message));
  std::generate(own.begin(), own.end(), [&] { return TakeCount(message); });
  this->Work->State.Expect("", isDue, own); // Now: the first one may ask how far it is at once.
  this->IsThrough = false;
  this->Worker = std::thread(
    [this, kind, own]
    {
      try
      {
        this->Work->Do(kind, own, false, [] {});
      }
      catch (...)
      {
        this->Failure = std::current_exception();
      }
      this->IsThrough = true;
    });
}

RankMessage LabelHelper::TellOfWork(RankMessage& message)
{
  const auto share = TakeWord<double>(message);
  const auto text = TakeWord<std::string>(message);
  LabelCourse& state = this->Work->State;
  state.IsStopped = state.IsStopped || TakeWord<bool>(message);
  const bool isThrough = this->IsThrough;
  if (isThrough && this->Failure)
  {
    std::rethrow_exception(this->Failure);
  }
  const bool stops = !this->Show(share, text);
  const LabelProgress here = state.Here();
  RankMessage answer;
  answer.Words << here.Done << static_cast<vtkTypeInt64>(here.Finished)
               << static_cast<vtkTypeInt64>(here.UnderWay) << stops << isThrough;
  return answer;
}

RankMessage LabelHelper::Give(RankMessage& message)
{
  const LabelSurface made = std::exchange(this->Work->Surfaces[TakeCount(message)], {});
  RankMessage answer;
  answer.Words << static_cast<vtkTypeInt64>(made.WrongVoxels)
               << static_cast<vtkTypeInt64>(made.MissedVoxels) << made.VolumeError
               << made.IsFinished << made.Seconds;
  answer.Put(made.Surface.Get());
  return answer;
}
}
