// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInflate_h
#define volumicInflate_h

#include <cstddef>
#include <cstdint>
#include <functional>
#include <istream>
#include <limits>
#include <string>

namespace tool
{
/**
 * Unpack zlib or gzip data to their end, which alone tells whether they are what was packed: the
 * checksum stands there. The data must give `count` bytes; they go to `bytes`, or nowhere if that
 * is null. @throws Failure, without a name, if they are damaged, cut off or of another size.
 */
void Inflate(std::istream& packed, std::uint64_t count, char* bytes);

/** Takes unpacked bytes, in their order. */
using UnpackedSink = std::function<void(const char* bytes, std::size_t count)>;

/** The same, to where the sink puts them; by default as many as there are. @return how many. */
std::uint64_t Inflate(std::istream& packed, const UnpackedSink& sink,
  std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

/**
 * The first bytes that a gzip file unpacks to, or those of a file that is not packed; `count` at
 * most. The checksum of a packed file is looked at. @throws Failure if it is damaged or cut off.
 * @param total given how many bytes there are
 */
std::string GzipHead(const std::string& name, std::size_t count, std::uint64_t& total);
}

#endif
