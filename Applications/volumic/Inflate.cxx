// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Inflate.h"

#include "BinaryFile.h"
#include "ToolErrors.h"

#include <vtk_zlib.h>

#include <algorithm>
#include <cstring>
#include <fstream>
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
bool IsGzip(const z_stream& stream)
{
  return stream.avail_in > 0 && stream.next_in[0] == 0x1f &&
    (stream.avail_in == 1 || stream.next_in[1] == 0x8b);
}
}

std::uint64_t Inflate(std::istream& packed, const UnpackedSink& sink, std::uint64_t most)
{
  Inflater inflater;
  z_stream& stream = inflater.Stream;
  std::vector<char> input(Piece);
  std::vector<char> output(Piece);
  std::uint64_t done = 0;
  const bool isAny = most == std::numeric_limits<std::uint64_t>::max();
  bool isAtEnd = false;
  while (!isAtEnd)
  {
    Refill(packed, input, stream);
    if (stream.avail_in == 0)
    {
      throw Failure("the packed data are cut off: they give " + std::to_string(done) +
        (isAny ? "" : " of " + std::to_string(most)) + " bytes");
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
    if (isAtEnd && done < most)
    {
      // Several members, one behind the other, are one gzip file.
      Refill(packed, input, stream);
      const bool isMember = isAny ? IsGzip(stream) : stream.avail_in > 0;
      isAtEnd = !isMember || inflateReset(&stream) != Z_OK;
    }
  }
  return done;
}

void Inflate(std::istream& packed, std::uint64_t count, char* bytes)
{
  char* to = bytes;
  const std::uint64_t done = Inflate(
    packed,
    [&to](const char* unpacked, std::size_t got)
    { to = to ? std::copy_n(unpacked, got, to) : nullptr; },
    count);
  if (done < count)
  {
    throw Failure("the packed data give " + std::to_string(done) + " bytes, " +
      std::to_string(count) + " are needed");
  }
}

// Not by gzread, which takes a file that was cut off for a whole one in zlib 1.3.2.
std::string GzipHead(const std::string& name, std::size_t count, std::uint64_t& total)
{
  std::ifstream packed(name, std::ios::binary);
  if (!packed)
  {
    throw Failure("cannot be opened");
  }
  std::vector<char> input(Piece);
  std::vector<char> output(Piece);
  Inflater inflater;
  z_stream& stream = inflater.Stream;
  Refill(packed, input, stream);
  if (!IsGzip(stream))
  {
    total = BinaryFile(name).Size();
    return std::string(input.data(), std::min<std::size_t>(stream.avail_in, count));
  }
  std::string head;
  total = 0;
  int status = Z_OK;
  while (status != Z_STREAM_END)
  {
    Refill(packed, input, stream);
    stream.next_out = reinterpret_cast<Bytef*>(output.data());
    stream.avail_out = static_cast<uInt>(output.size());
    status = stream.avail_in == 0 ? Z_BUF_ERROR : inflate(&stream, Z_NO_FLUSH);
    if (status != Z_OK && status != Z_STREAM_END)
    {
      throw Failure("the packed data are damaged or cut off");
    }
    const std::size_t got = output.size() - stream.avail_out;
    head.append(output.data(), std::min(got, count - head.size()));
    total += got;
    if (status == Z_STREAM_END)
    {
      Refill(packed, input, stream);
      status = IsGzip(stream) ? inflateReset(&stream) : Z_STREAM_END; // another member, or none
    }
  }
  return head;
}
}
