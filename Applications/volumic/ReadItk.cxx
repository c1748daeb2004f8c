// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What VTK has no reader for, by ITK's: it is read as a whole. A reader gives what memory holds
// where a file has been cut off or tells of nonsense, so sizes are checked here, once for all.
#include "SlabReader.h"

#include "Texts.h"

#include <vtkDataArray.h>

#include <itkGiplImageIO.h>
#include <itkMINCImageIO.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <limits>
#include <map>
#include <sstream>

namespace tool
{
namespace
{
int TypeOf(itk::ImageIOBase* reader)
{
  using Kind = itk::ImageIOBase::IOComponentType;
  static const std::map<Kind, int> types = { { Kind::UCHAR, VTK_UNSIGNED_CHAR },
    { Kind::CHAR, VTK_SIGNED_CHAR }, { Kind::USHORT, VTK_UNSIGNED_SHORT },
    { Kind::SHORT, VTK_SHORT }, { Kind::UINT, VTK_UNSIGNED_INT }, { Kind::INT, VTK_INT },
    { Kind::FLOAT, VTK_FLOAT }, { Kind::DOUBLE, VTK_DOUBLE } };
  return EntryOf(types, reader->GetComponentType(), "its voxels are no numbers that are read");
}

/** What ITK says meanwhile, which libraries within it print, is dropped; what it throws is told. */
template <class Work>
void Ask(const Work& work)
{
  std::ostringstream dropped;
  const std::unique_ptr<std::streambuf, void (*)(std::streambuf*)> printed(
    std::cerr.rdbuf(dropped.rdbuf()), [](std::streambuf* output) { std::cerr.rdbuf(output); });
  try
  {
    work();
  }
  catch (const itk::ExceptionObject& error)
  {
    throw Failure("cannot be read (" + Trimmed(error.GetDescription()) + ")");
  }
}

class ItkVolume : public SlabReader
{
public:
  /** @param header bytes before the voxels, of formats that are nothing else; 0: others */
  ItkVolume(const std::string& name, itk::ImageIOBase* reader, std::uint64_t header)
    : Reader(reader)
  {
    reader->SetFileName(name);
    Ask([reader] { reader->ReadImageInformation(); });
    const unsigned int axes = reader->GetNumberOfDimensions();
    FailIf(axes < 2 || axes > 3, std::to_string(axes) + " axes; a volume has three");
    std::array<Vector3, 3> steps = { { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
    this->Size = { 1, 1, 1 };
    for (unsigned int axis = 0; axis < axes; ++axis)
    {
      const auto size = reader->GetDimensions(axis);
      FailIf(size < 1 || size > std::numeric_limits<int>::max(),
        "its header is damaged: " + std::to_string(size) + " voxels along axis " +
          std::to_string(axis + 1));
      this->Size[axis] = static_cast<int>(size);
      this->Placement.Origin[axis] = reader->GetOrigin(axis);
      const std::vector<double> direction = reader->GetDirection(axis);
      for (unsigned int c = 0; c < axes; ++c)
      {
        steps[axis][c] = direction[c] * reader->GetSpacing(axis);
      }
    }
    this->Placement.SetSteps(steps);
    this->Type = TypeOf(reader);
    this->Components = static_cast<int>(reader->GetNumberOfComponents());
    this->HasParts = false;
    const std::uint64_t needed = BytesOfVoxels(this->Type, this->Components, this->Size);
    const std::uint64_t there = std::filesystem::file_size(name);
    FailIf(needed == 0, "its header is damaged: it has no voxels");
    if (header > 0 && !IsGzip(name))
    {
      NeedJustBytes(there - std::min(there, header), needed);
    }
    else
    {
      NeedPackedBytes(there, MostOfZlib, needed);
    }
    if (IsGzip(name)) // to its end, where the checksum stands
    {
      std::ifstream packed(name, std::ios::binary);
      InflateJust(packed, Nowhere, MostUnpacked(needed, header));
    }
  }

  vtkSmartPointer<vtkDataArray> Read(int, int) override
  {
    auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(this->Type));
    values->SetNumberOfComponents(this->Components);
    values->SetNumberOfTuples(
      static_cast<vtkIdType>(this->Size[0]) * this->Size[1] * this->Size[2]);
    itk::ImageIORegion region(this->Reader->GetNumberOfDimensions());
    for (unsigned int axis = 0; axis < this->Reader->GetNumberOfDimensions(); ++axis)
    {
      region.SetSize(axis, this->Reader->GetDimensions(axis));
    }
    this->Reader->SetIORegion(region);
    Ask([&] { this->Reader->Read(values->GetVoidPointer(0)); });
    return values;
  }

private:
  itk::ImageIOBase::Pointer Reader;
};
}

std::unique_ptr<SlabReader> OpenGipl(const std::string& name, const Opening&)
{
  return std::make_unique<ItkVolume>(name, itk::GiplImageIO::New(), 256);
}

std::unique_ptr<SlabReader> OpenMinc2(const std::string& name, const Opening&)
{
  return std::make_unique<ItkVolume>(name, itk::MINCImageIO::New(), 0);
}
}
