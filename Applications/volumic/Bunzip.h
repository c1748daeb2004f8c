// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicBunzip_h
#define volumicBunzip_h

#include "Inflate.h"

namespace tool
{
/**
 * Unpack bzip2 data, which must give just so many bytes; several streams, one behind the other, are
 * one. @throws Failure, without a name, if they are damaged, cut off or of another size, or if the
 * program was built without libbz2.
 */
void BunzipJust(std::istream& packed, const UnpackedSink& sink, std::uint64_t count);
}

#endif
