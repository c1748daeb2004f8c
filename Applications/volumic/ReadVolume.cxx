// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReadVolume.h"

#include "CheckInputs.h"
#include "InputFiles.h"
#include "ParseNumbers.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "VolumeImage.h"
#include "VtkMessages.h"

#include <vtkDataArray.h>
#include <vtkGenericDataObjectReader.h>
#include <vtkImageData.h>
#include <vtkImageReader2.h>
#include <vtkImageReader2Factory.h>
#include <vtkMRCReader.h>
#include <vtkMatrix4x4.h>
#include <vtkMetaImageReader.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSLCReader.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPImageDataReader.h>
#ifdef VOLUMIC_HAS_HDF
#include <vtkHDFReader.h>
#endif
#ifdef VOLUMIC_HAS_MINC
#include <vtkMINCImageReader.h>
#endif

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <new>
#include <sstream>
#include <utility>

namespace tool
{
namespace
{
using Image = vtkSmartPointer<vtkImageData>;

Image ImageOf(vtkAlgorithm* reader, const std::string& name, bool hasTrustedWarnings = true)
{
  VtkMessages messages;
  messages.UpdateReader(reader, name, hasTrustedWarnings);
  auto* image = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
  if (!image)
  {
    throw Failure(name + ": holds no image");
  }
  return image;
}

template <class Reader>
Image ReadWith(const std::string& name)
{
  vtkNew<Reader> reader;
  reader->SetFileName(name.c_str());
  return ImageOf(reader, name);
}

template <class Reader>
Image ReadIfItsFormat(const std::string& name)
{
  vtkNew<Reader> reader;
  if (!reader->CanReadFile(name.c_str()))
  {
    throw Failure(name + ": is not what its suffix says");
  }
  reader->SetFileName(name.c_str());
  return ImageOf(reader, name);
}

/** MetaIO prints what it misses, and goes on: an error, unless the file is known to be whole. */
Image ReadMetaVoxels(const std::string& name, bool isWhole)
{
  std::ostringstream printed;
  std::streambuf* output = std::cerr.rdbuf(printed.rdbuf());
  Image image;
  try
  {
    image = ReadIfItsFormat<vtkMetaImageReader>(name);
  }
  catch (...)
  {
    std::cerr.rdbuf(output);
    throw;
  }
  std::cerr.rdbuf(output);
  if (!isWhole && !printed.str().empty())
  {
    std::string text = printed.str();
    std::replace(text.begin(), text.end(), '\n', ' ');
    throw Failure("cannot be read (" + text + ")");
  }
  return image;
}

/** The directions of the axes that a MetaImage's header lists, axis after axis. */
std::array<Vector3, 3> MetaAxes(const std::string& name, const std::string& key)
{
  std::istringstream words(HeaderValue(name, key));
  std::array<Vector3, 3> axes;
  for (Vector3& axis : axes)
  {
    if (!(words >> axis[0] >> axis[1] >> axis[2]))
    {
      throw Failure(key + " does not hold nine numbers");
    }
  }
  return axes;
}

/** MetaImage; VTK's reader drops the directions of the axes, which are in the header's text. */
Image ReadMeta(const std::string& name)
{
  const bool isWhole = CheckMeta(name);
  Image image = ReadMetaVoxels(name, isWhole);
  for (const char* key : { "TransformMatrix", "Rotation", "Orientation" })
  {
    if (!HeaderValue(name, key).empty())
    {
      VolumePlacement placement;
      placement.Axes = MetaAxes(name, key);
      image->GetSpacing(placement.Spacing.data());
      image->GetOrigin(placement.Origin.data());
      PlaceImage(image, placement);
      break;
    }
  }
  const std::string sides = HeaderValue(name, "AnatomicalOrientation");
  if (sides.size() == 3 && sides.find_first_not_of("LRAPSI") == std::string::npos)
  {
    SetWorldAxes(image, "LPS"); // whatever the letters, which tell of the voxels' axes
  }
  return image;
}

/** Columns of the matrix, each times the spacing along its axis, and the translation. */
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

/** NIfTI in its own world coordinates (RAS, mm): the sform, or the qform where that fails. */
Image ReadNifti(const std::string& name)
{
  vtkNew<vtkNIFTIImageReader> reader;
  if (!reader->CanReadFile(name.c_str()))
  {
    throw Failure("not a NIfTI or Analyze file");
  }
  CheckNifti(name);
  reader->SetFileName(name.c_str());
  // It warns where sform and qform differ in handedness, of which both are served below.
  Image image = ImageOf(reader, name, false);
  if (reader->GetTimeDimension() > 1)
  {
    throw Failure(NumberText(reader->GetTimeDimension()) + " time points; one volume is needed");
  }
  const double slope = reader->GetRescaleSlope() == 0.0 ? 1.0 : reader->GetRescaleSlope();
  const double shift = reader->GetRescaleIntercept();
  if ((slope != 1.0 || shift != 0.0) && image->GetPointData()->GetScalars())
  {
    image->GetPointData()->SetScalars(Rescaled(image->GetPointData()->GetScalars(), slope, shift));
  }
  std::string failure;
  for (vtkMatrix4x4* matrix : { reader->GetSFormMatrix(), reader->GetQFormMatrix() })
  {
    if (!matrix)
    {
      continue;
    }
    try
    {
      PlaceImage(image, PlacementOf(matrix, image->GetSpacing()));
      SetWorldAxes(image, "RAS");
      return image;
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
  return image;
}

Image ReadMrc(const std::string& name)
{
  CheckMrc(name);
  return ReadWith<vtkMRCReader>(name);
}

#ifdef VOLUMIC_HAS_MINC
/** MINC in its world coordinates, with the real values. */
Image ReadMinc(const std::string& name)
{
  CheckNetcdf(name);
  vtkNew<vtkMINCImageReader> reader;
  reader->SetFileName(name.c_str());
  reader->RescaleRealValuesOn();
  Image image = ImageOf(reader, name);
  if (vtkMatrix4x4* cosines = reader->GetDirectionCosines())
  {
    // Starts are lengths along the axes, not world coordinates.
    VolumePlacement placement = PlacementOf(cosines, image->GetSpacing());
    const double* start = image->GetOrigin();
    for (int row = 0; row < 3; ++row)
    {
      placement.Origin[row] = 0.0;
      for (int axis = 0; axis < 3; ++axis)
      {
        placement.Origin[row] += placement.Axes[axis][row] * start[axis];
      }
    }
    PlaceImage(image, placement);
  }
  return image;
}
#endif

Image ReadFolder(const std::string& name)
{
  const std::vector<std::string> files = FilesOf(name);
  std::vector<std::string> slices;
  std::copy_if(files.begin(), files.end(), std::back_inserter(slices), IsDicom);
  return slices.empty() ? ReadPictures(files) : ReadDicom(slices);
}

Image ReadDicomFile(const std::string& name)
{
  const std::string folder = std::filesystem::path(name).parent_path().string();
  return ReadFolder(folder.empty() ? "." : folder);
}

Image ReadByContent(const std::string& name)
{
  if (IsDicom(name))
  {
    return ReadDicomFile(name);
  }
  vtkSmartPointer<vtkImageReader2> reader;
  VtkMessages ignored; // Some of those that are asked complain of what they don't know.
  ignored.Catch(
    [&] { reader.TakeReference(vtkImageReader2Factory::CreateImageReader2(name.c_str())); });
  if (!reader)
  {
    throw Failure(name + ": not a format that VTK's readers know");
  }
  if (reader->IsA("vtkNIFTIImageReader"))
  {
    return ReadNifti(name);
  }
  CheckPicture(name);
  reader->SetFileName(name.c_str());
  return ImageOf(reader, name);
}

using Reader = Image (*)(const std::string&);

Reader ChooseReader(const std::string& name)
{
  static const std::vector<std::pair<std::string, Reader>> readers = {
    { ".vti", ReadIfItsFormat<vtkXMLImageDataReader> },
    { ".pvti", ReadIfItsFormat<vtkXMLPImageDataReader> },
    { ".vtk", ReadWith<vtkGenericDataObjectReader> },
#ifdef VOLUMIC_HAS_HDF
    { ".vtkhdf", ReadIfItsFormat<vtkHDFReader> },
    { ".hdf", ReadIfItsFormat<vtkHDFReader> },
#endif
    { ".mha", ReadMeta },
    { ".mhd", ReadMeta },
    { ".nrrd", ReadNrrd },
    { ".nhdr", ReadNrrd },
    { ".nii", ReadNifti },
    { ".nii.gz", ReadNifti },
    { ".img", ReadNifti },
    { ".img.gz", ReadNifti },
#ifdef VOLUMIC_HAS_MINC
    { ".mnc", ReadMinc },
#endif
    { ".inv3", ReadInv3 },
    { ".mrc", ReadMrc },
    { ".ccp4", ReadMrc },
    { ".slc", ReadIfItsFormat<vtkSLCReader> },
    { ".dcm", ReadDicomFile },
    { ".dicom", ReadDicomFile },
    { ".ima", ReadDicomFile },
  };
  const std::string lower = Lower(name);
  for (const auto& [suffix, reader] : readers)
  {
    if (lower.size() > suffix.size() && EndsWith(lower, suffix))
    {
      return reader;
    }
  }
  return ReadByContent;
}
}

vtkSmartPointer<vtkImageData> ReadVolume(const std::string& name)
{
  try
  {
    Image image;
    if (std::filesystem::is_directory(name))
    {
      image = ReadFolder(name);
    }
    else if (std::filesystem::exists(name))
    {
      image = ChooseReader(name)(name);
    }
    else if (name.find_first_of("%*") != std::string::npos)
    {
      const std::vector<std::string> files = MatchFiles(name);
      const bool isSeries = !files.empty() && IsDicom(files.front());
      image = isSeries ? ReadDicom(files) : ReadPictures(files);
    }
    else
    {
      throw Failure("no such file or folder");
    }
    if (image->GetNumberOfPoints() == 0)
    {
      throw Failure("the image is empty");
    }
    return image;
  }
  catch (const std::filesystem::filesystem_error& error)
  {
    throw Failure(name + ": " + error.code().message());
  }
  catch (const std::bad_alloc&)
  {
    throw Failure(name + ": not enough memory to read it; crop it, or resample it to fewer voxels");
  }
  catch (const Failure& failure)
  {
    const std::string text = failure.what();
    throw Failure(text.compare(0, name.size(), name) == 0 ? text : name + ": " + text);
  }
}

void ChooseScalars(vtkImageData* image, const std::string& name)
{
  vtkPointData* points = image->GetPointData();
  vtkDataArray* array = name.empty() ? points->GetScalars() : points->GetArray(name.c_str());
  if (!array && name.empty() && points->GetNumberOfArrays() == 1)
  {
    array = points->GetArray(0);
  }
  if (!array)
  {
    std::string names;
    for (int i = 0; i < points->GetNumberOfArrays(); ++i)
    {
      names += std::string(i ? ", " : "") + points->GetArrayName(i);
    }
    throw Failure((name.empty() ? "the volume has no active scalars" : "no point array " + name) +
      (names.empty() ? "; there are no point arrays" : "; point arrays: " + names));
  }
  if (!array->GetName())
  {
    array->SetName("Intensity");
  }
  points->SetActiveScalars(array->GetName()); // SetScalars would drop the one that was active
}
}
