// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SlabReader.h"

#include "Messages.h"
#include "Texts.h"
#include "WorldSpace.h"

#include <vtkAlgorithm.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkImageAlgorithm.h>
#include <vtkImageReader2.h>
#include <vtkImageReader2Factory.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMatrix3x3.h>
#include <vtkMatrix4x4.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <exception>
#include <limits>
#include <utility>

namespace tool
{
namespace
{
/** As many slices are read at a time where parts of them are wanted. */
constexpr std::size_t BytesAtATime = std::size_t(16) << 20;

/** Copies rows of slices that have been read. @param first the slice that `slab` begins with */
void CopyPart(vtkDataArray* slab, const std::array<int, 3>& size, int first, int count,
  const int* extent, vtkDataArray* part)
{
  const auto voxel = static_cast<std::size_t>(slab->GetDataTypeSize()) *
    static_cast<std::size_t>(slab->GetNumberOfComponents());
  const auto row = static_cast<std::size_t>(extent[1] - extent[0] + 1);
  const auto rows = static_cast<std::size_t>(extent[3] - extent[2] + 1);
  const char* from = static_cast<const char*>(slab->GetVoidPointer(0));
  char* to = static_cast<char*>(part->GetVoidPointer(0));
  for (int z = 0; z < count; ++z)
  {
    for (std::size_t y = 0; y < rows; ++y)
    {
      const std::size_t begin = (static_cast<std::size_t>(z) * static_cast<std::size_t>(size[1]) +
                                  static_cast<std::size_t>(extent[2]) + y) *
          static_cast<std::size_t>(size[0]) +
        static_cast<std::size_t>(extent[0]);
      const std::size_t place = (static_cast<std::size_t>(first + z - extent[4]) * rows + y) * row;
      std::memcpy(to + place * voxel, from + begin * voxel, row * voxel);
    }
  }
}

/** The values of an extent; of slices of which parts are wanted, some are in memory at a time. */
vtkSmartPointer<vtkDataArray> ReadPart(SlabReader& reader, const int* extent)
{
  const std::array<int, 3>& size = reader.Size;
  const int slices = extent[5] - extent[4] + 1;
  if (extent[1] - extent[0] + 1 == size[0] && extent[3] - extent[2] + 1 == size[1])
  {
    return reader.Read(extent[4], slices);
  }
  const std::size_t slice = static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
    static_cast<std::size_t>(reader.Components) * sizeof(double);
  const auto most = static_cast<int>(std::max<std::size_t>(1, BytesAtATime / slice));
  vtkSmartPointer<vtkDataArray> part;
  for (int z = extent[4]; z <= extent[5]; z += most)
  {
    const int count = std::min(most, extent[5] - z + 1);
    const vtkSmartPointer<vtkDataArray> slab = reader.Read(z, count);
    if (!part)
    {
      part.TakeReference(slab->NewInstance());
      part->SetName(slab->GetName());
      part->SetNumberOfComponents(slab->GetNumberOfComponents());
      part->SetNumberOfTuples(
        static_cast<vtkIdType>(extent[1] - extent[0] + 1) * (extent[3] - extent[2] + 1) * slices);
    }
    CopyPart(slab, size, z, count, extent, part);
  }
  return part;
}

/** Give the image the voxels of an extent, their place and what is known of it. */
void FillImage(SlabReader& reader, const int* extent, vtkImageData* image)
{
  const vtkSmartPointer<vtkDataArray> values = ReadPart(reader, extent);
  image->SetExtent(const_cast<int*>(extent));
  PlaceImage(image, reader.Placement);
  if (!reader.ArrayName.empty() || !values->GetName())
  {
    values->SetName(reader.ArrayName.empty() ? "Intensity" : reader.ArrayName.c_str());
  }
  image->GetPointData()->SetScalars(values);
  if (!reader.WorldAxes.empty())
  {
    SetWorldAxes(image, reader.WorldAxes);
  }
  if (const std::string unit = LengthUnitOf(reader.LengthUnit); !unit.empty())
  {
    SetFact(image, "LengthUnit", unit);
  }
  if (!reader.Resampling.empty())
  {
    SetFact(image, "Resampling", reader.Resampling);
  }
  if (!reader.Names.empty())
  {
    SetLabelNames(image, reader.Names);
  }
}

class SlabSource : public vtkImageAlgorithm
{
public:
  static SlabSource* New();
  vtkTypeMacro(SlabSource, vtkImageAlgorithm);

