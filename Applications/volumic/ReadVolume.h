// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicReadVolume_h
#define volumicReadVolume_h

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkImageData;

namespace tool
{
/**
 * Read a volume: a file of one of the formats of volumic(1), a folder (of the slices of a DICOM
 * series, or of pictures), or a pattern of pictures. World coordinates are those of the file, in
 * its units; rescaled values (NIfTI, DICOM, MINC) are the physical ones.
 * @throws Failure that names the file and the reason.
 */
vtkSmartPointer<vtkImageData> ReadVolume(const std::string& name);

/**
 * Make the array (empty: the active scalars, or the only one) the active scalars.
 * @throws Failure if there is none.
 */
void ChooseScalars(vtkImageData* image, const std::string& array);

// ---- The parts, each in its file ----------------------------------------------------------------

/** NRRD (.nrrd, .nhdr; encodings raw, gzip, bzip2, text), in the file's `space`. */
vtkSmartPointer<vtkImageData> ReadNrrd(const std::string& name);

/**
 * The volume of an InVesalius project (.inv3), unit mm, its axes as they are stored: the world axes
 * are L, A, S.
 */
vtkSmartPointer<vtkImageData> ReadInv3(const std::string& name);

/** The slices of one series, in DICOM's patient coordinates (LPS, mm), sorted by position. */
vtkSmartPointer<vtkImageData> ReadDicom(const std::vector<std::string>& files);

bool IsDicom(const std::string& file);

/** Pictures of one size as the slices of a volume of spacing 1, in this order. */
vtkSmartPointer<vtkImageData> ReadPictures(const std::vector<std::string>& files);

/**
 * Existing files that match a pattern: '*' in the name stands for any text, '%d' (or '%03d') for
 * a number. Sorted as people count: slice9 before slice10.
 */
std::vector<std::string> MatchFiles(const std::string& pattern);

/** All regular files of the folder, sorted likewise. */
std::vector<std::string> FilesOf(const std::string& folder);
}

#endif
