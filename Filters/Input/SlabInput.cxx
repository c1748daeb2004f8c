// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/SlabInput.h"

#include "Core/Common/Refuse.h"
#include "Host/Errors.h"
#include "Host/Pipeline.h"
#include "Input/ImageVoxels.h"
#include "Input/InputImage.h"
#include "Input/SlabImage.h"

#include <vtkAlgorithm.h>
#include <vtkAlgorithmOutput.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkExecutive.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <set>

namespace volumic
{
namespace
{
using Pipeline = vtkStreamingDemandDrivenPipeline;
using Extent = std::array<int, 6>;

/** Bytes of a slab, where the limit is not so low that it must be thinner. */
constexpr std::size_t SlabBytes = std::size_t(16) << 20;

/**
 * Whether a source gives a part of its image where it is asked for one. Those that can say so
 * (CAN_PRODUCE_SUB_EXTENT). All readers of pictures do, by inheritance, but vtkDICOMImageReader
 * writes the whole image over the end of a part's memory, vtkTIFFReader gives other slices from its
 * second part on, and vtkNIFTIImageReader where it reverses them.
 */
bool GivesParts(vtkAlgorithm* source, int port)
{
  if (source->IsA("vtkImageReader2"))
  {
    static const std::set<std::string> known = { "vtkImageReader", "vtkImageReader2",
      "vtkJPEGReader", "vtkMRCReader", "vtkNrrdReader", "vtkPNGReader", "vtkPNMReader" };
    return known.count(source->GetClassName()) != 0;
  }
  vtkInformation* info = source->GetOutputInformation(port);
  // Readers of series of files say what the reader within them says, which may be one of the above.
  const bool isWrapper = source->IsA("vtkMetaReader") || source->IsA("vtkFileSeriesReader");
  return !isWrapper && info && info->Get(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT()) != 0;
}

/** Whether all sources that an output comes from do. */
bool AllGiveParts(vtkAlgorithm* producer, int port, std::string* refusing)
{
  if (producer->IsA("vtkTrivialProducer"))
  {
    return false; // Someone holds it as a whole.
  }
  bool isSource = true;
  for (int input = 0; input < producer->GetNumberOfInputPorts(); ++input)
  {
    for (int i = 0; i < producer->GetNumberOfInputConnections(input); ++i)
    {
      vtkAlgorithmOutput* connection = producer->GetInputConnection(input, i);
      if (!AllGiveParts(connection->GetProducer(), connection->GetIndex(), refusing))
      {
        return false;
      }
      isSource = false;
    }
  }
  const bool gives = !isSource || GivesParts(producer, port);
  if (!gives && refusing)
  {
    *refusing = producer->GetClassName();
  }
  return gives;
}

Extent WholeExtentOf(vtkInformation* info)
{
  Extent whole;
  info->Get(Pipeline::WHOLE_EXTENT(), whole.data());
  return whole;
}

/** Bytes of a slice as far as the pipeline knows them before there are voxels. */
double SliceBytes(vtkInformation* info, const Extent& whole)
{
  vtkInformation* scalars = vtkDataObject::GetActiveFieldInformation(
    info, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
  double bytes = sizeof(double);
  if (scalars && scalars->Has(vtkDataObject::FIELD_ARRAY_TYPE()))
  {
    const int components = scalars->Get(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS());
    bytes = std::max(components, 1) *
      std::max(1, vtkDataArray::GetDataTypeSize(scalars->Get(vtkDataObject::FIELD_ARRAY_TYPE())));
  }
  return bytes * (whole[1] - whole[0] + 1.0) * (whole[3] - whole[2] + 1.0);
}

/** The same of a slab that is there, with all of its arrays. */
double SliceBytes(vtkImageData* slab)
{
  return static_cast<double>(slab->GetActualMemorySize()) * 1024.0 / slab->GetDimensions()[2];
}

/** How many slices a slab has: two at least, as cells lie between two. */
int Thickness(double sliceBytes, std::size_t limit)
{
  const auto bytes = static_cast<double>(std::min(SlabBytes, limit / 64));
  return static_cast<int>(std::clamp(bytes / std::max(sliceBytes, 1.0), 2.0, 1e6));
}

void AskFor(vtkInformation* info, int first, int last)
{
  Extent extent = WholeExtentOf(info);
  extent[4] = first;
  extent[5] = last;
  info->Set(Pipeline::UPDATE_EXTENT(), extent.data(), 6);
}

/** The slab with its voxels as the active scalars, of one component. */
PointVoxels Prepare(vtkImageData* slab, const SlabInput::Request& request)
{
  PointVoxels points;
  points.Image = slab;
  points.Selection = request.Selection;
  if (request.TakesCells)
  {
    points = TakeCellsAsPoints(slab, request.Selection);
  }
  const vtkSmartPointer<vtkDataArray> voxels =
    SelectComponent(ChooseArray(points.Selection, points.Image), request.SelectedComponent);
  points.Image = WithVoxels(points.Image, voxels);
  return points;
}

/** The extent of the image that the slabs are prepared for, which are cells where the slab is. */
Extent PreparedExtent(Extent whole, vtkImageData* slab, vtkImageData* prepared)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    whole[2 * axis + 1] += prepared->GetExtent()[2 * axis + 1] - slab->GetExtent()[2 * axis + 1];
  }
  return whole;
}

void CheckExtent(const int* has, const Extent& whole)
{
  if (!std::equal(has, has + 4, whole.begin()) || has[4] < whole[4] || has[5] > whole[5])
  {
    const auto text = [](const int* e)
    { return Join(e[0], " to ", e[1], ", ", e[2], " to ", e[3], ", ", e[4], " to ", e[5]); };
    Refuse("the source of the image gave voxels ", text(has), "; it had told of ",
      text(whole.data()), ".");
  }
}
}

