// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReadVolume.h"

#include "CheckInputs.h"
#include "Inflate.h"
#include "ParseNumbers.h"
#include "RawSlabs.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "VolumeImage.h"
#include "VtkMessages.h"
#include "VtkReaders.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <utility>

namespace tool
{
namespace
{
/** Slope and shift that the header tells of. @throws Failure for several times. */
std::pair<double, double> RescalingOf(vtkNIFTIImageReader* reader)
{
  if (reader->GetTimeDimension() > 1)
  {
    throw Failure(NumberText(reader->GetTimeDimension()) + " time points; one volume is needed");
  }
  const double slope = reader->GetRescaleSlope() == 0.0 ? 1.0 : reader->GetRescaleSlope();
  return { slope, reader->GetRescaleIntercept() };
}

/** The sform, or the qform where that fails. @return whether there is one. */
bool Place(vtkNIFTIImageReader* reader, const double* spacing, VolumePlacement& placement)
{
  std::string failure;
  for (vtkMatrix4x4* matrix : { reader->GetSFormMatrix(), reader->GetQFormMatrix() })
  {
    if (!matrix)
    {
      continue;
    }
    try
    {
      placement = PlacementOf(matrix, spacing);
      PlaceImage(vtkNew<vtkImageData>(), placement);
      return true;
    }
    catch (const Failure& error)
    {
      failure = failure.empty() ? error.what() : failure;
    }
  }
  if (!failure.empty())
  {
    throw Failure(failure);
  }
  return false;
}

/** @return the bytes of the file that holds the voxels, unpacked. */
std::uint64_t Check(const std::string& name)
{
  if (!vtkNew<vtkNIFTIImageReader>()->CanReadFile(name.c_str()))
  {
    throw Failure("not a NIfTI or Analyze file");
  }
  return CheckNifti(name);
}
}

vtkSmartPointer<vtkImageData> ReadNifti(const std::string& name)
{
  Check(name);
  vtkNew<vtkNIFTIImageReader> reader;
  reader->SetFileName(name.c_str());
  // It warns where sform and qform differ in handedness, of which both are served here.
  vtkSmartPointer<vtkImageData> image = ImageOf(reader, name, false);
  const auto [slope, shift] = RescalingOf(reader);
  if ((slope != 1.0 || shift != 0.0) && image->GetPointData()->GetScalars())
  {
    image->GetPointData()->SetScalars(Rescaled(image->GetPointData()->GetScalars(), slope, shift));
  }
  VolumePlacement placement;
  if (Place(reader, image->GetSpacing(), placement))
  {
    PlaceImage(image, placement);
    SetWorldAxes(image, "RAS");
  }
  return image;
}

std::unique_ptr<SlabReader> OpenNifti(const std::string& name, const ScratchDirectory& scratch)
{
  const std::uint64_t bytes = Check(name);
  const std::string lower = Lower(name);
  if (EndsWith(lower, ".img") || EndsWith(lower, ".img.gz"))
  {
    return nullptr;
  }
  // Packed, it would be unpacked from its begin for each slab.
  const std::shared_ptr<NamelessFile> unpacked =
    IsGzip(name) ? Unpack(name, 0, scratch, bytes) : nullptr;
  const std::string file = unpacked ? unpacked->Path() : name;
  const auto make = [file, unpacked]
  {
    auto reader = vtkSmartPointer<vtkNIFTIImageReader>::New();
    reader->SetFileName(file.c_str());
    return reader;
  };
  auto slabs = std::make_unique<ReaderSlabs>(name, make);
  const vtkSmartPointer<vtkNIFTIImageReader> reader = make();
  VtkMessages known; // Errors have been told; of sform and qform see above.
  known.ListenTo(reader);
  reader->UpdateInformation();
  std::tie(slabs->Slope, slabs->Shift) = RescalingOf(reader);
  slabs->HasTrustedWarnings = false;
  slabs->IsReversed = reader->GetQFac() < 0;
  if (slabs->Slope != 1.0 || slabs->Shift != 0.0)
  {
    slabs->Type = VTK_FLOAT;
  }
  const Vector3 spacing = slabs->Placement.Spacing;
  slabs->WorldAxes = Place(reader, spacing.data(), slabs->Placement) ? "RAS" : "";
  return slabs;
}
}
