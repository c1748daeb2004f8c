// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SlabReader.h"

#include "BinaryFile.h"
#include "CheckInputs.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "VolumeImage.h"
#include "VtkMessages.h"

#include <vtkDataArray.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <sstream>

namespace tool
{
namespace
{
using Element = vtkSmartPointer<vtkXMLDataElement>;

/** What the project says of its volume. */
struct Description
{
  int Type = VTK_SHORT;
  std::array<int, 3> Size = { 0, 0, 0 }; ///< voxels along x, y, z
  VolumePlacement Placement;
  std::string File = "matrix.dat";
  bool IsAxial = true; ///< the slices
};

std::string TextOf(vtkXMLDataElement* element)
{
  const char* text = element->GetCharacterData();
  return text ? text : "";
}

/** The value of a key of a dictionary, or null. */
vtkXMLDataElement* Find(vtkXMLDataElement* dictionary, const char* key)
{
  for (int i = 0; dictionary && i + 1 < dictionary->GetNumberOfNestedElements(); ++i)
  {
    vtkXMLDataElement* element = dictionary->GetNestedElement(i);
    if (std::strcmp(element->GetName(), "key") == 0 && TextOf(element) == key)
    {
      return dictionary->GetNestedElement(i + 1);
    }
  }
  return nullptr;
}

vtkXMLDataElement* Need(vtkXMLDataElement* dictionary, const char* key)
{
  vtkXMLDataElement* found = Find(dictionary, key);
  FailIf(!found, std::string("main.plist lacks '") + key + "'");
  return found;
}

/** The texts of an array of three. */
std::array<std::string, 3> ThreeOf(vtkXMLDataElement* array, const char* key)
{
  FailIf(array->GetNumberOfNestedElements() != 3,
    std::string("main.plist: '") + key + "' has not three numbers");
  return { TextOf(array->GetNestedElement(0)), TextOf(array->GetNestedElement(1)),
    TextOf(array->GetNestedElement(2)) };
}

int TypeOf(const std::string& name)
{
  static const std::map<std::string, int> types = { { "int8", VTK_SIGNED_CHAR },
    { "uint8", VTK_UNSIGNED_CHAR }, { "int16", VTK_SHORT }, { "uint16", VTK_UNSIGNED_SHORT },
    { "int32", VTK_INT }, { "uint32", VTK_UNSIGNED_INT }, { "int64", VTK_LONG_LONG },
    { "uint64", VTK_UNSIGNED_LONG_LONG }, { "float32", VTK_FLOAT }, { "float64", VTK_DOUBLE } };
  return EntryOf(types, name, "main.plist: voxels of type '" + name + "' are not read");
}

Description Describe(const std::string& plist)
{
  std::istringstream text(plist);
  CheckXmlInput(text);
  Element root;
  VtkMessages ignored; // What is wrong is said in one line below.
  ignored.Catch([&] { root.TakeReference(vtkXMLUtilities::ReadElementFromString(plist.c_str())); });
  vtkXMLDataElement* project =
    root && std::strcmp(root->GetName(), "plist") == 0 ? root->GetNestedElement(0) : nullptr;
  FailIf(!project, "main.plist cannot be parsed");
  Description description;
  vtkXMLDataElement* matrix = Need(project, "matrix");
  description.Type = TypeOf(TextOf(Need(matrix, "dtype")));
  if (vtkXMLDataElement* file = Find(matrix, "filename"))
  {
    const std::string path = TextOf(file);
    description.File = path.substr(path.find_last_of('/') + 1);
  }
  const std::array<std::string, 3> shape = ThreeOf(Need(matrix, "shape"), "shape");
  const std::array<std::string, 3> spacing = ThreeOf(Need(project, "spacing"), "spacing");
  for (int axis = 0; axis < 3; ++axis)
  {
    description.Size[axis] = ParseNumber<int>(shape[2 - axis]); // z, y, x
    description.Placement.Spacing[axis] = ParseNumber<double>(spacing[axis]);
  }
  FailIf(*std::min_element(description.Size.begin(), description.Size.end()) < 1,
    "main.plist: the sizes " + shape[0] + " x " + shape[1] + " x " + shape[2] +
      " are not those of a volume");
  if (vtkXMLDataElement* orientation = Find(project, "orientation"))
  {
    description.IsAxial = TextOf(orientation) == "1";
  }
  return description;
}

/** Go to the file of that name. */
void GoTo(Archive& archive, const std::string& name)
{
  while (archive.Next())
  {
    if (archive.Name() == name)
    {
      return;
    }
  }
  throw Failure("no " + name + " in it: not an InVesalius project");
}

/** The bytes of the member that the archive stands at, all of them, where its checksum is right. */
void ReadMember(Archive& archive, char* bytes)
{
  FailIf(archive.Read(bytes, archive.Size()) < archive.Size(), "the archive is cut off");
  archive.Finish();
}

Description ReadDescription(const std::string& name)
{
  Archive archive(Archive::Kind::Tar, Archive::TarIn(name));
  GoTo(archive, "main.plist");
  FailIf(
    archive.Size() > LargestText, "main.plist is too large to be the description of a project");
  std::string plist(archive.Size(), '\0');
  ReadMember(archive, plist.data());
  try
  {
    return Describe(plist);
  }
  catch (const UsageError& error)
  {
    throw Failure(std::string("main.plist: ") + error.what());
  }
}

/** The archive is packed, and would be unpacked from its begin for each part. */
class ProjectSlabs : public SlabReader
{
public:
  explicit ProjectSlabs(const std::string& name) : Name(name)
  {
    const Description description = ReadDescription(name);
    this->Size = description.Size;
    this->Type = description.Type;
    this->Placement = description.Placement;
    this->File = description.File;
    // The rows of axial slices are stored from back to front: a left-handed frame.
    this->WorldAxes = description.IsAxial ? "LAS" : "";
    this->HasParts = false;
  }

  vtkSmartPointer<vtkDataArray> Read(int, int count) override
  {
    auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(this->Type));
    const std::uint64_t expected = BytesOfVoxels(this->Type, 1, this->Size);
    Archive archive(Archive::Kind::Tar, Archive::TarIn(this->Name));
    GoTo(archive, this->File);
    if (archive.Size() != expected)
    {
      throw Failure(this->File + " has " + std::to_string(archive.Size()) +
        " bytes, the sizes in main.plist ask for " + std::to_string(expected));
    }
    NeedPackedBytes(BinaryFile(this->Name).Size(), MostOfZlib, expected);
    values->SetNumberOfTuples(static_cast<vtkIdType>(this->Size[0]) * this->Size[1] * count);
    ReadMember(archive, static_cast<char*>(values->GetVoidPointer(0)));
    ToNativeOrder(values, false);
    return values;
  }

private:
  std::string Name;
  std::string File; ///< in the archive
};
}

std::unique_ptr<SlabReader> OpenInv3(const std::string& name, const Opening&)
{
  return std::make_unique<ProjectSlabs>(name);
}
}
