// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInputFiles_h
#define volumicInputFiles_h

#include <string>
#include <vector>

namespace tool
{
/**
 * All files that ReadVolume would read: those of a folder, of a pattern or of a DICOM series, and
 * those that a header (.mhd, .nhdr, .pvti, .hdr) names. What is missing or cannot be read is left
 * to ReadVolume.
 */
std::vector<std::string> FilesOfVolume(const std::string& name);

/** The files of a folder: the slices of DICOM alone, or, if there are none, all. */
std::vector<std::string> FilesOfFolder(const std::string& folder);

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
