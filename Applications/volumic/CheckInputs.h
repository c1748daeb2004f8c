// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCheckInputs_h
#define volumicCheckInputs_h

#include <string>

namespace tool
{
// VTK's readers of these formats give what memory holds where a file has been cut off or damaged,
// or end the program. Hence these looks at a file before: all throw a Failure, without its name,
// with the bytes that are there and those that its header asks for.

/**
 * MetaImage (.mha, .mhd): the size of the data, and the checksum of packed ones. False where that
 * was not possible: packed data in several files.
 */
bool CheckMeta(const std::string& name);

/** NIfTI and Analyze: the type of the voxels, and the checksum of a packed file. */
void CheckNifti(const std::string& name);

/** MRC (.mrc, .ccp4): the size of the data. */
void CheckMrc(const std::string& name);

/** netCDF of the classic form, which MINC 1 is: the size of the data. Others are passed over. */
void CheckNetcdf(const std::string& name);

/** A polygon file (.ply): all elements that its head tells of are there. */
void CheckPly(const std::string& name);

/**
 * TIFF: all pages and their data lie within the file; PNG: the checksums. Others are passed over.
 */
void CheckPicture(const std::string& name);
}

#endif
