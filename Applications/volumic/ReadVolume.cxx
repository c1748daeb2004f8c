// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReadVolume.h"

#include "CheckInputs.h"
#include "MaskFolder.h"
#include "Messages.h"
#include "RegularGrid.h"
#include "SlabReader.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "VolumeImage.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSLCReader.h>
#include <vtkStructuredPointsReader.h>
#include <vtkTrivialProducer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPImageDataReader.h>
#ifdef VOLUMIC_HAS_HDF
#include <vtkHDFReader.h>
#endif
#ifdef VOLUMIC_HAS_MINC
#include <vtkMINCImageReader.h>
#endif

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <new>
#include <stdexcept>
#include <utility>

namespace tool
{
namespace
{
using Image = vtkSmartPointer<vtkImageData>;

/** A volume of which the header has been read at the most. */
struct FoundVolume
{
  vtkSmartPointer<vtkAlgorithm> Parts; ///< null where a part costs as much as the whole
  std::function<Image()> ReadAll;
};

FoundVolume InSlabs(std::shared_ptr<SlabReader> slabs, const Opening& opening)
{
  slabs = AtRightAngles(std::move(slabs), opening);
  PlaceImage(vtkNew<vtkImageData>(), slabs->Placement); // fails here rather than in a pipeline
  return { slabs->HasParts ? NewSlabSource(slabs) : nullptr,
    [slabs] { return ReadAllSlabs(*slabs); } };
}

using Opener = std::function<FoundVolume(const std::string&, const Opening&)>;
using SlabOpener = std::unique_ptr<SlabReader> (*)(const std::string&, const Opening&);

Opener By(SlabOpener open)
{
  return [open](const std::string& name, const Opening& opening)
  { return InSlabs(open(name, opening), opening); };
}

Opener By(Image (*read)(const std::string&))
{
  return [read](const std::string& name, const Opening&) {
    return FoundVolume{ nullptr, [name, read] { return read(name); } };
  };
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

/** MINC 1 is netCDF, and MINC 2 HDF5. */
FoundVolume OpenMinc(const std::string& name, const Opening& opening)
{
  const bool isHdf = HeadOf(name, 4) == "\x89HDF";
#ifdef VOLUMIC_HAS_MINC
  if (!isHdf)
  {
    return By(ReadMinc)(name, opening);
  }
#endif
  FailIf(!isHdf, "MINC 1 is read where VTK was built with it; convert it by mincconvert -2");
  return By(OpenMinc2)(name, opening);
}

/** @throws Failure for a file of the folder that may be a slice which was damaged. */
void CheckBeside(const std::string& folder, const std::vector<std::string>& slices)
{
  for (const std::string& file : FilesOf(folder))
  {
    FailIf(!IsDicom(file) && IsLikeSlice(file, slices),
      file +
        ": no DICOM file, though like the slices beside it: it is cut off or damaged; copy it "
        "again, or take it out of the folder");
  }
}

/** @param slice of DICOM, that is wanted; empty: any */
FoundVolume OpenSlices(const std::vector<std::string>& slices, bool areDicom,
  const Opening& opening, const std::string& slice = "")
{
  return InSlabs(
    areDicom ? OpenDicom(slices, slice, opening) : OpenPictures(slices, opening), opening);
}

FoundVolume OpenDicomFile(const std::string& name, const Opening& opening)
{
  const std::vector<std::string> slices = FilesBesideSlice(name);
  CheckBeside(std::filesystem::absolute(name).parent_path().string(), slices);
  return OpenSlices(slices, true, opening, name);
}

/**
 * Readers of VTK that give parts; without the arrays that nobody asks for. Of values of cells all
 * is read, to become points.
 */
template <class Reader>
FoundVolume OpenXml(const std::string& name, const Opening& opening)
{
  const std::string& array = opening.Array;
  CheckXmlInput(name);
  const vtkSmartPointer<Reader> reader = NewReader<Reader>(name);
  VtkMessages().AskReader(reader, name);
  std::string names;
  bool isThere = array.empty() && reader->GetNumberOfPointArrays() > 0;
  for (int i = 0; !array.empty() && i < reader->GetNumberOfPointArrays(); ++i)
  {
    const std::string each = reader->GetPointArrayName(i);
    names += (names.empty() ? "; point arrays: " : ", ") + each;
    isThere = isThere || array == each;
    reader->SetPointArrayStatus(each.c_str(), array == each ? 1 : 0);
  }
  bool isOfCells = false;
  for (int i = 0; !isThere && i < reader->GetNumberOfCellArrays(); ++i)
  {
    isOfCells = isOfCells || array.empty() || array == reader->GetCellArrayName(i);
  }
  FailIf(!isThere && !isOfCells && !array.empty(),
    "no point array " + array + (names.empty() ? "; there are none" : names));
  return { isOfCells ? nullptr : reader, [reader, name] { return ImageOf(reader, name); } };
}

/** What other data of VTK are called, by their suffix; null: none of them. */
const char* OtherDataOf(const std::string& suffix)
{
  static const std::map<std::string, const char*> kinds = { { ".vtr", "a rectilinear grid" },
    { ".vts", "a curvilinear grid" }, { ".vtu", "an unstructured grid" }, { ".vtp", "a surface" } };
  // Of parts: .pvtu and so on.
  return EntryOr(kinds, suffix.substr(0, 2) == ".p" ? "." + suffix.substr(2) : suffix, nullptr);
}

Opener OpenerOf(const std::string& name)
{
  using Suffixes = std::vector<const char*>;
  static const std::vector<std::pair<Suffixes, Opener>> openers = {
    { { ".vti" }, OpenXml<vtkXMLImageDataReader> },
    { { ".pvti" }, OpenXml<vtkXMLPImageDataReader> },
    { { ".vtk" }, By(ReadWith<vtkStructuredPointsReader>) },
#ifdef VOLUMIC_HAS_HDF
    { { ".vtkhdf", ".hdf" }, By(ReadIfItsFormat<vtkHDFReader>) },
#endif
    { { ".mha", ".mhd" }, By(OpenMeta) },
    { { ".nrrd", ".nhdr" }, By(OpenNrrd) },
    { { ".nii", ".nii.gz", ".img", ".img.gz", ".hdr", ".hdr.gz" }, By(OpenNifti) },
    { { ".mnc" }, OpenMinc },
    { { ".gipl", ".gipl.gz" }, By(OpenGipl) },
    { { ".inv3" }, By(OpenInv3) },
    { { ".mrc", ".ccp4", ".map", ".rec", ".mrc.gz", ".ccp4.gz", ".map.gz", ".rec.gz" },
      By(OpenMrc) },
    { { ".npy" }, By(OpenNumpy) },
    { { ".mgz", ".mgh" }, By(OpenMgh) },
    { { ".slc" }, By(ReadIfItsFormat<vtkSLCReader>) },
    { { ".dcm", ".dicom", ".ima" }, OpenDicomFile },
  };
  if (const char* kind = OtherDataOf(SuffixOf(name)))
  {
    throw Failure(std::string("holds ") + kind +
      ", and no image: resample it to one (ParaView's Resample To Image writes a .vti)");
  }
  const std::string lower = Lower(name);
  const auto isOf = [&lower](const char* suffix)
  { return lower.size() > std::strlen(suffix) && EndsWith(lower, suffix); };
  for (const auto& [suffixes, opener] : openers)
  {
    if (std::any_of(suffixes.begin(), suffixes.end(), isOf))
    {
      return opener;
    }
  }
  return IsDicom(name) ? OpenDicomFile : By(OpenByContent);
}

FoundVolume FindVolume(const std::string& name, const Opening& opening)
{
  NeedFilesOfVolume(name);
  const bool isFolder = std::filesystem::is_directory(name);
  if (!isFolder && std::filesystem::exists(name))
  {
    return opening.Choice.Raw.empty() ? OpenerOf(name)(name, opening)
                                      : InSlabs(OpenRaw(name, opening), opening);
  }
  FailIf(!isFolder && name.find_first_of("%*") == std::string::npos, "no such file or folder");
  const std::vector<std::string> files = isFolder ? FilesOfFolder(name) : MatchFiles(name);
  const std::vector<std::string> masks = MasksAmong(files);
  if (masks.size() == 1 && !opening.Choice.AreLabels)
  {
    return OpenerOf(masks[0])(masks[0], opening);
  }
  if (!masks.empty())
  {
    // They are read at once: what is told of them would be lost later.
    return { nullptr, [image = ReadMasks(masks, opening.Choice)] { return image; } };
  }
  const bool areDicom = !files.empty() && IsDicom(files.front());
  if (areDicom && isFolder)
  {
    CheckBeside(name, files);
  }
  return OpenSlices(files, areDicom, opening);
}

Image ReadAll(const FoundVolume& volume)
{
  Image image;
  VtkMessages ignored; // VTK prints that there is no memory, and throws.
  ignored.Catch([&] { image = volume.ReadAll(); });
  FailIf(image->GetNumberOfPoints() == 0, "the image is empty");
  return image;
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

vtkSmartPointer<vtkImageData> ReadVolume(const std::string& name, const VolumeChoice& choice)
{
  return NameFailures(name, [&] { return ReadAll(FindVolume(name, { "", "", true, choice })); });
}

OpenedVolume OpenVolume(const std::string& name, const std::string& array,
  const std::string& scratch, const VolumeChoice& choice)
{
  return NameFailures(name,
    [&]
    {
      const FoundVolume volume = FindVolume(name, { array, scratch, false, choice });
      if (volume.Parts)
      {
        return OpenedVolume{ volume.Parts, "" };
      }
      const Image image = ReadAll(volume);
      const bool areOfCells = ChooseScalars(image, array);
      auto holder = vtkSmartPointer<vtkTrivialProducer>::New();
      holder->SetOutput(image);
      const std::string suffix = SuffixOf(name);
      return OpenedVolume{ holder,
        areOfCells         ? "values of cells"
          : suffix.empty() ? "masks"
                           : suffix };
    });
}

namespace
{
/** Makes the image one of the centres of its cells, which have the values of the array. */
void TakeCells(vtkImageData* image, vtkDataArray* values)
{
  vtkNew<vtkImageData> centres;
  int extent[6];
  double first[3];
  double origin[3];
  image->GetExtent(extent);
  for (int axis = 0; axis < 3; ++axis)
  {
    // An axis with one point has one cell.
    first[axis] = extent[2 * axis + 1] > extent[2 * axis] ? 0.5 : 0.0;
    extent[2 * axis + 1] = std::max(extent[2 * axis], extent[2 * axis + 1] - 1);
  }
  image->TransformContinuousIndexToPhysicalPoint(first, origin);
  centres->SetExtent(extent);
  centres->SetOrigin(origin);
  centres->SetSpacing(image->GetSpacing());
  centres->SetDirectionMatrix(image->GetDirectionMatrix());
  centres->GetPointData()->SetScalars(values);
  if (vtkUnsignedCharArray* ghosts = image->GetCellGhostArray())
  {
    vtkNew<vtkUnsignedCharArray> hidden;
    hidden->SetName(ghosts->GetName());
    for (vtkIdType i = 0; i < ghosts->GetNumberOfTuples(); ++i)
    {
      const bool isHidden = (ghosts->GetValue(i) & vtkDataSetAttributes::HIDDENCELL) != 0;
      hidden->InsertNextValue(isHidden ? vtkDataSetAttributes::HIDDENPOINT : 0);
    }
    centres->GetPointData()->AddArray(hidden);
  }
  centres->GetFieldData()->ShallowCopy(image->GetFieldData());
  image->ShallowCopy(centres);
}
}

bool ChooseScalars(vtkImageData* image, const std::string& name)
{
  const auto arrayOf = [&name](vtkDataSetAttributes* all)
  {
    vtkDataArray* array = name.empty() ? all->GetScalars() : all->GetArray(name.c_str());
    return !array && name.empty() && all->GetNumberOfArrays() == 1 ? all->GetArray(0) : array;
  };
  vtkPointData* points = image->GetPointData();
  vtkDataArray* array = arrayOf(points);
  vtkDataArray* ofCells = !array && (!name.empty() || points->GetNumberOfArrays() == 0)
    ? arrayOf(image->GetCellData())
    : nullptr;
  if (!array && !ofCells)
  {
    std::string names;
    for (int i = 0; i < points->GetNumberOfArrays(); ++i)
    {
      names += std::string(i ? ", " : "") + points->GetArrayName(i);
    }
    throw Failure((name.empty() ? "the volume has no active scalars" : "no point array " + name) +
      (names.empty() ? "; there are no point arrays" : "; point arrays: " + names));
  }
  const vtkSmartPointer<vtkDataArray> chosen = array ? array : ofCells;
  if (!chosen->GetName())
  {
    chosen->SetName("Intensity");
  }
  if (ofCells)
  {
    TakeCells(image, chosen);
  }
  // SetScalars would drop the one that was active.
  image->GetPointData()->SetActiveScalars(chosen->GetName());
  return ofCells != nullptr;
}
}
