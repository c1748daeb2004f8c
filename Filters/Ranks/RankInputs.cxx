// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/RankInputs.h"

#include "Core/Common/Refuse.h"
#include "Core/Image/VoxelBox.h"
#include "Host/WholeInput.h"
#include "Input/ImageVoxels.h"
#include "Input/InputImage.h"
#include "Input/SlabImage.h"
#include "Ranks/JoinSurfaces.h"

#include <vtkCompositeDataSet.h>
#include <vtkDataObject.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <vector>

namespace volumic
{
namespace
{
/** Bytes that go at once. */
constexpr double PartBytes = 16 << 20;

/** The images that an input means: its blocks, or one; null where there is nothing. */
using Images = std::vector<vtkSmartPointer<vtkImageData>>;

bool HasVoxels(vtkImageData* image)
{
  return image && image->GetNumberOfPoints() > 0;
}

Images ImagesIn(vtkDataObject* input)
{
  if (!input)
  {
    return { nullptr };
  }
  if (auto* image = vtkImageData::SafeDownCast(input))
  {
    return { HasVoxels(image) ? image : nullptr };
  }
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(input);
  Images images;
  for (unsigned int h = 0; blocks && h < blocks->GetNumberOfBlocks(); ++h)
  {
    auto* image = vtkImageData::SafeDownCast(blocks->GetBlock(h));
    if (blocks->GetBlock(h) && !image)
    {
      return { ImageOf(input) };
    }
    images.emplace_back(HasVoxels(image) ? image : nullptr);
  }
  const auto* composite = vtkCompositeDataSet::SafeDownCast(input);
  if (images.size() > 1 || (composite && input->GetNumberOfElements(vtkDataObject::POINT) == 0))
  {
    return images.empty() ? Images{ nullptr } : images;
  }
  return { ImageOf(input) };
}

VoxelBox BoxOf(const Place& place)
{
  VoxelBox box;
  for (int axis = 0; axis < 3; ++axis)
  {
    box.First[axis] = place.Extent[2 * axis];
    box.End[axis] = place.Extent[2 * axis + 1] + 1;
  }
  return box.IsEmpty() ? VoxelBox() : box;
}

template <std::size_t N>
bool AreClose(const std::array<double, N>& a, const std::array<double, N>& b, double tolerance)
{
  return std::equal(a.begin(), a.end(), b.begin(),
    [tolerance](double x, double y) { return std::abs(x - y) <= tolerance; });
}

void CheckSamePlace(const Place& first, const Place& other, int rank)
{
  double size = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int last = std::max(std::abs(first.Extent[2 * axis + 1]), 1);
    size = std::max(size, std::abs(first.Spacing[axis]) * last);
  }
  constexpr double share = 1e-6;
  if (!AreClose(first.Spacing, other.Spacing, share * size) ||
    !AreClose(first.Origin, other.Origin, share * size) ||
    !AreClose(first.Direction, other.Direction, share))
  {
    Refuse("the pieces of the image that the processes hold are not of one image: origin, spacing "
           "or direction differ at process ",
      rank, ".");
  }
}

/** What all ranks have of one image, of which nobody may lack a voxel. */
VoxelBox CheckPlaces(const std::vector<Place>& places)
{
  const Place* first = nullptr;
  VoxelBox whole;
  for (std::size_t rank = 0; rank < places.size(); ++rank)
  {
    const VoxelBox box = BoxOf(places[rank]);
    first = first || box.IsEmpty() ? first : &places[rank];
    if (!box.IsEmpty())
    {
      CheckSamePlace(*first, places[rank], static_cast<int>(rank));
      whole = whole.With(box);
    }
  }
  std::vector<VoxelBox> missing = { whole };
  for (const Place& place : places)
  {
    missing = Without(missing, BoxOf(place));
  }
  if (!missing.empty() && !whole.IsEmpty())
  {
    Refuse("the processes hold only a part of the voxels of the image, ", whole.Length(0), " x ",
      whole.Length(1), " x ", whole.Length(2), ": some are in the piece of none.");
  }
  return whole;
}

/** The whole of one image. @param places of all ranks */
vtkSmartPointer<vtkImageData> TakeImage(
  Ranks& ranks, vtkImageData* own, const std::vector<Place>& places, int port, int block)
{
  const VoxelBox box = CheckPlaces(places);
  if (box.IsEmpty() || BoxOf(places[0]) == box)
  {
    return own;
  }
  SlabImage whole(
    { box.First[0], box.End[0] - 1, box.First[1], box.End[1] - 1, box.First[2], box.End[2] - 1 },
    true);
  // Of what several have the first one's stays.
  for (int rank = ranks.Count() - 1; rank > 0; --rank)
  {
    const std::array<int, 6>& extent = places[static_cast<std::size_t>(rank)].Extent;
    for (int first = extent[4]; first <= extent[5];)
    {
      RankMessage wanted;
      wanted.Words << port << block << first;
      RankMessage part = ranks.Ask(rank, RankQuestion::Part, wanted);
      const vtkSmartPointer<vtkImageData> slab = vtkImageData::SafeDownCast(part.TakeData());
      whole.Take(slab);
      first = slab->GetExtent()[5] + 1;
    }
  }
  if (own)
  {
    whole.Take(own);
  }
  return whole.Image();
}

RankMessage GivePlaces(const Images& images)
{
  RankMessage message;
  message.Words << static_cast<int>(images.size());
  for (vtkImageData* image : images)
  {
    PutPlace(message, PlaceOf(image));
  }
  return message;
}

std::vector<Place> TakePlaces(RankMessage& message)
{
  int count = 0;
  message.Words >> count;
  std::vector<Place> places;
  std::generate_n(std::back_inserter(places), count, [&] { return TakePlace(message); });
  return places;
}

/** Some slices of an image. The last ones let go of it, where the data of its port are released. */
RankMessage GivePart(RankMessage& message, const FilterCall& call)
{
  int port = 0;
  int block = 0;
  int first = 0;
  message.Words >> port >> block >> first;
  vtkDataObject* input = vtkDataObject::GetData(call.Inputs[port]);
  const Images images = ImagesIn(input);
  vtkImageData* image = images[static_cast<std::size_t>(block)];
  const double bytes =
    static_cast<double>(image->GetActualMemorySize()) * 1024.0 / image->GetDimensions()[2];
  // Two at least, as cells lie between two.
  const int slices = static_cast<int>(std::clamp(PartBytes / std::max(bytes, 1.0), 2.0, 1e6));
  int extent[6];
  image->GetExtent(extent);
  const bool isFirst = first == extent[4];
  const int last = extent[5];
  extent[4] = isFirst ? first : first - 1;
  extent[5] = std::min(first + slices - 1, last);
  const auto part = vtkSmartPointer<vtkImageData>::New();
  part->ShallowCopy(image);
  part->Crop(extent);
  const bool isAll = extent[5] == last && static_cast<std::size_t>(block) + 1 == images.size();
  if (isAll && AreReleased(call.Filter, port))
  {
    input->ReleaseData();
  }
  RankMessage answer;
  answer.Put(part);
  return answer;
}
}

