// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/Ranks.h"

#include "Core/Common/Refuse.h"
#include "Core/Image/VoxelBox.h"
#include "Host/Pipeline.h"
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
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <array>
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

/** The images that an input means: its blocks, or one. Some, or all, may be null or empty. */
vtkSmartPointer<vtkMultiBlockDataSet> ImagesIn(vtkDataObject* input)
{
  vtkSmartPointer<vtkMultiBlockDataSet> images = vtkMultiBlockDataSet::SafeDownCast(input);
  bool areImages = images && images->GetNumberOfBlocks() > 1;
  for (unsigned int b = 0; areImages && b < images->GetNumberOfBlocks(); ++b)
  {
    areImages = !images->GetBlock(b) || vtkImageData::SafeDownCast(images->GetBlock(b));
  }
  if (areImages)
  {
    return images;
  }
  images = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  const bool isEmpty = !input ||
    (vtkCompositeDataSet::SafeDownCast(input) &&
      input->GetNumberOfElements(vtkDataObject::POINT) == 0);
  images->SetBlock(0, isEmpty ? nullptr : ImageOf(input));
  return images;
}

/** The same without voxels. */
vtkSmartPointer<vtkMultiBlockDataSet> FramesOf(vtkMultiBlockDataSet* images)
{
  const auto frames = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  for (unsigned int b = 0; b < images->GetNumberOfBlocks(); ++b)
  {
    vtkNew<vtkImageData> frame;
    if (auto* image = vtkImageData::SafeDownCast(images->GetBlock(b)))
    {
      frame->CopyStructure(image);
    }
    frames->SetBlock(b, frame);
  }
  return frames;
}

/** One image, by rank; null where there is nothing of it. */
using Images = std::vector<vtkSmartPointer<vtkImageData>>;

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
vtkSmartPointer<vtkImageData> TakeImage(
  Ranks& ranks, const Images& pieces, int port, unsigned int block)
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

/** Some slices of an image. The last ones let go of it, where the data of its port are released. */
RankMessage GivePart(RankMessage& message, const FilterCall& call)
{
  int port = 0;
  unsigned int block = 0;
  int first = 0;
  message >> port >> block >> first;
  vtkDataObject* input = vtkDataObject::GetData(call.Inputs[port]);
  const vtkSmartPointer<vtkMultiBlockDataSet> images = ImagesIn(input);
  auto* image = vtkImageData::SafeDownCast(images->GetBlock(block));
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
  const bool isAll = extent[5] == last && block + 1 == images->GetNumberOfBlocks();
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
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* asked = AskedOutput(this->Call.Request, this->Call.Outputs);
  // A process that makes nothing of an image's voxels must not hold them. Data in pieces keeps the
  // piece that the process would get, which is small and its own.
  const bool wantsNone =
    !this->AreMany() && !IsFirstProcess(this->Call.Request, this->Call.Outputs);
  for (int port = 0; port < this->Call.Filter->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < this->Call.Inputs[port]->GetNumberOfInformationObjects(); ++i)
    {
      vtkInformation* info = this->Call.Inputs[port]->GetInformationObject(i);
      std::array<int, 6> extent = { 0, -1, 0, -1, 0, -1 };
      if (info->Has(Pipeline::WHOLE_EXTENT()))
      {
        wantsNone ? void() : info->Get(Pipeline::WHOLE_EXTENT(), extent.data());
        info->Set(Pipeline::UPDATE_EXTENT(), extent.data(), 6);
      }
      else if (wantsNone)
      {
        continue;
      }
      if (this->AreMany())
      {
        info->CopyEntry(asked, Pipeline::UPDATE_PIECE_NUMBER());
        info->CopyEntry(asked, Pipeline::UPDATE_NUMBER_OF_PIECES());
      }
      else
      {
        // All, as levels and surfaces depend on the whole image; and a part of nothing is nonsense
        // where a source can produce sub-extents.
        info->Set(Pipeline::UPDATE_PIECE_NUMBER(), 0);
        info->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), 1);
      }
      info->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
    }
  }
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
  std::vector<vtkSmartPointer<vtkMultiBlockDataSet>> all(1);
  vtkIdType voxelsOfOthers = 0;
  for (RankMessage& answer : this->AskAll(RankQuestion::Frames, wanted))
  {
    all.emplace_back(vtkMultiBlockDataSet::SafeDownCast(answer.TakeData()));
    voxelsOfOthers += all.back()->GetNumberOfPoints();
  }
  if (voxelsOfOthers == 0)
  {
    return input;
  }
  all[0] = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  all[0]->ShallowCopy(ImagesIn(input));
  unsigned int count = 0;
  for (vtkMultiBlockDataSet* of : all)
  {
    count = std::max(count, of->GetNumberOfBlocks());
  }
  const auto whole = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  for (unsigned int block = 0; block < count; ++block)
  {
    Images pieces;
    for (vtkMultiBlockDataSet* of : all)
    {
      auto* image = vtkImageData::SafeDownCast(of->GetBlock(block));
      pieces.emplace_back(image && image->GetNumberOfPoints() > 0 ? image : nullptr);
    }
    whole->SetBlock(block, TakeImage(*this, pieces, port, block));
    all[0]->SetBlock(block, nullptr);
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
  std::vector<vtkSmartPointer<vtkPolyData>> pieces = { OwnPartOf(own) };
  for (RankMessage& answer : this->AskAll(RankQuestion::Points, wanted))
  {
    pieces.emplace_back(vtkPolyData::SafeDownCast(answer.TakeData()));
  }
  const bool isGiven =
    std::any_of(pieces.begin(), pieces.end(), [](vtkPolyData* piece) { return piece != nullptr; });
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
  vtkDataObject* input = vtkDataObject::GetData(this->Call.Inputs[port]);
  RankMessage answer;
  if (question == RankQuestion::Frames)
  {
    answer.Put(FramesOf(ImagesIn(input)));
  }
  else
  {
    answer.Put(OwnPartOf(vtkPolyData::SafeDownCast(input)));
  }
  return answer;
}
}
