// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicToolLabelNames_h
#define volumicToolLabelNames_h

#include "VolumeImage.h"

#include <optional>
#include <string>
#include <vector>

class vtkImageData;

namespace tool
{
/** What a label is called. */
struct LabelName
{
  int Label = 0;
  std::string Name;             ///< UTF-8, on one line; may be empty
  std::optional<Vector3> Color; ///< 0 to 1, or, until ScaleColors, as the file has it
  int Layer = 0;                ///< of a volume whose voxels have several labels: the component
};

using LabelNames = std::vector<LabelName>;

/**
 * Read a list of names, of which there are many kinds; the suffix tells little of them:
 * - JSON: {"1": "liver"} or {"liver": 1}, alone or somewhere within (nnU-Net's `labels`,
 *   TotalSegmentator's classes), or a list of segments with their labels and names (3D Slicer);
 * - the label descriptions of ITK-SNAP;
 * - lines of a label, a name and perhaps a colour (3D Slicer's .ctbl, FreeSurfer), or a number that
 *   means nothing here (MRIcron's .nii.txt);
 * - tables with commas, semicolons or tabs, with or without a line of column names (BIDS).
 * @throws Failure that names the file, and the line where there is one.
 */
LabelNames ReadLabelNames(const std::string& file);

/** Names that lie beside a volume. */
struct NamesBeside
{
  LabelNames Names;
  std::string File;                 ///< empty: none was found
  std::vector<std::string> Refused; ///< files with such a name that could not be read, and why
};

/**
 * Look for a file of names as they are called usually: for a.nii.gz a.nii.txt, a.label, a.txt,
 * a.ctbl, a.json, a.csv or a.tsv, and nnU-Net's dataset.json in its folder or the one above.
 */
NamesBeside ReadNamesBeside(const std::string& volume);

/** Those of the files above that are there. */
std::vector<std::string> FilesBeside(const std::string& volume);

/**
 * Give an image names as vtkLabelsToSurfaces takes them, in the field data; layers, if there are
 * any but the first, as `LabelLayers`. Colours are given only where all names have one.
 */
void SetLabelNames(vtkImageData* image, const LabelNames& names);

/** Those that the image has. */
LabelNames GetLabelNames(vtkImageData* image);

/** `names`, those of `others` in the place of those of the same label. */
LabelNames Merged(const LabelNames& names, const LabelNames& others);

/**
 * Names that the file of a volume has itself: those of the segments of a .seg.nrrd, or of the label
 * table in the header of NIfTI (TotalSegmentator, Connectome Workbench). Empty for other formats,
 * and where they cannot be read.
 */
LabelNames ReadNamesWithin(const std::string& volume);

/** A name as it is shown: on one line, in UTF-8. */
std::string PlainName(std::string text);

// ---- Parts of both ------------------------------------------------------------------------------

/** @throws Failure or UsageError if it is no NRRD. */
LabelNames NamesInNrrd(const std::string& name);

/** Of a file that may be packed. */
LabelNames NamesInNifti(const std::string& name);

/** @throws Failure without the name of the file. */
LabelNames ParseLabelTable(const std::string& text);

/** @throws Failure without the name of the file. */
LabelNames ParseLabelJson(const std::string& text);

/** Colours from 0 to 255 become such from 0 to 1. @throws Failure if any are neither. */
void ScaleColors(LabelNames& names);

/** "#ff8000", from 0 to 255. */
std::optional<Vector3> ParseHexColor(const std::string& text);
}

#endif
