// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/Ranks.h"

#include "Core/Common/Refuse.h"
#include "Core/Image/VoxelBox.h"
#include "Host/WholeInput.h"
#include "Input/ImageVoxels.h"
#include "Input/InputImage.h"
#include "Input/SlabImage.h"
#include "Ranks/Pieces.h"

#include <vtkCompositeDataSet.h>
#include <vtkDataObject.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMatrix4x4.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
/** Bytes that go at once. */
constexpr double PartBytes = 16 << 20;

/** The images that an input means: its blocks, or one; null where there are no voxels. */
using Images = std::vector<vtkSmartPointer<vtkImageData>>;

Images ImagesIn(vtkDataObject* input)
{
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(input);
  bool areImages = blocks && blocks->GetNumberOfBlocks() > 1;
  Images images;
  for (unsigned int b = 0; areImages && b < blocks->GetNumberOfBlocks(); ++b)
  {
    auto* image = vtkImageData::SafeDownCast(blocks->GetBlock(b));
    areImages = image || !blocks->GetBlock(b);
    images.emplace_back(image && image->GetNumberOfPoints() > 0 ? image : nullptr);
  }
  if (areImages)
  {
    return images;
  }
  const bool mayBeEmpty =
    vtkImageData::SafeDownCast(input) || vtkCompositeDataSet::SafeDownCast(input);
  const bool isEmpty =
    !input || (mayBeEmpty && input->GetNumberOfElements(vtkDataObject::POINT) == 0);
  return { isEmpty ? nullptr : ImageOf(input) };
}

VoxelBox BoxOf(vtkImageData* image)
{
  VoxelBox box;
  for (int axis = 0; image && axis < 3; ++axis)
  {
    box.First[axis] = image->GetExtent()[2 * axis];
    box.End[axis] = image->GetExtent()[2 * axis + 1] + 1;
  }
  return box;
}

void CheckSamePlace(vtkImageData* first, vtkImageData* other, std::size_t rank)
{
  const double tolerance = 1e-6 * first->GetLength();
  const double* here = first->GetIndexToPhysicalMatrix()->GetData();
  const double* there = other->GetIndexToPhysicalMatrix()->GetData();
  if (!std::equal(here, here + 16, there,
        [tolerance](double a, double b) { return std::abs(a - b) <= tolerance; }))
  {
    Refuse("the pieces of the image that the processes hold are not of one image: origin, spacing "
           "or direction differ at process ",
      rank, ".");
  }
}

/** What all ranks have of one image, of which nobody may lack a voxel. */
VoxelBox CheckPieces(const Images& pieces)
{
  vtkImageData* first = nullptr;
  VoxelBox whole;
  for (std::size_t rank = 0; rank < pieces.size(); ++rank)
  {
    first = first ? first : pieces[rank].Get();
    if (pieces[rank])
    {
      CheckSamePlace(first, pieces[rank], rank);
      whole = whole.With(BoxOf(pieces[rank]));
    }
  }
  std::vector<VoxelBox> missing = { whole };
  for (vtkImageData* piece : pieces)
  {
    missing = Without(missing, BoxOf(piece));
  }
  if (!missing.empty() && !whole.IsEmpty())
  {
    Refuse("the processes hold only a part of the voxels of the image, ", whole.Length(0), " x ",
      whole.Length(1), " x ", whole.Length(2), ": some are in the piece of none.");
  }
  return whole;
}

/** The whole of one image. @param pieces by rank; of the others without voxels */
vtkSmartPointer<vtkImageData> TakeImage(Ranks& ranks, const Images& pieces, int port, int block)
{
  const VoxelBox box = CheckPieces(pieces);
  if (box.IsEmpty() || BoxOf(pieces[0]) == box)
  {
    return pieces[0];
  }
  SlabImage whole(
    { box.First[0], box.End[0] - 1, box.First[1], box.End[1] - 1, box.First[2], box.End[2] - 1 },
    true);
  // Of what several have the first one's stays.
  for (int rank = ranks.Count() - 1; rank > 0; --rank)
  {
    const VoxelBox piece = BoxOf(pieces[static_cast<std::size_t>(rank)]);
    for (int first = piece.First[2]; first < piece.End[2];)
    {
      RankMessage wanted;
      wanted << port << block << first;
      RankMessage part = ranks.Ask(rank, RankQuestion::Part, wanted);
      const vtkSmartPointer<vtkImageData> slab = vtkImageData::SafeDownCast(part.TakeData());
      whole.Take(slab);
      first = slab->GetExtent()[5] + 1;
    }
  }
  if (pieces[0])
  {
    whole.Take(pieces[0]);
  }
  return whole.Image();
}

