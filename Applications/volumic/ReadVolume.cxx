// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReadVolume.h"

#include "CheckInputs.h"
#include "InputFiles.h"
#include "SlabReader.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "VolumeImage.h"
#include "VtkMessages.h"
#include "VtkReaders.h"

#include <vtkDataArray.h>
#include <vtkGenericDataObjectReader.h>
#include <vtkImageData.h>
#include <vtkImageReader2.h>
#include <vtkImageReader2Factory.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSLCReader.h>
#include <vtkTrivialProducer.h>
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
#include <initializer_list>
#include <iterator>
#include <memory>
#include <new>
#include <stdexcept>
#include <utility>

namespace tool
{
namespace
{
using Image = vtkSmartPointer<vtkImageData>;

template <class Reader>
Image ReadXml(const std::string& name)
{
  CheckXmlInput(name);
  return ReadIfItsFormat<Reader>(name);
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

/** The slices of a folder, of DICOM or pictures, and whether they are DICOM. */
std::pair<std::vector<std::string>, bool> SlicesOf(const std::string& folder)
{
  const std::vector<std::string> files = FilesOf(folder);
  std::vector<std::string> slices;
  std::copy_if(files.begin(), files.end(), std::back_inserter(slices), IsDicom);
  for (const std::string& file : files)
  {
    if (!IsDicom(file) && IsLikeSlice(file, slices))
    {
      throw Failure(file + ": no DICOM file, though like the slices beside it: it is cut off or "
                           "damaged; copy it again, or take it out of the folder");
    }
  }
  return slices.empty() ? std::pair{ files, false } : std::pair{ slices, true };
}

Image ReadFolder(const std::string& name)
{
  const auto [slices, areDicom] = SlicesOf(name);
  return areDicom ? ReadDicom(slices) : ReadPictures(slices);
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
  CheckPicture(name); // before any reader of VTK looks at it
  vtkSmartPointer<vtkImageReader2> reader;
  VtkMessages ignored; // Some of those that are asked complain of what they don't know.
  ignored.Catch(
    [&] { reader.TakeReference(vtkImageReader2Factory::CreateImageReader2(name.c_str())); });
  if (!reader)
  {
    throw Failure(name + ": not a format that VTK's readers know");
  }
  CheckChosen(reader, name);
  if (reader->IsA("vtkNIFTIImageReader"))
  {
    return ReadNifti(name);
  }
  reader->SetFileName(name.c_str());
  return ImageOf(reader, name);
}

using Reader = Image (*)(const std::string&);

Reader ChooseReader(const std::string& name)
{
  static const std::vector<std::pair<std::string, Reader>> readers = {
    { ".vti", ReadXml<vtkXMLImageDataReader> },
    { ".pvti", ReadXml<vtkXMLPImageDataReader> },
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

std::unique_ptr<SlabReader> OpenSlices(const std::pair<std::vector<std::string>, bool>& slices)
{
  return slices.second ? OpenDicom(slices.first) : OpenPictures(slices.first);
}

/** Readers of VTK that give parts; without the arrays that nobody asks for. */
template <class Reader>
vtkSmartPointer<vtkAlgorithm> OpenXml(const std::string& name, const std::string& array)
{
  CheckXmlInput(name);
  const vtkSmartPointer<Reader> reader = NewReader<Reader>(name);
  VtkMessages messages;
  messages.ListenTo(reader);
  messages.Catch([&] { reader->UpdateInformation(); });
  if (!messages.Errors.empty())
  {
    throw Failure("cannot be read (" + messages.JoinedErrors() + ")");
  }
  std::string names;
  bool isThere = array.empty();
  for (int i = 0; !array.empty() && i < reader->GetNumberOfPointArrays(); ++i)
  {
    const std::string each = reader->GetPointArrayName(i);
    names += (names.empty() ? "; point arrays: " : ", ") + each;
    isThere = isThere || array == each;
    reader->SetPointArrayStatus(each.c_str(), array == each ? 1 : 0);
  }
  if (!isThere)
  {
    throw Failure("no point array " + array + (names.empty() ? "; there are none" : names));
  }
  return reader;
}

/** Null where the file can only be read as a whole. */
vtkSmartPointer<vtkAlgorithm> OpenFile(
  const std::string& name, const std::string& array, const std::string& scratch)
{
  const std::string lower = Lower(name);
  const auto ends = [&lower](std::initializer_list<const char*> suffixes)
  {
    return std::any_of(suffixes.begin(), suffixes.end(),
      [&](const char* suffix) { return EndsWith(lower, suffix); });
  };
  std::unique_ptr<SlabReader> slabs;
  if (ends({ ".vti" }))
  {
    return OpenXml<vtkXMLImageDataReader>(name, array);
  }
  if (ends({ ".pvti" }))
  {
    return OpenXml<vtkXMLPImageDataReader>(name, array);
  }
  if (ends({ ".mrc", ".ccp4" }))
  {
    slabs = OpenMrc(name);
  }
  else if (ends({ ".mha", ".mhd" }))
  {
    slabs = OpenMeta(name, scratch);
  }
  else if (ends({ ".nrrd", ".nhdr" }))
  {
    slabs = OpenNrrd(name, scratch);
  }
  else if (ends({ ".nii", ".nii.gz" }))
  {
    slabs = OpenNifti(name, scratch);
  }
  else if (ends({ ".tif", ".tiff" }))
  {
    slabs = OpenTiff(name);
  }
  else if (ends({ ".dcm", ".dicom", ".ima" }) || IsDicom(name))
  {
    const std::string folder = std::filesystem::path(name).parent_path().string();
    slabs = OpenSlices(SlicesOf(folder.empty() ? "." : folder));
  }
  return slabs ? NewSlabSource(std::move(slabs)) : nullptr;
}

/** What the work gives; what it throws names the volume. */
template <class Work>
auto NameFailures(const std::string& name, const Work& work) -> decltype(work())
{
  try
  {
    return work();
  }
  catch (const std::filesystem::filesystem_error& error)
  {
    throw Failure(name + ": " + error.code().message());
  }
  catch (const std::bad_alloc&)
  {
    throw Failure(name + ": not enough memory to read it; crop it, or resample it to fewer voxels");
  }
  catch (const std::length_error&)
  {
    throw Failure(name + ": its header is damaged: it asks for more than any memory has");
  }
  catch (const UsageError& error)
  {
    throw Failure(name + ": the header cannot be parsed: " + error.what());
  }
  catch (const Failure& failure)
  {
    const std::string text = failure.what();
    throw Failure(text.compare(0, name.size(), name) == 0 ? text : name + ": " + text);
  }
}
}

vtkSmartPointer<vtkImageData> ReadVolume(const std::string& name)
{
  return NameFailures(name,
    [&name]
    {
      NeedFilesOfVolume(name);
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
    });
}

vtkSmartPointer<vtkAlgorithm> OpenParts(
  const std::string& name, const std::string& array, const std::string& scratch)
{
  return NameFailures(name,
    [&]() -> vtkSmartPointer<vtkAlgorithm>
    {
      NeedFilesOfVolume(name);
      if (std::filesystem::is_directory(name))
      {
        return NewSlabSource(OpenSlices(SlicesOf(name)));
      }
      if (std::filesystem::exists(name))
      {
        return OpenFile(name, array, scratch);
      }
      const std::vector<std::string> files =
        name.find_first_of("%*") != std::string::npos ? MatchFiles(name)
                                                      : std::vector<std::string>();
      return files.empty() ? nullptr
                           : NewSlabSource(OpenSlices({ files, IsDicom(files.front()) }));
    });
}

OpenedVolume OpenVolume(
  const std::string& name, const std::string& array, const std::string& scratch)
{
  OpenedVolume opened;
  opened.Source = OpenParts(name, array, scratch);
  if (!opened.Source)
  {
    const vtkSmartPointer<vtkImageData> image = ReadVolume(name);
    ChooseScalars(image, array);
    auto holder = vtkSmartPointer<vtkTrivialProducer>::New();
    holder->SetOutput(image);
    opened.Source = holder;
    opened.Whole = SuffixOf(name);
  }
  return opened;
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
