// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCheckWritten_h
#define volumicCheckWritten_h

#include <cstdint>
#include <string>

namespace tool
{
// Most of VTK's writers don't look whether the disk took what they wrote. All throw a Failure,
// without the name of the file, if something is missing.

/** The file has this many bytes. */
void CheckSize(const std::string& path, std::uint64_t bytes);

/** The file ends with a complete line, and has no fewer than this many. */
void CheckLines(const std::string& path, std::uint64_t lines);

/** The file, or each one of a folder, ends as VTK's XML files do. */
void CheckXml(const std::string& path);
}

#endif
