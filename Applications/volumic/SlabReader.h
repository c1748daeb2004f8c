// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSlabReader_h
#define volumicSlabReader_h

#include "BinaryFile.h"
#include "Descriptor.h"
#include "LabelNames.h"
#include "ReadVolume.h"
#include "ToolErrors.h"
#include "VolumeImage.h"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataArray;
class vtkImageReader2;
class vtkMatrix4x4;

namespace tool
{
/** A volume that is read some slices at a time. All that it does may throw a Failure. */
class SlabReader
{
public:
  virtual ~SlabReader() = default;

  std::array<int, 3> Size = { 0, 0, 0 };
  int Type = 0; ///< of the values, as VTK numbers types
  int Components = 1;
  VolumePlacement Placement;
  std::string WorldAxes;  ///< as SetWorldAxes takes them; may be empty
  std::string LengthUnit; ///< as files call it (LengthUnitOf); may be empty
  std::string ArrayName;  ///< of the values; empty: as Read() gives it
  std::string Resampling; ///< how it was made a regular grid; empty: it is one
  LabelNames Names;       ///< that come with it
  bool HasParts = true;   ///< Else some slices cost as much as all, which Read() is asked for then.

  /** The values of so many slices; a new array, or one that is valid until the next call. */
  virtual vtkSmartPointer<vtkDataArray> Read(int first, int count) = 0;
};

/**
 * A source of a pipeline that makes the slices that it is asked for. What the reader throws is an
 * error of its, with that text.
 */
vtkSmartPointer<vtkAlgorithm> NewSlabSource(std::shared_ptr<SlabReader> reader);

/** All slices. @throws Failure that the reader throws. */
vtkSmartPointer<vtkImageData> ReadAllSlabs(SlabReader& reader);

/** What a volume is opened for. */
struct Opening
{
  std::string Array;    ///< that is wanted; empty: as ChooseScalars has it
  std::string Scratch;  ///< where packed voxels are unpacked to: the option --scratch
  bool IsWhole = false; ///< All slices will be read, at once: what is packed needs no file.
  VolumeChoice Choice;
};

// The formats, which ReadVolume.cxx lists.

/** MetaImage (.mha, .mhd); VTK's reader drops the directions of the axes. */
std::unique_ptr<SlabReader> OpenMeta(const std::string& name, const Opening& opening);

/** MRC (.mrc, .ccp4); VTK's reader takes voxels of mode 6 for twice as many. */
std::unique_ptr<SlabReader> OpenMrc(const std::string& name, const Opening& opening);

/** NumPy's arrays (.npy) of three axes: z, y, x, or, in Fortran's order, x, y, z. */
std::unique_ptr<SlabReader> OpenNumpy(const std::string& name, const Opening& opening);

/** FreeSurfer's volumes (.mgz, .mgh), in its scanner coordinates (RAS). */
std::unique_ptr<SlabReader> OpenMgh(const std::string& name, const Opening& opening);

/** A file of nothing but voxels, or whose last bytes they are, as --raw describes them. */
std::unique_ptr<SlabReader> OpenRaw(const std::string& name, const Opening& opening);

/** NRRD (.nrrd, .nhdr; encodings raw, gzip, bzip2, text), in the file's `space`. */
std::unique_ptr<SlabReader> OpenNrrd(const std::string& name, const Opening& opening);

/** NIfTI in its own world coordinates (RAS): the sform, or the qform where there is none. */
std::unique_ptr<SlabReader> OpenNifti(const std::string& name, const Opening& opening);

/**
 * The volume of an InVesalius project (.inv3), unit mm, its axes as they are stored: the world axes
 * are L, A, S.
 */
std::unique_ptr<SlabReader> OpenInv3(const std::string& name, const Opening& opening);

/**
 * The slices of one series, in DICOM's patient coordinates (LPS, mm), sorted by position.
 * @param slice one of those that are wanted; empty: any
 */
std::unique_ptr<SlabReader> OpenDicom(
  const std::vector<std::string>& files, const std::string& slice, const Opening& opening);

/** Pictures of one size as the slices of a volume of spacing 1, in this order. */
std::unique_ptr<SlabReader> OpenPictures(
  const std::vector<std::string>& files, const Opening& opening);

/** By ITK: GIPL (.gipl, .gipl.gz), and MINC 2, in its world coordinates. */
std::unique_ptr<SlabReader> OpenGipl(const std::string& name, const Opening& opening);
std::unique_ptr<SlabReader> OpenMinc2(const std::string& name, const Opening& opening);

/** The pages of a TIFF, with the distances that programs of microscopes tell; channels, times. */
std::unique_ptr<SlabReader> OpenTiff(const std::string& name, const Opening& opening);
bool IsTiff(const std::string& name);

/** A picture, the pages of a TIFF, or what else a reader of VTK takes for its own. */
std::unique_ptr<SlabReader> OpenByContent(const std::string& name, const Opening& opening);

/**
 * Several numbers of a voxel are no vector, whose magnitude could be taken.
 * @throws Failure if one must be chosen
 */
void NeedComponent(int components, const std::string& kind, const Opening& opening);

/** Which of so many times is chosen. @throws Failure if none is, or there is none of that number */
int TimeOf(const VolumeChoice& choice, std::uint64_t times);

/** "3 x 4 x 5" */
std::string SizeText(const std::array<int, 3>& size);

// ---- Readers of VTK -----------------------------------------------------------------------------

/** The image that a reader of VTK gives. @throws Failure if it, or one within it, complains. */
vtkSmartPointer<vtkImageData> ImageOf(vtkAlgorithm* reader, const std::string& name);

template <class Reader>
vtkSmartPointer<vtkImageData> ReadWith(const std::string& name)
{
  vtkNew<Reader> reader;
  reader->SetFileName(name.c_str());
  return ImageOf(reader, name);
}

/** The one of VTK's readers of images that takes the file for its own. @throws Failure for none. */
vtkSmartPointer<vtkImageReader2> ReaderOf(const std::string& name);

/** A reader for the file. @throws Failure if it is of another format. */
template <class Reader>
vtkSmartPointer<Reader> NewReader(const std::string& name)
{
  auto reader = vtkSmartPointer<Reader>::New();
  if (!reader->CanReadFile(name.c_str()))
  {
    throw Failure(name + ": is not what its suffix says");
  }
  reader->SetFileName(name.c_str());
  return reader;
}

template <class Reader>
vtkSmartPointer<vtkImageData> ReadIfItsFormat(const std::string& name)
{
  return ImageOf(NewReader<Reader>(name), name);
}

/** Columns of the matrix, each times the spacing along its axis, and the translation. */
VolumePlacement PlacementOf(vtkMatrix4x4* matrix, const double* spacing);

/**
 * Slices by a reader of VTK that gives parts of an image: each time by a new one, as vtkTIFFReader
 * gives other slices when it is asked again.
 */
class ReaderSlabs : public SlabReader
{
public:
  using Factory = std::function<vtkSmartPointer<vtkImageReader2>()>;

