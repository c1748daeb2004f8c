// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Bunzip.h"

#include "ToolErrors.h"

#ifdef VOLUMIC_HAS_BZIP2
#include <bzlib.h>
#include <string>
#include <vector>
#endif

namespace tool
{
#ifdef VOLUMIC_HAS_BZIP2
namespace
{
constexpr std::size_t Piece = 1 << 18; ///< bytes at a time

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

/** Unpack one stream, of whose packed bytes some may be left. @return how many bytes it gave. */
std::uint64_t BunzipStream(
  std::istream& packed, std::string& left, const UnpackedSink& sink, std::uint64_t most)
{
  Bunzipper bunzipper;
  bz_stream& stream = bunzipper.Stream;
  std::vector<char> output(Piece);
  std::uint64_t done = 0;
  for (int status = BZ_OK; status != BZ_STREAM_END;)
  {
    if (left.empty())
    {
      left.resize(Piece);
      packed.read(left.data(), static_cast<std::streamsize>(left.size()));
      left.resize(static_cast<std::size_t>(packed.gcount()));
    }
    stream.next_in = left.data();
    stream.avail_in = static_cast<unsigned int>(left.size());
    stream.next_out = output.data();
    stream.avail_out = static_cast<unsigned int>(output.size());
    status = BZ2_bzDecompress(&stream);
    const std::size_t got = output.size() - stream.avail_out;
    if (status != BZ_OK && status != BZ_STREAM_END)
    {
      throw Failure("the packed data are damaged");
    }
    if (got > most - done)
    {
      throw Failure("the packed data give more than the " + std::to_string(most) +
        " bytes that the header tells of");
    }
    if (status == BZ_OK && left.empty() && got == 0)
    {
      throw Failure("the packed data are cut off: they give " + std::to_string(done) + " of " +
        std::to_string(most) + " bytes, without their end");
    }
    sink(output.data(), got);
    done += got;
    left.erase(0, left.size() - stream.avail_in);
  }
  return done;
}
}

void BunzipJust(std::istream& packed, const UnpackedSink& sink, std::uint64_t count)
{
  std::string left;
  std::uint64_t done = 0;
  do
  {
    done += BunzipStream(packed, left, sink, count - done);
  } while (done < count);
}
#else
void BunzipJust(std::istream&, const UnpackedSink&, std::uint64_t)
{
  throw Failure("the encoding bzip2 is not read: this program was built without libbz2");
}
#endif
}
