// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SlabReader.h"

#include "Texts.h"

#include <vtkDataArray.h>
#include <vtkFloatArray.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <limits>
#include <optional>

#include <fcntl.h>
#include <unistd.h>

namespace tool
{
namespace
{
std::string DirectoryOf(const std::string& directory)
{
  const char* system = std::getenv("TMPDIR");
  return !directory.empty() ? directory : system && *system ? system : "/var/tmp";
}

/** The number of a new file, which has no name any more; -1 if there can be none. */
int OpenNameless(const std::string& directory)
{
  std::string name = directory + "/volumic-XXXXXX";
  const int number = mkostemp(name.data(), O_CLOEXEC);
  if (number >= 0)
  {
    unlink(name.c_str());
  }
  return number;
}

/** The bytes of a data file. @throws Failure that names it if it cannot be opened. */
std::uint64_t SizeOfData(const std::string& name)
{
  try
  {
    return BinaryFile(name).Size();
  }
  catch (const Failure&)
  {
    throw Failure("its data file " + name + " cannot be opened");
  }
}

/** @throws Failure unless the text has just as many numbers as are wanted. */
void ReadNumbers(std::istream& text, vtkDataArray* values)
{
  const int components = values->GetNumberOfComponents();
  const vtkIdType wanted = values->GetNumberOfValues();
  constexpr int longest = 512; // No number is as long, and nothing longer is kept.
  vtkIdType there = 0;
  for (std::string word; there <= wanted && text >> std::setw(longest) >> word; ++there)
  {
    const std::optional<double> number = AsNumber<double>(word);
    if (!number || word.size() == longest)
    {
      throw Failure(
        "the file is damaged: its value " + std::to_string(there + 1) + " is no number");
    }
    if (there < wanted)
    {
      values->SetComponent(there / components, static_cast<int>(there % components), *number);
    }
  }
  FailIf(there != wanted,
    (there < wanted ? "the file is cut off" : "the file is too long") + std::string(": it has ") +
      std::to_string(there) + (there > wanted ? " or more" : "") + " values, its header asks for " +
      std::to_string(wanted));
}
}

NamelessFile::NamelessFile(const std::string& directory)
  : NamelessFile(DirectoryOf(directory), OpenNameless(DirectoryOf(directory)))
{
}

NamelessFile::NamelessFile(const std::string& directory, int number)
  : Directory(directory), Link("/proc/self/fd/" + std::to_string(number)), File(number)
{
  if (number < 0)
  {
    throw Failure("no file can be made in " + this->Directory + " to unpack the voxels to (" +
      SystemReason() + "); choose another folder with --scratch");
  }
}

void NamelessFile::Append(const char* bytes, std::size_t count)
{
  if (!this->File.Write(bytes, count))
  {
    throw Failure("the voxels cannot be unpacked to " + this->Directory + " (" + SystemReason() +
      "); choose another folder with --scratch");
  }
}

std::ifstream OpenData(const std::string& name, std::uint64_t start)
{
  std::ifstream stream(name, std::ios::binary);
  FailIf(!stream.seekg(static_cast<std::streamoff>(start)),
    "its data file " + name + " cannot be opened");
  return stream;
}

std::uint64_t RawSlabs::Bytes() const
{
  return BytesOfVoxels(this->Type, this->Components, this->Size);
}

std::uint64_t RawSlabs::StartIn(const std::string& file) const
{
  const std::uint64_t share = this->Share();
  return this->AreLast ? SizeOfData(file) - std::min(SizeOfData(file), share) : this->Start;
}

void RawSlabs::CheckLength(const std::string& file) const
{
  const std::uint64_t all = SizeOfData(file);
  const std::uint64_t there = all - std::min(all, this->StartIn(file));
  if (this->Code != Packing::None)
  {
    const std::uint64_t most = this->Code == Packing::Zlib ? MostOfZlib
      : this->Code == Packing::Bzip2                       ? MostOfBzip2
                                                           : 8; // numbers of a digit, as doubles
    NeedPackedBytes(there, most, this->Share());
  }
  else if (this->Files.size() > 1 && there != this->Share())
  {
    throw Failure("its data file " + file + " is " +
      (there < this->Share() ? "cut off" : "too long") + ": it has " + std::to_string(all) +
      " bytes, " + std::to_string(all - there + this->Share()) + " are needed");
  }
  else
  {
    const std::uint64_t needed = this->Share() + this->After;
    (this->HasMore ? NeedBytes : NeedJustBytes)(there, needed);
  }
}

void RawSlabs::PickTime(const VolumeChoice& choice, std::uint64_t times)
{
  const auto time = static_cast<std::uint64_t>(TimeOf(choice, times));
  FailIf(times > 1 &&
      (this->Files.size() > 1 || this->AreLast || this->Code == Packing::Text ||
        this->Code == Packing::Bzip2),
    "of several volumes in several files, or packed so, none can be chosen");
  const std::uint64_t before = Times(time, this->Bytes());
  (this->Code == Packing::None ? this->Start : this->Before) += before;
  // All of them must be there.
  this->After = Times(times, this->Bytes()) - before - this->Bytes();
}

void RawSlabs::Prepare(const Opening& opening)
{
  FailIf(this->Components < 1 || this->Bytes() == 0 || this->Bytes() % this->Files.size() != 0,
    "its header is damaged: its voxels are none, or not as many in each file");
  FailIf(this->Code == Packing::Text && this->Files.size() > 1,
    "voxels as text in several files are not read");
  std::for_each(this->Files.begin(), this->Files.end(),
    [this](const std::string& file) { this->CheckLength(file); });
  this->HasParts = this->Code != Packing::Text;
  if (this->Code == Packing::None || opening.IsWhole || !this->HasParts)
  {
    return;
  }
  this->Unpacked = std::make_unique<NamelessFile>(opening.Scratch);
  this->Unpack(
    [this](const char* bytes, std::size_t count) { this->Unpacked->Append(bytes, count); });
  this->Files = { this->Unpacked->Path() };
  this->Code = Packing::None;
  this->Start = 0;
  this->After = 0;
}

void RawSlabs::Unpack(const UnpackedSink& sink) const
{
  for (const std::string& file : this->Files)
  {
    std::ifstream packed = OpenData(file, this->Start);
    std::uint64_t left = this->Share();
    const UnpackedSink some = [&left, &sink](const char* bytes, std::size_t count)
    {
      const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(left, count));
      sink(bytes, wanted);
      left -= wanted;
    };
    const std::uint64_t count = MostUnpacked(this->Share(), this->Before) + this->After;
    if (this->HasMore)
    {
      Inflate(packed, Without(this->Before, some), Times(MostOfZlib, SizeOfData(file)));
      NeedBytes(this->Share() - left, this->Share());
    }
    else
    {
      (this->Code == Packing::Zlib ? InflateJust : BunzipJust)(
        packed, Without(this->Before, some), count);
    }
  }
}

