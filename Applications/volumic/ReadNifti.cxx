// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SlabReader.h"

#include "CheckInputs.h"
#include "ParseNumbers.h"
#include "RawSlabs.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "Unpack.h"
#include "VolumeImage.h"
#include "VtkMessages.h"
#include "VtkReaders.h"

#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>

#include <cstdint>
#include <fstream>
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

}

std::unique_ptr<SlabReader> OpenNifti(const std::string& name, const Opening& opening)
{
  if (!vtkNew<vtkNIFTIImageReader>()->CanReadFile(name.c_str()))
  {
    throw Failure("not a NIfTI or Analyze file");
  }
  const std::uint64_t bytes = CheckNifti(name);
  const std::string lower = Lower(name);
  const bool isAlone = !EndsWith(lower, ".img") && !EndsWith(lower, ".img.gz");
  // Packed, it would be unpacked from its begin for each slab.
  std::shared_ptr<NamelessFile> unpacked;
  if (isAlone && !opening.IsWhole && IsGzip(name))
  {
    unpacked = std::make_shared<NamelessFile>(opening.Scratch);
    std::ifstream packed(name, std::ios::binary);
    InflateJust(packed,
      [&](const char* some, std::size_t count) { unpacked->Append(some, count); }, bytes);
  }
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
  // It warns where sform and qform differ in handedness, of which both are served here.
  slabs->HasTrustedWarnings = false;
  slabs->HasParts = isAlone;
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
