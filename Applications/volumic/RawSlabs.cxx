// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RawSlabs.h"

#include "BinaryFile.h"
#include "ByteBudget.h"
#include "Inflate.h"
#include "ToolErrors.h"
#include "VolumeImage.h"

#include <vtkDataArray.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

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
}

NamelessFile::NamelessFile(const std::string& directory) : Directory(DirectoryOf(directory))
{
  std::string name = this->Directory + "/volumic-XXXXXX";
  this->Descriptor = mkstemp(name.data());
  if (this->Descriptor < 0)
  {
    throw Failure("no file can be made in " + this->Directory + " to unpack the voxels to (" +
      std::strerror(errno) + "); choose another folder with --scratch");
  }
  unlink(name.c_str());
}

NamelessFile::~NamelessFile()
{
  close(this->Descriptor);
}

void NamelessFile::Append(const char* bytes, std::size_t count)
{
  while (count > 0)
  {
    const ssize_t done = write(this->Descriptor, bytes, count);
    if (done < 0 && errno == EINTR)
    {
      continue;
    }
    if (done <= 0)
    {
      throw Failure("the voxels cannot be unpacked to " + this->Directory + " (" +
        std::strerror(errno) + "); choose another folder with --scratch");
    }
    bytes += done;
    count -= static_cast<std::size_t>(done);
  }
}

std::string NamelessFile::Path() const
{
  return "/proc/self/fd/" + std::to_string(this->Descriptor);
}

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

std::unique_ptr<NamelessFile> Unpack(const std::string& name, std::uint64_t start,
  const std::string& directory, std::uint64_t count)
{
  std::ifstream packed(name, std::ios::binary);
  if (!packed || !packed.seekg(static_cast<std::streamoff>(start)))
  {
    throw Failure("its data file " + name + " cannot be opened");
  }
  NeedPackedBytes(SizeOfData(name), MostOfZlib, count);
  auto file = std::make_unique<NamelessFile>(directory);
  InflateJust(
    packed, [&](const char* bytes, std::size_t got) { file->Append(bytes, got); }, count);
  return file;
}

std::uint64_t RawSlabs::Bytes() const
{
  return BytesOfVoxels(this->Type, this->Components, this->Size);
}

vtkSmartPointer<vtkDataArray> RawSlabs::Read(int first, int count)
{
  auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(this->Type));
  values->SetNumberOfComponents(this->Components);
  values->SetNumberOfTuples(static_cast<vtkIdType>(this->Size[0]) * this->Size[1] * count);
  if (!this->Stream.is_open())
  {
    this->Stream.open(this->File, std::ios::binary);
  }
  const std::uint64_t slice = this->Bytes() / static_cast<std::uint64_t>(this->Size[2]);
  const auto start = static_cast<std::streamoff>(
    this->Start + slice * static_cast<std::uint64_t>(first));
  const auto bytes =
    static_cast<std::streamsize>(slice * static_cast<std::uint64_t>(count));
  if (!this->Stream.seekg(start) ||
    !this->Stream.read(static_cast<char*>(values->GetVoidPointer(0)), bytes))
  {
    throw Failure("the slices " + std::to_string(first) + " to " +
      std::to_string(first + count - 1) +
      " cannot be read: the file is cut off, or its disk fails");
  }
  ToNativeOrder(values, this->IsBig);
  return values;
}
}
