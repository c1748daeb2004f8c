// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/RunFingerprint.h"

#include "Core/Common/ContentHash.h"
#include "Core/Common/Join.h"
#include "Input/ImageVoxels.h"
#include "Settings/PropertyTable.h"

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <limits>
#include <locale>
#include <sstream>

namespace volumic
{
namespace
{
/** The fewest digits that give the number back. */
std::string NumberText(double number)
{
  std::string text;
  for (int digits = 6; digits <= std::numeric_limits<double>::max_digits10; ++digits)
  {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.precision(digits);
    out << number;
    text = out.str();
    std::istringstream in(text);
    in.imbue(std::locale::classic());
    double read = 0.0;
    if (in >> read && read == number)
    {
      break;
    }
  }
  return text;
}

std::string TextOf(const std::vector<Point>& points)
{
  std::string text;
  for (const Point& p : points)
  {
    text += NumberText(p[0]) + "," + NumberText(p[1]) + "," + NumberText(p[2]) + " ";
  }
  return text;
}

std::string TextOf(bool isOn)
{
  return isOn ? "on" : "off";
}

std::string TextOf(const std::string& text)
{
  return text;
}

/** Of a number, or an enumeration. */
template <typename Number>
std::string TextOf(Number number)
{
  return NumberText(static_cast<double>(number));
}

/** `Iso Value` of `IsoValue`, and `NaN Is Background`. */
std::string WordsOf(const std::string& name)
{
  std::string words;
  for (std::size_t i = 0; i < name.size(); ++i)
  {
    const bool begins = i > 0 && std::isupper(name[i]) && std::islower(name[i + 1]);
    words += (begins ? " " : "") + name.substr(i, 1);
  }
  return words;
}

void AddArray(std::uint64_t& hash, vtkDataArray* array)
{
  const vtkSmartPointer<vtkDataArray> values = ContiguousVoxels(array);
  const auto bytes = static_cast<std::size_t>(values->GetNumberOfValues()) *
    static_cast<std::size_t>(values->GetDataTypeSize());
  hash = CombineHashes(hash, CombineHashes(static_cast<std::uint64_t>(values->GetDataType()),
                               ContentHash(values->GetVoidPointer(0), bytes)));
}

/** Points, vertices, polygons and the numbers at the points. */
std::string HashOf(vtkPolyData* polyData)
{
  if (!polyData || !polyData->GetPoints())
  {
    return "none";
  }
  std::uint64_t hash = 0;
  AddArray(hash, polyData->GetPoints()->GetData());
  for (vtkCellArray* cells : { polyData->GetVerts(), polyData->GetPolys(), polyData->GetStrips() })
  {
    if (cells && cells->GetNumberOfCells() > 0)
    {
      AddArray(hash, cells->GetOffsetsArray());
      AddArray(hash, cells->GetConnectivityArray());
    }
    hash = CombineHashes(hash, 1);
  }
  for (int i = 0; i < polyData->GetPointData()->GetNumberOfArrays(); ++i)
  {
    if (vtkDataArray* array = polyData->GetPointData()->GetArray(i))
    {
      AddArray(hash, array);
    }
  }
  return HashText(hash);
}
}

RunFingerprint::RunFingerprint(const SegmentationSettings& settings,
  const SegmentationRequest& request, const SegmentationLevels& levels, Executor& threads)
{
  this->Add("version of Volumic", VOLUMIC_FILTERS_VERSION);
  this->AddVolume(levels, settings.Range(), threads);
  this->AddSettings(settings);
  this->AddInputs(request, levels, threads);
}

void RunFingerprint::Add(const std::string& name, const std::string& value, Kind kind)
{
  this->Entries.push_back({ name, value, kind });
}

void RunFingerprint::AddVolume(
  const SegmentationLevels& levels, const ValueRange& range, Executor& threads)
{
  const PyramidLevels& pyramid = levels.Pyramid();
  const Workspace& space = levels.GetWorkspace();
  const std::array<int, 3> size = pyramid.SizeOfLevel0();
  this->Add(
    "size of the volume", Join(size[0], " x ", size[1], " x ", size[2]), Kind::Volume);
  // An affine map is known by what it does to four points.
  this->Add("place of the volume",
    TextOf({ space.Step(), space.ToWorld({ 0, 0, 0 }), space.ToWorld({ 1, 0, 0 }), space.ToWorld({ 0, 1, 0 }),
      space.ToWorld({ 0, 0, 1 }) }),
    Kind::Volume);
  // Voxels that were folded by another range are others, which says nothing of the image.
  const std::string of = range.IsUsed() ? Join(" between ", range.Lower, " and ", range.Upper) : "";
  this->Add("voxels" + of, HashText(pyramid.HashOfVoxels(0, threads)), Kind::Volume);
  std::string coarser = NumberText(levels.UnitInWorld(-1));
  for (int level = 1; level < pyramid.NumberOfLevels(); ++level)
  {
    coarser += " " + NumberText(levels.UnitInWorld(level)) + " " +
      HashText(pyramid.HashOfVoxels(level, threads));
  }
  this->Add("levels of the pyramid" + of, coarser);
}

void RunFingerprint::AddSettings(const SegmentationSettings& settings)
{
#define VolumicEntry(name, type, field, change, kind)                                              \
  if (Kind::kind != Kind::Free)                                                                    \
  {                                                                                                \
    this->Add(WordsOf(#name), TextOf(settings.field), Kind::kind);                                 \
  }
  VOLUMIC_SURFACE_PROPERTIES(VolumicEntry, VolumicEntry)
#undef VolumicEntry
  if (settings.Grading.IsWanted())
  {
    this->Add("Finest Level", TextOf(settings.End.FinestLevel), Kind::Told); // It alone is graded.
  }
}

void RunFingerprint::AddInputs(
  const SegmentationRequest& request, const SegmentationLevels& levels, Executor& threads)
{
  this->Add("Initial Surface (input port 1)", HashOf(request.InitialSurface));
  this->Add("Attracting Points (input port 2)", HashOf(request.AttractingPoints));
  this->Add("Edge Map", HashText(levels.HashOfEdges(threads)));
}

std::uint64_t RunFingerprint::Hash() const
{
  std::uint64_t hash = 0;
  for (const Entry& entry : this->Entries)
  {
    for (const std::string& text : { entry.Name, entry.Value })
    {
      hash = CombineHashes(hash, ContentHash(text.data(), text.size()));
    }
  }
  return hash;
}

const std::string* RunFingerprint::ValueOf(const std::string& name) const
{
  for (const Entry& entry : this->Entries)
  {
    if (entry.Name == name)
    {
      return &entry.Value;
    }
  }
  return nullptr;
}

std::vector<RunFingerprint::Difference> RunFingerprint::DifferencesOf(
  const RunFingerprint& before) const
{
  std::vector<Difference> differences;
  for (const Entry& entry : this->Entries)
  {
    const std::string* was = before.ValueOf(entry.Name);
    if (was && *was != entry.Value)
    {
      differences.push_back({ entry, *was });
    }
  }
  return differences;
}

bool RunFingerprint::IsSameVolume(const RunFingerprint& other) const
{
  const std::vector<Difference> differences = this->DifferencesOf(other);
  return std::none_of(differences.begin(), differences.end(),
    [](const Difference& difference) { return difference.Is.Is == Kind::Volume; });
}

int RunFingerprint::NumberOfDifferences(const RunFingerprint& other) const
{
  return static_cast<int>(this->DifferencesOf(other).size());
}

std::string RunFingerprint::DifferencesFrom(const RunFingerprint& before) const
{
  std::string text;
  for (const auto& [is, was] : this->DifferencesOf(before))
  {
    text += text.empty() ? "" : "; ";
    text += is.Is == Kind::Told ? Join(is.Name, " was ", was, " and is ", is.Value)
                                 : Join("not the same ", is.Name);
  }
  return text;
}

void RunFingerprint::Write(CheckedWriter& file) const
{
  file.Put<std::uint64_t>(this->Entries.size());
  for (const Entry& entry : this->Entries)
  {
    file.PutText(entry.Name);
    file.PutText(entry.Value);
  }
}

RunFingerprint RunFingerprint::Read(CheckedReader& file)
{
  RunFingerprint fingerprint;
  fingerprint.Entries.resize(file.GetCount(2 * sizeof(std::uint64_t))); // Each text has its length.
  for (Entry& entry : fingerprint.Entries)
  {
    entry.Name = file.GetText();
    entry.Value = file.GetText();
  }
  return fingerprint;
}
}