bool AskForInputs(vtkMultiProcessController* controller, const FilterCall& call)
{
  const bool areMany = Ranks(controller, call.Request, call.Outputs).AreMany();
  const int ports = call.Filter->GetNumberOfInputPorts();
  areMany ? AskForPieces(call.Request, call.Inputs, ports, call.Outputs)
          : AskForWholeInputs(call.Request, call.Inputs, ports, call.Outputs);
  return areMany;
}

vtkSmartPointer<vtkDataObject> TakeImages(Ranks& ranks, const FilterCall& call, int port)
{
  vtkDataObject* input = vtkDataObject::GetData(call.Inputs[port]);
  if (!ranks.AreMany())
  {
    return input;
  }
  RankMessage wanted;
  wanted.Words << port;
  std::vector<RankMessage> answers = ranks.AskAll(RankQuestion::Places, wanted);
  std::vector<std::vector<Place>> others;
  std::size_t count = 1;
  bool hasOthers = false;
  for (std::size_t rank = 1; rank < answers.size(); ++rank)
  {
    others.push_back(TakePlaces(answers[rank]));
    count = std::max(count, others.back().size());
    hasOthers = hasOthers ||
      std::any_of(others.back().begin(), others.back().end(),
        [](const Place& place) { return !BoxOf(place).IsEmpty(); });
  }
  if (!hasOthers)
  {
    return input;
  }
  Images own = ImagesIn(input);
  count = std::max(count, own.size());
  own.resize(count);
  const auto whole = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  for (std::size_t block = 0; block < count; ++block)
  {
    std::vector<Place> places = { PlaceOf(own[block]) };
    for (const std::vector<Place>& of : others)
    {
      places.push_back(block < of.size() ? of[block] : Place());
    }
    whole->SetBlock(static_cast<unsigned int>(block),
      TakeImage(ranks, own[block], places, port, static_cast<int>(block)));
    own[block] = nullptr;
  }
  if (count == 1)
  {
    return whole->GetBlock(0);
  }
  whole->SetFieldData(input->GetFieldData());
  return whole;
}

vtkSmartPointer<vtkPolyData> TakePoints(Ranks& ranks, const FilterCall& call, int port)
{
  auto* own = vtkPolyData::GetData(call.Inputs[port]);
  if (!ranks.AreMany())
  {
    return own;
  }
  RankMessage wanted;
  wanted.Words << port;
  std::vector<RankMessage> answers = ranks.AskAll(RankQuestion::Points, wanted);
  std::vector<vtkSmartPointer<vtkPolyData>> pieces = { own };
  bool isGiven = own != nullptr;
  for (auto answer = answers.begin() + 1; answer != answers.end(); ++answer)
  {
    bool isThere = false;
    answer->Words >> isThere;
    isGiven = isGiven || isThere;
    pieces.emplace_back(vtkPolyData::SafeDownCast(answer->TakeData()));
  }
  return isGiven ? JoinSurfaces(pieces) : nullptr;
}

RankMessage AnswerForInputs(RankQuestion question, RankMessage& message, const FilterCall& call)
{
  if (question == RankQuestion::Part)
  {
    return GivePart(message, call);
  }
  RankMessage answer;
  int port = 0;
  message.Words >> port;
  if (question == RankQuestion::Places)
  {
    return GivePlaces(ImagesIn(vtkDataObject::GetData(call.Inputs[port])));
  }
  auto* points = vtkPolyData::GetData(call.Inputs[port]);
  answer.Words << (points != nullptr);
  answer.Put(points && points->GetNumberOfPoints() > 0 ? OwnPartOf(points).Get() : nullptr);
  return answer;
}
}