  /** Size, type and so on are what a reader of the file `name` tells. */
  ReaderSlabs(const std::string& name, const Factory& make);

  bool HasTrustedWarnings = true; ///< as VtkMessages::UpdateReader says
  bool IsReversed = false;        ///< The reader reverses the slices, of each part by itself.
  double Slope = 1.0;             ///< What is read gets multiplied,
  double Shift = 0.0;             ///< and shifted, and is float then.

  /** The reader gives the numbers of several volumes for a voxel, of which one is wanted. */
  void Pick(int time, int times);

  vtkSmartPointer<vtkDataArray> Read(int first, int count) override;

private:
  std::string Name;
  Factory Make;
  int Picked = -1; ///< the volume; -1: all numbers are its
};

// ---- Voxels that lie in files -------------------------------------------------------------------

/** A file without a name in a folder: it is there as long as this object or the process. */
class NamelessFile
{
public:
  /** @param directory empty: TMPDIR, or /var/tmp. @throws Failure if there can be none. */
  explicit NamelessFile(const std::string& directory);

  /** @throws Failure if the disk is full. */
  void Append(const char* bytes, std::size_t count);

  /** By which it can be opened, in this process. */
  const std::string& Path() const { return this->Link; }

private:
  NamelessFile(const std::string& directory, int number);

  std::string Directory;
  std::string Link;
  Descriptor File;
};

/** The volume, or, where its numbers are bits of halves of floats, as floats. */
std::unique_ptr<SlabReader> AsFloats(std::unique_ptr<SlabReader> volume, bool areHalves);

/** The stream of a data file, at that byte. @throws Failure that names it if it cannot be opened.
 */
std::ifstream OpenData(const std::string& name, std::uint64_t start);

/** Values one behind the other in a file, or in several, an equal share in each, x fastest. */
class RawSlabs : public SlabReader
{
public:
  enum class Packing
  {
    None,
    Zlib, ///< or gzip
    Bzip2,
    Text ///< numbers with blanks between
  };

  std::vector<std::string> Files;
  Packing Code = Packing::None;
  std::uint64_t Start = 0;  ///< Each file has so many bytes before its values, packed or not.
  std::uint64_t Before = 0; ///< What is packed begins with so many bytes before the values.
  bool AreLast = false;     ///< The values are the last bytes of a file, whatever is before.
  bool IsBig = false;       ///< The most significant byte of a value comes first.

  /** Of so many volumes, one behind the other, choose one; where nothing follows them. */
  void PickTime(const VolumeChoice& choice, std::uint64_t times);

  bool HasMore = false; ///< Behind the values there may be others.

  /**
   * To call when all this is known. Packed values, of which parts will be wanted, are unpacked.
   * @throws Failure, before memory is taken, if a file is too short or too long.
   */
  void Prepare(const Opening& opening);

  vtkSmartPointer<vtkDataArray> Read(int first, int count) override;

private:
  /** Bytes of all values, and of those in each file. */
  std::uint64_t Bytes() const;
  std::uint64_t Share() const { return this->Bytes() / this->Files.size(); }

  void CheckLength(const std::string& file) const;
  std::uint64_t StartIn(const std::string& file) const;
  void Unpack(const UnpackedSink& sink) const;
  void ReadBytes(std::uint64_t first, std::uint64_t count, char* values) const;

  std::uint64_t After = 0;                ///< bytes of the volumes behind the one that is chosen
  std::unique_ptr<NamelessFile> Unpacked; ///< If it is there, it is the only one of Files.
};
}

#endif
