// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicBunzip_h
#define volumicBunzip_h

#include <cstddef>
#include <string>

namespace tool
{
/**
 * What bzip2 data unpack to, which must be `count` bytes; several streams, one behind the other,
 * are one. @throws Failure, without a name, if they are damaged, cut off or of another size, or if
 * the program was built without libbz2.
 */
std::string Bunzip(const std::string& packed, std::size_t count);
}

#endif