  std::shared_ptr<SlabReader> Reader;

protected:
  SlabSource() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override
  {
    vtkInformation* info = output->GetInformationObject(0);
    const std::array<int, 3>& size = this->Reader->Size;
    const int whole[6] = { 0, size[0] - 1, 0, size[1] - 1, 0, size[2] - 1 };
    info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), whole, 6);
    info->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
    vtkDataObject::SetPointDataActiveScalarInfo(info, this->Reader->Type, this->Reader->Components);
    const vtkNew<vtkImageData> placed;
    PlaceImage(placed, this->Reader->Placement);
    info->Set(vtkDataObject::SPACING(), placed->GetSpacing(), 3);
    info->Set(vtkDataObject::ORIGIN(), placed->GetOrigin(), 3);
    info->Set(vtkDataObject::DIRECTION(), placed->GetDirectionMatrix()->GetData(), 9);
    return 1;
  }

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override
  {
    vtkInformation* info = output->GetInformationObject(0);
    int extent[6];
    info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), extent);
    try
    {
      FillImage(*this->Reader, extent, vtkImageData::GetData(info));
      return 1;
    }
    catch (const std::exception& error)
    {
      vtkErrorMacro(<< ReasonOf(error,
                      "not enough memory to read it; crop it, or resample it to fewer voxels"));
      return 0;
    }
  }
};

vtkStandardNewMacro(SlabSource);
}

vtkSmartPointer<vtkAlgorithm> NewSlabSource(std::shared_ptr<SlabReader> reader)
{
  auto source = vtkSmartPointer<SlabSource>::New();
  source->Reader = std::move(reader);
  return source;
}

vtkSmartPointer<vtkImageData> ReadAllSlabs(SlabReader& reader)
{
  const std::array<int, 3>& size = reader.Size;
  const int whole[6] = { 0, size[0] - 1, 0, size[1] - 1, 0, size[2] - 1 };
  auto image = vtkSmartPointer<vtkImageData>::New();
  FillImage(reader, whole, image);
  return image;
}

void NeedComponent(int components, const std::string& kind, const Opening& opening)
{
  FailIf(opening.Choice.NeedsComponent,
    "the " + std::to_string(components) + " numbers of each voxel are no vector (" + kind +
      "); choose one with --component N, 0 to " + std::to_string(components - 1) +
      " (-1: their magnitude)");
}

int TimeOf(const VolumeChoice& choice, std::uint64_t times)
{
  if (choice.Times)
  {
    *choice.Times = static_cast<int>(times);
  }
  const auto last = std::to_string(times - 1);
  FailIf(!choice.Time && times > 1,
    std::to_string(times) +
      " volumes, one behind the other (times, phases, or masks); choose one with --time N, 0 to " +
      last);
  const int time = choice.Time.value_or(0);
  FailIf(time < 0 || static_cast<std::uint64_t>(time) >= times,
    "there is no time " + std::to_string(time) + " (--time)" +
      (times > 1 ? ", but 0 to " + last : ", but one volume"));
  return time;
}

std::string SizeText(const std::array<int, 3>& size)
{
  return NumberText(size[0]) + " x " + NumberText(size[1]) + " x " + NumberText(size[2]);
}

// ---- Readers of VTK -----------------------------------------------------------------------------

vtkSmartPointer<vtkImageData> ImageOf(vtkAlgorithm* reader, const std::string& name)
{
  VtkMessages messages;
  messages.UpdateReader(reader, name);
  auto* image = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
  FailIf(!image, name + ": holds no image");
  return image;
}

namespace
{
/** What helps with a file of another suffix than those of its format. */
std::string AdviceByMark(const std::string& name)
{
  struct Mark
  {
    std::size_t Place;
    const char* Text;
    const char* Suffix;
  };
  static const Mark marks[] = { { 344, "n+1", ".nii" }, { 4, "n+2", ".nii" },
    { 208, "MAP ", ".mrc" }, { 0, "NRRD0", ".nrrd" }, { 0, "\x93NUMPY", ".npy" },
    { 0, "ObjectType", ".mha" }, { 0, "NDims", ".mha" }, { 0, "<VTKFile", ".vti" } };
  const std::string head = HeadOf(name, 400); // unpacked
  for (const Mark& mark : marks)
  {
    if (head.size() > mark.Place &&
      head.compare(mark.Place, std::strlen(mark.Text), mark.Text) == 0)
    {
      const bool isPacked = IsGzip(name);
      return std::string("begins like a ") + mark.Suffix + " file" +
        (isPacked && mark.Place == 0
            ? ", packed by gzip: unpack it (gunzip), and let its name end so"
            : std::string(": let its name end in ") + mark.Suffix + (isPacked ? ".gz" : ""));
    }
  }
  return "not a format that is read (see FORMATS in volumic(1)); of voxels without a header give "
         "its sizes and type with --raw; others convert to .nii.gz, .nrrd or .mha, for example by "
         "3D Slicer or ImageJ";
}
}

