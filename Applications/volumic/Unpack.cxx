// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Unpack.h"

#include "ToolErrors.h"

#include <vtk_zlib.h>
#ifdef VOLUMIC_HAS_BZIP2
#include <bzlib.h>
#endif

#include <algorithm>
#include <fstream>
#include <memory>
#include <type_traits>
#include <vector>

namespace tool
{
namespace
{
constexpr std::size_t Piece = 1 << 18; ///< bytes at a time

/** What a step of unpacking has come to. */
enum class Step
{
  UnderWay,
  AtEnd,
  Damaged
};

/** zlib; a file of gzip may have several members, each with this mark. */
struct ZlibUnpacker
{
  static constexpr unsigned char Mark[2] = { 0x1f, 0x8b };
  z_stream Stream = {};

  // 32: zlib or gzip, by its head; 15: the largest window
  bool Begin() { return inflateInit2(&this->Stream, 47) == Z_OK; }
  bool BeginAgain() { return inflateReset(&this->Stream) == Z_OK; }
  ~ZlibUnpacker() { inflateEnd(&this->Stream); }

  Step Go()
  {
    const int status = inflate(&this->Stream, Z_NO_FLUSH);
    return status == Z_STREAM_END               ? Step::AtEnd
      : status == Z_OK || status == Z_BUF_ERROR ? Step::UnderWay
                                                : Step::Damaged;
  }
};

#ifdef VOLUMIC_HAS_BZIP2
/** libbz2 likewise. */
struct Bzip2Unpacker
{
  static constexpr unsigned char Mark[2] = { 'B', 'Z' };
  bz_stream Stream = {};

  bool Begin() { return BZ2_bzDecompressInit(&this->Stream, 0, 0) == BZ_OK; }
  bool BeginAgain()
  {
    BZ2_bzDecompressEnd(&this->Stream);
    return this->Begin();
  }
  ~Bzip2Unpacker() { BZ2_bzDecompressEnd(&this->Stream); }

  Step Go()
  {
    const int status = BZ2_bzDecompress(&this->Stream);
    return status == BZ_STREAM_END ? Step::AtEnd
      : status == BZ_OK            ? Step::UnderWay
                                   : Step::Damaged;
  }
};
#endif

template <class Unpacker>
std::uint64_t Unpack(std::istream& packed, const UnpackedSink& sink, std::uint64_t most)
{
  Unpacker unpacker;
  auto& stream = unpacker.Stream;
  if (!unpacker.Begin())
  {
    throw Failure("what unpacks the data cannot be used");
  }
  std::vector<char> input(Piece);
  std::vector<char> output(Piece);
  const auto refill = [&]
  {
    if (stream.avail_in == 0)
    {
      packed.read(input.data(), static_cast<std::streamsize>(input.size()));
      stream.next_in = reinterpret_cast<decltype(stream.next_in)>(input.data());
      stream.avail_in = static_cast<unsigned int>(packed.gcount());
    }
    return stream.avail_in > 0;
  };
  const auto hasMore = [&]
  {
    const bool isThere = refill();
    const auto* next = reinterpret_cast<const unsigned char*>(stream.next_in);
    return isThere && next[0] == Unpacker::Mark[0] &&
      (stream.avail_in == 1 || next[1] == Unpacker::Mark[1]);
  };
  std::uint64_t done = 0;
  for (bool isAtEnd = false; !isAtEnd;)
  {
    const bool isThere = refill();
    stream.next_out = reinterpret_cast<decltype(stream.next_out)>(output.data());
    stream.avail_out = static_cast<unsigned int>(output.size());
    const Step step = unpacker.Go();
    const std::size_t got = output.size() - stream.avail_out;
    if (step == Step::Damaged)
    {
      throw Failure("the packed data are damaged: their checksum or code is wrong");
    }
    if (got > most - done)
    {
      throw Failure("the packed data give more than the " + std::to_string(most) +
        " bytes that the header tells of");
    }
    if (step == Step::UnderWay && got == 0 && !isThere)
    {
      throw Failure("the packed data are cut off: they give " + std::to_string(done) + " of " +
        std::to_string(most) + " bytes");
    }
    sink(output.data(), got);
    done += got;
    isAtEnd = step == Step::AtEnd && !(hasMore() && unpacker.BeginAgain());
  }
  return done;
}

/** @throws Failure unless packed data gave as many bytes as are needed. */
void NeedUnpacked(std::uint64_t got, std::uint64_t needed)
{
  if (got < needed)
  {
    throw Failure("the packed data give " + std::to_string(got) + " bytes, " +
      std::to_string(needed) + " are needed");
  }
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
  return Unpack<ZlibUnpacker>(packed, sink, most);
}

void InflateJust(std::istream& packed, const UnpackedSink& sink, std::uint64_t count)
{
  NeedUnpacked(Inflate(packed, sink, count), count);
}

#ifdef VOLUMIC_HAS_BZIP2
void BunzipJust(std::istream& packed, const UnpackedSink& sink, std::uint64_t count)
{
  NeedUnpacked(Unpack<Bzip2Unpacker>(packed, sink, count), count);
}
#else
void BunzipJust(std::istream&, const UnpackedSink&, std::uint64_t)
{
  throw Failure("the encoding bzip2 is not read: this program was built without libbz2");
}
#endif

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