vtkInformation* SlabInput::Info() const
{
  return this->Filter->GetExecutive()->GetInputInformation(0, 0);
}

bool SlabInput::ComesInSlabs(std::string* refusing) const
{
  if (this->Filter->GetNumberOfInputConnections(0) != 1 ||
    !this->Info()->Has(Pipeline::WHOLE_EXTENT()) || !vtkImageData::GetData(this->Info()))
  {
    return false;
  }
  const Extent whole = WholeExtentOf(this->Info());
  vtkAlgorithmOutput* connection = this->Filter->GetInputConnection(0, 0);
  return whole[4] + 1 < whole[5] &&
    AllGiveParts(connection->GetProducer(), connection->GetIndex(), refusing);
}

void SlabInput::Ask(std::size_t limit, bool needsVoxels) const
{
  if (!this->ComesInSlabs())
  {
    return;
  }
  vtkInformation* info = this->Info();
  if (!needsVoxels)
  {
    info->Set(Pipeline::UPDATE_EXTENT(), vtkImageData::GetData(info)->GetExtent(), 6);
    return;
  }
  const Extent whole = WholeExtentOf(info);
  const int slices = Thickness(SliceBytes(info, whole), limit);
  AskFor(info, whole[4], std::min(whole[4] + slices - 1, whole[5]));
}

std::string SlabInput::DescribeWhole() const
{
  std::string refusing;
  auto* image = vtkImageData::GetData(this->Info());
  if (this->ComesInSlabs(&refusing) || refusing.empty() || !image)
  {
    return "";
  }
  return Join("the image is in memory as a whole (",
    static_cast<std::int64_t>(image->GetActualMemorySize()) / 1024,
    " MiB), which counts to Memory "
    "Limit: ",
    refusing, " cannot give it slab by slab.");
}

vtkImageData* SlabInput::Pull(int first, int last) const
{
  vtkAlgorithmOutput* connection = this->Filter->GetInputConnection(0, 0);
  vtkAlgorithm* producer = connection->GetProducer();
  AskFor(this->Info(), first, last);
  bool isDone = false;
  const std::string errors = CollectErrors(producer,
    [&]
    {
      auto* executive = Pipeline::SafeDownCast(producer->GetExecutive());
      isDone = executive && executive->Update(connection->GetIndex());
    });
  auto* slab = vtkImageData::GetData(this->Info());
  if (!isDone || !errors.empty() || !slab)
  {
    Refuse(producer->GetClassName(), " failed", errors.empty() ? "." : ": ", errors);
  }
  return slab;
}

SlabInput::Result SlabInput::Read(const Request& request) const
{
  Result result;
  vtkImageData* slab = vtkImageData::GetData(this->Info());
  if (!slab || !this->Info()->Has(Pipeline::WHOLE_EXTENT()))
  {
    return result;
  }
  const Extent whole = WholeExtentOf(this->Info());
  const bool isThere = std::equal(whole.begin(), whole.end(), slab->GetExtent());
  if (isThere ? !AreReleased(this->Filter, 0) : !this->ComesInSlabs())
  {
    return result;
  }
  const auto sliceCount = static_cast<double>(whole[5] - whole[4] + 1);
  int slices = Thickness(SliceBytes(this->Info(), whole), request.Limit);
  std::unique_ptr<SlabImage> image;
  int first = whole[4];
  int last = isThere ? whole[5] : std::min(first + slices - 1, whole[5]);
  while (true)
  {
    // The first has come, unless that of a former run is there.
    const bool isAtHand = slab->GetExtent()[4] <= first && last <= slab->GetExtent()[5];
    slab = image || !isAtHand ? this->Pull(first, last) : slab;
    const PointVoxels points = PrefixErrors(
      Join("slices ", first, " to ", last, ": "), [&] { return Prepare(slab, request); });
    vtkImageData* prepared = points.Image;
    result.Selection = points.Selection;
    if (!image)
    {
      image = std::make_unique<SlabImage>(PreparedExtent(whole, slab, prepared));
      slices = std::min(slices, Thickness(SliceBytes(slab), request.Limit));
    }
    CheckExtent(prepared->GetExtent(), image->GetExtent());
    image->Take(prepared);
    result.IsStopped = !request.GoOn((last - whole[4] + 1) / sliceCount);
    if (result.IsStopped || last == whole[5])
    {
      break;
    }
    const bool overlap = image->HasCells() || prepared->GetExtent()[5] < slab->GetExtent()[5];
    first = overlap ? last : last + 1;
    last = std::min(first + slices - 1, whole[5]);
  }
  if (isThere)
  {
    slab->ReleaseData();
  }
  result.Image = result.IsStopped ? nullptr : image->Image();
  return result;
}
}