vtkSmartPointer<vtkImageReader2> ReaderOf(const std::string& name)
{
  vtkSmartPointer<vtkImageReader2> reader;
  VtkMessages ignored; // Some of those that are asked complain of what they don't know.
  ignored.Catch(
    [&] { reader.TakeReference(vtkImageReader2Factory::CreateImageReader2(name.c_str())); });
  FailIf(!reader, name + ": " + AdviceByMark(name));
  reader->SetFileName(name.c_str());
  return reader;
}

VolumePlacement PlacementOf(vtkMatrix4x4* matrix, const double* spacing)
{
  VolumePlacement placement;
  std::array<Vector3, 3> steps;
  for (int row = 0; row < 3; ++row)
  {
    placement.Origin[row] = matrix->GetElement(row, 3);
    for (int axis = 0; axis < 3; ++axis)
    {
      steps[axis][row] = matrix->GetElement(row, axis) * spacing[axis];
    }
  }
  placement.SetSteps(steps);
  return placement;
}

ReaderSlabs::ReaderSlabs(const std::string& name, const Factory& make) : Name(name), Make(make)
{
  const vtkSmartPointer<vtkImageReader2> reader = make();
  VtkMessages().AskReader(reader, name);
  const int* extent = reader->GetDataExtent();
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::int64_t size = std::int64_t(extent[2 * axis + 1]) - extent[2 * axis] + 1;
    FailIf(size < 1 || size > std::numeric_limits<int>::max(),
      name + ": its header is damaged: " + std::to_string(size) + " voxels along axis " +
        std::to_string(axis + 1));
    this->Size[axis] = static_cast<int>(size);
  }
  this->Type = reader->GetDataScalarType();
  this->Components = reader->GetNumberOfScalarComponents();
  std::copy_n(reader->GetDataSpacing(), 3, this->Placement.Spacing.begin());
  std::copy_n(reader->GetDataOrigin(), 3, this->Placement.Origin.begin());
}

void ReaderSlabs::Pick(int time, int times)
{
  this->Picked = time;
  this->Components /= times;
}

vtkSmartPointer<vtkDataArray> ReaderSlabs::Read(int first, int count)
{
  const vtkIdType area = static_cast<vtkIdType>(this->Size[0]) * this->Size[1];
  if (this->Picked >= 0 && count > 1)
  {
    // The numbers of all volumes are in memory, of one slice at a time.
    auto all = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(this->Type));
    all->SetNumberOfComponents(this->Components);
    all->SetNumberOfTuples(area * count);
    for (int i = 0; i < count; ++i)
    {
      const vtkSmartPointer<vtkDataArray> slice = this->Read(first + i, 1);
      all->SetName(slice->GetName());
      all->InsertTuples(area * i, area, 0, slice);
    }
    return all;
  }
  const vtkSmartPointer<vtkImageReader2> reader = this->Make();
  const int begin = this->IsReversed ? this->Size[2] - first - count : first;
  const int extent[6] = { 0, this->Size[0] - 1, 0, this->Size[1] - 1, begin, begin + count - 1 };
  VtkMessages messages;
  messages.UpdateReader(reader, this->Name, this->HasTrustedWarnings, extent);
  vtkSmartPointer<vtkDataArray> values = reader->GetOutput()->GetPointData()->GetScalars();
  FailIf(!values, this->Name + ": holds no voxels");
  if (this->Picked >= 0)
  {
    const auto one = vtkSmartPointer<vtkDataArray>::Take(values->NewInstance());
    one->SetName(values->GetName());
    one->SetNumberOfComponents(this->Components);
    one->SetNumberOfTuples(area);
    for (int c = 0; c < this->Components; ++c)
    {
      one->CopyComponent(c, values, this->Picked * this->Components + c);
    }
    values = one;
  }
  return this->Slope == 1.0 && this->Shift == 0.0 ? values
                                                  : Rescaled(values, this->Slope, this->Shift);
}
}
