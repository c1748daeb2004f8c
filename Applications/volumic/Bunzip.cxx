// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Bunzip.h"

#include "ToolErrors.h"

#ifdef VOLUMIC_HAS_BZIP2
#include <algorithm>
#include <bzlib.h>
#endif

namespace tool
{
#ifdef VOLUMIC_HAS_BZIP2
namespace
{
/** A bz_stream that is freed. */
struct Bunzipper
{
  Bunzipper()
  {
    if (BZ2_bzDecompressInit(&this->Stream, 0, 0) != BZ_OK)
    {
      throw Failure("libbz2 cannot be used");
    }
  }
  ~Bunzipper() { BZ2_bzDecompressEnd(&this->Stream); }
  Bunzipper(const Bunzipper&) = delete;
  Bunzipper& operator=(const Bunzipper&) = delete;

  bz_stream Stream = {};
};

/** Unpack one stream: `taken` and `given` grow by its bytes. */
void BunzipStream(
  const std::string& packed, std::size_t& taken, std::string& unpacked, std::size_t& given)
{
  Bunzipper bunzipper;
  bz_stream& stream = bunzipper.Stream;
  for (int status = BZ_OK; status != BZ_STREAM_END;)
  {
    // Pieces, since the stream counts in unsigned int.
    const std::size_t piece = 1U << 30;
    const std::size_t in = std::min(packed.size() - taken, piece);
    const std::size_t out = std::min(unpacked.size() - given, piece);
    stream.next_in = const_cast<char*>(packed.data()) + taken;
    stream.avail_in = static_cast<unsigned int>(in);
    stream.next_out = unpacked.data() + given;
    stream.avail_out = static_cast<unsigned int>(out);
    status = BZ2_bzDecompress(&stream);
    const bool isStuck = stream.avail_in == in && stream.avail_out == out;
    taken += in - stream.avail_in;
    given += out - stream.avail_out;
    if (status == BZ_OK && isStuck)
    {
      throw Failure(taken == packed.size()
          ? "the packed data are cut off: they give " + std::to_string(given) + " of " +
            std::to_string(unpacked.size()) + " bytes, without their end"
          : "the packed data give more than the " + std::to_string(given) +
            " bytes that the header tells of");
    }
    if (status != BZ_OK && status != BZ_STREAM_END)
    {
      throw Failure("the packed data are damaged");
    }
  }
}
}

std::string Bunzip(const std::string& packed, std::size_t count)
{
  std::string unpacked(count, '\0');
  std::size_t taken = 0;
  std::size_t given = 0;
  do
  {
    BunzipStream(packed, taken, unpacked, given);
  } while (given < count);
  return unpacked;
}
#else
std::string Bunzip(const std::string&, std::size_t)
{
  throw Failure("the encoding bzip2 is not read: this program was built without libbz2");
}
#endif
}
