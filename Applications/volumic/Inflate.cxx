// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Inflate.h"

#include "ToolErrors.h"

#include <vtk_zlib.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <memory>
#include <type_traits>
#include <vector>

namespace tool
{
namespace
{
constexpr std::size_t Piece = 1 << 18; ///< bytes at a time

/** A z_stream that is freed. */
struct Inflater
{
  Inflater()
  {
    std::memset(&this->Stream, 0, sizeof(this->Stream));
    // 32: zlib or gzip, by its head; 15: the largest window
    if (inflateInit2(&this->Stream, 47) != Z_OK)
    {
      throw Failure("zlib cannot be used");
    }
  }
  ~Inflater() { inflateEnd(&this->Stream); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  z_stream Stream;
};

/** More to unpack, if there is any. */
void Refill(std::istream& packed, std::vector<char>& input, z_stream& stream)
{
  if (stream.avail_in == 0)
  {
    packed.read(input.data(), static_cast<std::streamsize>(input.size()));
    stream.next_in = reinterpret_cast<Bytef*>(input.data());
    stream.avail_in = static_cast<uInt>(packed.gcount());
  }
}

/** Whether a member of a gzip file begins here. */
bool IsMember(const z_stream& stream)
{
  return stream.avail_in > 0 && stream.next_in[0] == 0x1f &&
    (stream.avail_in == 1 || stream.next_in[1] == 0x8b);
}
}

UnpackedSink Without(std::uint64_t before, const UnpackedSink& sink)
{
  return [sink, before](const char* bytes, std::size_t count) mutable
  {
    const std::size_t skipped = static_cast<std::size_t>(std::min<std::uint64_t>(before, count));
    before -= skipped;
    sink(bytes + skipped, count - skipped);
  };
}

std::uint64_t Inflate(std::istream& packed, const UnpackedSink& sink, std::uint64_t most)
{
  Inflater inflater;
  z_stream& stream = inflater.Stream;
  std::vector<char> input(Piece);
  std::vector<char> output(Piece);
  std::uint64_t done = 0;
  bool isAtEnd = false;
  while (!isAtEnd)
  {
    Refill(packed, input, stream);
    if (stream.avail_in == 0)
    {
      throw Failure("the packed data are cut off: they give " + std::to_string(done) + " of " +
        std::to_string(most) + " bytes");
    }
    stream.next_out = reinterpret_cast<Bytef*>(output.data());
    stream.avail_out = static_cast<uInt>(output.size());
    const int status = inflate(&stream, Z_NO_FLUSH);
    const std::size_t got = output.size() - stream.avail_out;
    if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
    {
      throw Failure("the packed data are damaged: their checksum or code is wrong");
    }
    if (got > most - done)
    {
      throw Failure("the packed data give more than the " + std::to_string(most) +
        " bytes that the header tells of");
    }
    sink(output.data(), got);
    done += got;
    isAtEnd = status == Z_STREAM_END;
    if (isAtEnd)
    {
      // Several members, one behind the other, are one gzip file.
      Refill(packed, input, stream);
      isAtEnd = !IsMember(stream) || inflateReset(&stream) != Z_OK;
    }
  }
  return done;
}

void NeedUnpacked(std::uint64_t got, std::uint64_t needed)
{
  if (got < needed)
  {
    throw Failure("the packed data give " + std::to_string(got) + " bytes, " +
      std::to_string(needed) + " are needed");
  }
}

void InflateJust(std::istream& packed, const UnpackedSink& sink, std::uint64_t count)
{
  NeedUnpacked(Inflate(packed, sink, count), count);
}

bool IsGzip(const std::string& name)
{
  std::ifstream file(name, std::ios::binary);
  return file.get() == 0x1f && file.get() == 0x8b;
}

std::string HeadOf(const std::string& name, std::size_t count)
{
  std::string bytes(count, '\0');
  using Closing = int (*)(gzFile);
  const std::unique_ptr<std::remove_pointer_t<gzFile>, Closing> file(
    gzopen(name.c_str(), "rb"), gzclose);
  const int there =
    file ? gzread(file.get(), bytes.data(), static_cast<unsigned int>(count)) : 0;
  bytes.resize(static_cast<std::size_t>(std::max(there, 0)));
  return bytes;
}
}
