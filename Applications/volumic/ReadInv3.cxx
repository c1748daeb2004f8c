// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SlabReader.h"

#include "CheckInputs.h"
#include "Messages.h"
#include "Texts.h"

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

/** The archive is packed, and would be unpacked from its begin for each part. */
class ProjectSlabs : public SlabReader
{
public:
  explicit ProjectSlabs(const std::string& name);

  vtkSmartPointer<vtkDataArray> Read(int, int count) override;

private:
  /** Take what the project says of its volume. */
  void Take(const std::string& plist);

  std::string Name;
  std::string File = "matrix.dat"; ///< in the archive
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

void ProjectSlabs::Take(const std::string& plist)
{
  std::istringstream text(plist);
  CheckXmlInput(text);
  Element root;
  VtkMessages ignored; // What is wrong is said in one line below.
  ignored.Catch([&] { root.TakeReference(vtkXMLUtilities::ReadElementFromString(plist.c_str())); });
  vtkXMLDataElement* project =
    root && std::strcmp(root->GetName(), "plist") == 0 ? root->GetNestedElement(0) : nullptr;
  FailIf(!project, "main.plist cannot be parsed");
  vtkXMLDataElement* matrix = Need(project, "matrix");
  this->Type = TypeOf(TextOf(Need(matrix, "dtype")));
  if (vtkXMLDataElement* file = Find(matrix, "filename"))
  {
    const std::string path = TextOf(file);
    this->File = path.substr(path.find_last_of('/') + 1);
  }
  const std::array<std::string, 3> shape = ThreeOf(Need(matrix, "shape"), "shape");
  const std::array<std::string, 3> spacing = ThreeOf(Need(project, "spacing"), "spacing");
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Size[axis] = ParseNumber<int>(shape[2 - axis]); // z, y, x
    this->Placement.Spacing[axis] = ParseNumber<double>(spacing[axis]);
  }
  FailIf(*std::min_element(this->Size.begin(), this->Size.end()) < 1,
    "main.plist: the sizes " + shape[0] + " x " + shape[1] + " x " + shape[2] +
      " are not those of a volume");
  // The rows of axial slices are stored from back to front: a left-handed frame.
  vtkXMLDataElement* orientation = Find(project, "orientation");
  this->WorldAxes = !orientation || TextOf(orientation) == "1" ? "LAS" : "";
  this->LengthUnit = "mm";
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

ProjectSlabs::ProjectSlabs(const std::string& name) : Name(name)
{
  this->HasParts = false;
  Archive archive(Archive::Kind::Tar, Archive::TarIn(name));
  GoTo(archive, "main.plist");
  FailIf(
    archive.Size() > LargestText, "main.plist is too large to be the description of a project");
  std::string plist(archive.Size(), '\0');
  ReadMember(archive, plist.data());
  try
  {
    this->Take(plist);
  }
  catch (const UsageError& error)
  {
    throw Failure(std::string("main.plist: ") + error.what());
  }
}

vtkSmartPointer<vtkDataArray> ProjectSlabs::Read(int, int count)
{
  auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(this->Type));
  const std::uint64_t expected = BytesOfVoxels(this->Type, 1, this->Size);
  Archive archive(Archive::Kind::Tar, Archive::TarIn(this->Name));
  GoTo(archive, this->File);
  FailIf(archive.Size() != expected,
    this->File + " has " + std::to_string(archive.Size()) +
      " bytes, the sizes in main.plist ask for " + std::to_string(expected));
  NeedPackedBytes(BinaryFile(this->Name).Size(), MostOfZlib, expected);
  values->SetNumberOfTuples(static_cast<vtkIdType>(this->Size[0]) * this->Size[1] * count);
  ReadMember(archive, static_cast<char*>(values->GetVoidPointer(0)));
  ToNativeOrder(values, false);
  return values;
}
}

std::unique_ptr<SlabReader> OpenInv3(const std::string& name, const Opening&)
{
  return std::make_unique<ProjectSlabs>(name);
}
}