/** Where the images are, without voxels. */
RankMessage GiveFrames(const Images& images)
{
  RankMessage message;
  message << images.size();
  for (vtkImageData* image : images)
  {
    vtkNew<vtkImageData> frame;
    if (image)
    {
      frame->CopyStructure(image);
    }
    message.Put(image ? frame.Get() : nullptr);
  }
  return message;
}

Images TakeFrames(RankMessage& message)
{
  std::size_t count = 0;
  message >> count;
  Images frames;
  while (frames.size() < count)
  {
    frames.emplace_back(vtkImageData::SafeDownCast(message.TakeData()));
  }
  return frames;
}

/** Some slices of an image. The last ones let go of it, where the data of its port are released. */
RankMessage GivePart(RankMessage& message, const FilterCall& call)
{
  int port = 0;
  int block = 0;
  int first = 0;
  message >> port >> block >> first;
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

void Ranks::AskForInputs() const
{
  const int ports = this->Call.Filter->GetNumberOfInputPorts();
  (this->AreMany() ? AskForPieces : AskForWholeInputs)(
    this->Call.Request, this->Call.Inputs, ports, this->Call.Outputs);
}

vtkSmartPointer<vtkDataObject> Ranks::TakeImages(int port)
{
  vtkDataObject* input = vtkDataObject::GetData(this->Call.Inputs[port]);
  if (!this->AreMany())
  {
    return input;
  }
  RankMessage wanted;
  wanted << port;
  std::vector<RankMessage> answers = this->AskAll(RankQuestion::Frames, wanted);
  std::vector<Images> all(answers.size());
  std::size_t count = 1;
  bool hasOthers = false;
  for (std::size_t rank = 1; rank < answers.size(); ++rank)
  {
    all[rank] = TakeFrames(answers[rank]);
    count = std::max(count, all[rank].size());
    hasOthers = hasOthers ||
      std::any_of(all[rank].begin(), all[rank].end(),
        [](vtkImageData* image) { return image != nullptr; });
  }
  if (!hasOthers)
  {
    return input;
  }
  all[0] = ImagesIn(input);
  count = std::max(count, all[0].size());
  const auto whole = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  for (std::size_t block = 0; block < count; ++block)
  {
    Images pieces;
    for (Images& of : all)
    {
      of.resize(count);
      pieces.push_back(std::exchange(of[block], nullptr));
    }
    whole->SetBlock(static_cast<unsigned int>(block),
      TakeImage(*this, pieces, port, static_cast<int>(block)));
  }
  if (count == 1)
  {
    return whole->GetBlock(0);
  }
  whole->SetFieldData(input->GetFieldData());
  return whole;
}

vtkSmartPointer<vtkPolyData> Ranks::TakePoints(int port)
{
  auto* own = vtkPolyData::GetData(this->Call.Inputs[port]);
  if (!this->AreMany())
  {
    return own;
  }
  RankMessage wanted;
  wanted << port;
  std::vector<vtkSmartPointer<vtkPolyData>> pieces;
  for (RankMessage& answer : this->AskAll(RankQuestion::Points, wanted))
  {
    pieces.emplace_back(pieces.empty() ? OwnPartOf(own).Get()
                                       : vtkPolyData::SafeDownCast(answer.TakeData()));
  }
  const bool isGiven = std::any_of(
    pieces.begin(), pieces.end(), [](vtkPolyData* piece) { return piece != nullptr; });
  return isGiven ? JoinSurfaces(pieces) : nullptr;
}

RankMessage Ranks::GiveInput(RankQuestion question, RankMessage& message) const
{
  if (question == RankQuestion::Part)
  {
    return GivePart(message, this->Call);
  }
  int port = 0;
  message >> port;
  vtkInformationVector* input = this->Call.Inputs[port];
  if (question == RankQuestion::Frames)
  {
    return GiveFrames(ImagesIn(vtkDataObject::GetData(input)));
  }
  RankMessage answer;
  answer.Put(OwnPartOf(vtkPolyData::GetData(input)));
  return answer;
}
}