void RawSlabs::ReadBytes(std::uint64_t first, std::uint64_t count, char* values) const
{
  const std::uint64_t share = this->Share();
  for (const std::uint64_t end = first + count; first < end;)
  {
    const std::string& file = this->Files[static_cast<std::size_t>(first / share)];
    const std::uint64_t within = first % share;
    const std::uint64_t piece = std::min(end - first, share - within);
    FailIf(!OpenData(file, this->StartIn(file) + within)
              .read(values, static_cast<std::streamsize>(piece)),
      "its voxels cannot be read: the file is cut off, or its disk fails");
    values += piece;
    first += piece;
  }
}

vtkSmartPointer<vtkDataArray> RawSlabs::Read(int first, int count)
{
  auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(this->Type));
  values->SetNumberOfComponents(this->Components);
  values->SetNumberOfTuples(static_cast<vtkIdType>(this->Size[0]) * this->Size[1] * count);
  char* bytes = static_cast<char*>(values->GetVoidPointer(0));
  if (this->Code == Packing::Text)
  {
    std::ifstream text = OpenData(this->Files.front(), this->Start);
    ReadNumbers(text, values);
    return values;
  }
  if (this->Code == Packing::None)
  {
    const std::uint64_t slice = this->Bytes() / static_cast<std::uint64_t>(this->Size[2]);
    this->ReadBytes(
      slice * static_cast<std::uint64_t>(first), slice * static_cast<std::uint64_t>(count), bytes);
  }
  else
  {
    char* next = bytes; // goes on from file to file
    this->Unpack(
      [&next](const char* got, std::size_t size) { next = std::copy_n(got, size, next); });
  }
  ToNativeOrder(values, this->IsBig);
  return values;
}

// ---- Halves of floats ---------------------------------------------------------------------------

namespace
{
/** Of all halves, by their bits (IEEE 754, binary16). */
std::vector<float> MakeFloats()
{
  std::vector<float> floats;
  for (int bits = 0; bits <= 0xFFFF; ++bits)
  {
    const int exponent = bits >> 10 & 31;
    const int fraction = bits & 1023;
    float value = static_cast<float>(std::ldexp(fraction, -24));
    if (exponent == 31)
    {
      value = fraction == 0 ? std::numeric_limits<float>::infinity()
                            : std::numeric_limits<float>::quiet_NaN();
    }
    else if (exponent > 0)
    {
      value = static_cast<float>(std::ldexp(fraction + 1024, exponent - 25));
    }
    floats.push_back(bits > 0x7FFF ? -value : value);
  }
  return floats;
}

class HalfSlabs : public SlabReader
{
public:
  explicit HalfSlabs(std::unique_ptr<SlabReader> halves) : Halves(std::move(halves))
  {
    static_cast<SlabReader&>(*this) = *this->Halves;
    this->Type = VTK_FLOAT;
  }

  vtkSmartPointer<vtkDataArray> Read(int first, int count) override
  {
    static const std::vector<float> floats = MakeFloats();
    const vtkSmartPointer<vtkDataArray> halves = this->Halves->Read(first, count);
    const auto* bits = static_cast<const unsigned short*>(halves->GetVoidPointer(0));
    const auto values = vtkSmartPointer<vtkFloatArray>::New();
    values->SetName(halves->GetName());
    values->SetNumberOfComponents(this->Components);
    values->SetNumberOfTuples(halves->GetNumberOfTuples());
    std::transform(bits, bits + halves->GetNumberOfValues(), values->GetPointer(0),
      [](unsigned short each) { return floats[each]; });
    return values;
  }

private:
  std::unique_ptr<SlabReader> Halves;
};
}

std::unique_ptr<SlabReader> AsFloats(std::unique_ptr<SlabReader> volume, bool areHalves)
{
  return areHalves ? std::make_unique<HalfSlabs>(std::move(volume)) : std::move(volume);
}
}
