// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicReadVolume_h
#define volumicReadVolume_h

#include <vtkSmartPointer.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkImageData;

namespace tool
{
/** What is read of a file that holds several volumes, and how what is ambiguous. */
struct VolumeChoice
{
  std::string Series;         ///< of DICOM: a number from 1, or an identifier; empty: the only one
  std::optional<int> Time;    ///< from 0; none: there is only one
  std::shared_ptr<int> Times; ///< set to how many there are, where there may be several; null: not
  std::string Raw;            ///< of a file without a header: --raw
  bool Resamples = true;      ///< what is no regular grid
  bool AreLabels = false;     ///< what it holds: not to be mixed with each other
  /** Whether of several numbers that are no vector, such as times, one must have been chosen. */
  bool NeedsComponent = false;
};

/**
 * Read a volume: a file of one of the formats of volumic(1), a folder (of the slices of a DICOM
 * series, or of pictures), or a pattern of pictures. World coordinates are those of the file, in
 * its units; rescaled values (NIfTI, DICOM, MINC) are the physical ones.
 * @throws Failure that names the file and the reason.
 */
vtkSmartPointer<vtkImageData> ReadVolume(const std::string& name, const VolumeChoice& choice = {});

/** A volume that can be read slab by slab, or has been read. */
struct OpenedVolume
{
  vtkSmartPointer<vtkAlgorithm> Source; ///< Its output is the image.
  std::string Whole; ///< Why it has been read as a whole, if so: the format, or what it holds.
};

/**
 * Open a volume as ReadVolume reads it, which takes little memory if the format can be read in
 * parts.
 * @param array   that is wanted; empty: as ChooseScalars has it
 * @param scratch the folder for what is unpacked: the option --scratch
 * @throws Failure as ReadVolume; what is wrong with the voxels is told as they are read.
 */
OpenedVolume OpenVolume(const std::string& name, const std::string& array,
  const std::string& scratch, const VolumeChoice& choice = {});

/**
 * What the DICOM series of a file or folder are, a line for each: number, description, kind, date,
 * slices, identifier. @throws Failure if there are none
 */
std::vector<std::string> ListSeries(const std::string& name);

/**
 * Make the array (empty: the active scalars, or the only one) the active scalars. Where it is one
 * of cells, the image becomes that of their centres.
 * @return whether it is one of cells
 * @throws Failure if there is none.
 */
bool ChooseScalars(vtkImageData* image, const std::string& array);

bool IsDicom(const std::string& file);

/**
 * Whether a file that is not DICOM may have been before it was cut off or damaged: it is named like
 * one of the slices but for numbers, ends like all DICOM files do, or begins like one.
 */
bool IsLikeSlice(const std::string& file, const std::vector<std::string>& slices);

/**
 * Existing files that match a pattern: '*' in the name stands for any text, '%d' (or '%03d') for
 * a number. Sorted as people count: slice9 before slice10.
 */
std::vector<std::string> MatchFiles(const std::string& pattern);

/** All regular files of the folder, and of those within it, sorted likewise. */
std::vector<std::string> FilesOf(const std::string& folder, bool isNested = false);

// ---- Files of volumes ---------------------------------------------------------------------------

/**
 * All files that ReadVolume would read: those of a folder, of a pattern or of a DICOM series, and
 * those that a header (.mhd, .nhdr, .pvti, .hdr) names. What is missing or cannot be read is left
 * to ReadVolume.
 */
std::vector<std::string> FilesOfVolume(const std::string& name);

/**
 * The files of a folder: those of DICOM alone, with those of the folders within, or, if there are
 * none, all.
 */
std::vector<std::string> FilesOfFolder(const std::string& folder, bool isNested = true);

/** Those beside a DICOM file: of its folder, or, for a DICOMDIR, of those within, too. */
std::vector<std::string> FilesBesideSlice(const std::string& slice);

/** @throws Failure that names the one of these files that is a pipe or a device. */
void NeedFilesOfVolume(const std::string& name);

/**
 * The value of `key` in the first lines of a text header ("ElementDataFile = a.raw", "data file:
 * a.raw"), without blanks at its ends; empty if there is none.
 */
std::string HeaderValue(const std::string& name, const std::string& key);

/** Whether a line of a text header is "key = value" or "key: value", of any case. */
bool IsOfKey(const std::string& line, const std::string& key);
}

#endif
