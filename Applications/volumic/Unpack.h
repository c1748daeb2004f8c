// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicUnpack_h
#define volumicUnpack_h

#include <cstddef>
#include <cstdint>
#include <functional>
#include <istream>
#include <string>

namespace tool
{
/** Takes unpacked bytes, in their order. */
using UnpackedSink = std::function<void(const char* bytes, std::size_t count)>;

/** Lets them go: only the checksum is wanted. */
inline const UnpackedSink Nowhere = [](const char*, std::size_t) {};

/** Hands them on without so many at the begin. */
UnpackedSink Without(std::uint64_t before, const UnpackedSink& sink);

/**
 * Unpack zlib or gzip data to their end, which alone tells whether they are what was packed: the
 * checksum stands there. Several members, one behind the other, are one file.
 * @return how many bytes there were
 * @throws Failure, without a name, if they are damaged or cut off, or as soon as they give more.
 */
std::uint64_t Inflate(std::istream& packed, const UnpackedSink& sink, std::uint64_t most);

/** The same of data that must give just so many bytes. @throws Failure if they don't. */
void InflateJust(std::istream& packed, const UnpackedSink& sink, std::uint64_t count);

/** Likewise of bzip2. */
void BunzipJust(std::istream& packed, const UnpackedSink& sink, std::uint64_t count);

/** Whether a file begins as those of gzip do. */
bool IsGzip(const std::string& name);

/**
 * The first bytes that a gzip file unpacks to, or those of a file that is not packed; `count` at
 * most. What follows them is not looked at.
 */
std::string HeadOf(const std::string& name, std::size_t count);
}

#endif
