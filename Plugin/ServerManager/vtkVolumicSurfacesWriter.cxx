// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkVolumicSurfacesWriter.h"

#include "GltfScene.h"
#include "Texts.h"
#include "WriteResults.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCleanPolyData.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkTriangleFilter.h>

#include <cstddef>
#include <exception>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <vector>

vtkStandardNewMacro(vtkVolumicSurfacesWriter);

namespace
{
/** A surface, and what it is called; not at all where it is the only one. */
struct NamedSurface
{
  std::string Name;
  vtkSmartPointer<vtkPolyData> Surface;
};

/** A component of a surface, with its cavities: its triangles, with their points alone. */
vtkSmartPointer<vtkPolyData> PartOf(
  vtkPolyData* surface, const std::vector<int>& owners, int wanted)
{
  vtkNew<vtkPolyData> part;
  part->SetPoints(surface->GetPoints());
  part->GetPointData()->ShallowCopy(surface->GetPointData());
  part->GetCellData()->CopyAllocate(surface->GetCellData());
  vtkNew<vtkCellArray> triangles;
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell)
  {
    if (owners[static_cast<std::size_t>(cell)] == wanted)
    {
      surface->GetCellPoints(cell, corners);
      const vtkIdType id = triangles->InsertNextCell(corners);
      part->GetCellData()->CopyData(surface->GetCellData(), cell, id);
    }
  }
  part->SetPolys(triangles);
  vtkNew<vtkCleanPolyData> clean; // leaves out points that are of no use, and merges none
  clean->PointMergingOff();
  clean->ConvertPolysToLinesOff();
  clean->SetInputData(part);
  clean->Update();
  return clean->GetOutput();
}

/** The component that each cell belongs to: of a cavity the one that it is in. */
std::vector<int> OwnersOf(vtkPolyData* surface)
{
  vtkDataArray* components = surface->GetCellData()->GetArray("Component");
  vtkDataArray* owners = surface->GetFieldData()->GetArray("ComponentOwner");
  std::vector<int> found;
  for (vtkIdType cell = 0; components && cell < components->GetNumberOfTuples(); ++cell)
  {
    const auto component = static_cast<vtkIdType>(components->GetTuple1(cell));
    const bool isOwned = owners && component >= 0 && component < owners->GetNumberOfTuples() &&
      owners->GetTuple1(component) >= 0;
    found.push_back(
      static_cast<int>(isOwned ? owners->GetTuple1(component) : components->GetTuple1(cell)));
  }
  return found;
}

/** What is written of one surface: all of it, or component by component. */
void AddComponents(vtkPolyData* surface, std::vector<NamedSurface>& all)
{
  const std::vector<int> owners = OwnersOf(surface);
  const std::set<int> found(owners.begin(), owners.end());
  if (found.size() < 2)
  {
    all.push_back({ "", surface });
    return;
  }
  for (const int component : found)
  {
    all.push_back({ "component-" + std::to_string(component), PartOf(surface, owners, component) });
  }
}

/** The surface of what a filter has made of one, such as Clip or Threshold; null: it has none. */
vtkSmartPointer<vtkPolyData> TrianglesOf(vtkDataObject* data)
{
  vtkSmartPointer<vtkPolyData> surface = vtkPolyData::SafeDownCast(data);
  if (!surface && vtkDataSet::SafeDownCast(data))
  {
    vtkNew<vtkDataSetSurfaceFilter> extract;
    extract->SetInputData(data);
    extract->Update();
    surface = extract->GetOutput();
  }
  if (surface && (surface->GetNumberOfStrips() > 0 || surface->GetPolys()->GetMaxCellSize() > 3))
  {
    vtkNew<vtkTriangleFilter> cut;
    cut->PassLinesOff();
    cut->PassVertsOff();
    cut->SetInputData(surface);
    cut->Update();
    surface = cut->GetOutput();
  }
  return surface && surface->GetNumberOfPolys() > 0 ? surface : nullptr;
}

std::vector<NamedSurface> SurfacesOf(vtkDataObject* input)
{
  std::vector<NamedSurface> all;
  if (auto* blocks = vtkCompositeDataSet::SafeDownCast(input))
  {
    auto leaf = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
    for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
    {
      const bool isNamed = leaf->HasCurrentMetaData() &&
        leaf->GetCurrentMetaData()->Has(vtkCompositeDataSet::NAME());
      if (const auto surface = TrianglesOf(leaf->GetCurrentDataObject()))
      {
        all.push_back({ isNamed ? leaf->GetCurrentMetaData()->Get(vtkCompositeDataSet::NAME())
                                : std::to_string(leaf->GetCurrentFlatIndex()),
          surface });
      }
    }
  }
  else if (const auto surface = TrianglesOf(input))
  {
    AddComponents(surface, all);
  }
  return all;
}

void WriteEach(const std::vector<NamedSurface>& surfaces, const std::string& file)
{
  const std::filesystem::path path(file);
  const std::string stem = (path.parent_path() / path.stem()).string();
  tool::DistinctNames names("-");
  for (const NamedSurface& each : surfaces)
  {
    const std::string name =
      names.Take(each.Name.empty() ? "" : "-" + tool::SafeName(each.Name));
    tool::WriteSurface(each.Surface, stem + name + path.extension().string(), {});
  }
}
}

//------------------------------------------------------------------------------
vtkVolumicSurfacesWriter::vtkVolumicSurfacesWriter() = default;
vtkVolumicSurfacesWriter::~vtkVolumicSurfacesWriter() = default;

//------------------------------------------------------------------------------
void vtkVolumicSurfacesWriter::SetFileName(const char* name)
{
  this->FileName = name ? name : "";
  this->Modified();
}

//------------------------------------------------------------------------------
int vtkVolumicSurfacesWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

//------------------------------------------------------------------------------
void vtkVolumicSurfacesWriter::WriteData()
{
  vtkMultiProcessController* ranks = vtkMultiProcessController::GetGlobalController();
  vtkDataObject* input = this->GetInput();
  try
  {
    if (ranks && ranks->GetNumberOfProcesses() > 1 && !input->IsA("vtkCompositeDataSet"))
    {
      throw std::runtime_error(
        this->FileName + ": each process has a piece of the surface: use File > Save Data");
    }
    tool::CheckSurfaceName(this->FileName);
    const std::vector<NamedSurface> surfaces = SurfacesOf(input);
    if (surfaces.empty())
    {
      throw std::runtime_error(this->FileName + ": not written, as there are no triangles in it");
    }
    if (tool::IsScene(this->FileName))
    {
      std::vector<tool::SceneObject> objects;
      for (const NamedSurface& each : surfaces)
      {
        objects.push_back({ each.Name.empty() ? "surface" : each.Name, each.Surface });
      }
      tool::WriteScene(objects, this->FileName, tool::ProgressStyle::None);
    }
    else
    {
      WriteEach(surfaces, this->FileName);
    }
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
  }
}

//------------------------------------------------------------------------------
void vtkVolumicSurfacesWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << "\n";
}
