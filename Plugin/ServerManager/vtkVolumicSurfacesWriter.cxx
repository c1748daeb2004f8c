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
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <algorithm>
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

/** The triangles of a component, with its points alone. */
vtkSmartPointer<vtkPolyData> ComponentOf(vtkPolyData* surface, vtkDataArray* components, int wanted)
{
  vtkNew<vtkPolyData> part;
  part->SetPoints(surface->GetPoints());
  part->GetPointData()->ShallowCopy(surface->GetPointData());
  part->GetCellData()->CopyAllocate(surface->GetCellData());
  vtkNew<vtkCellArray> triangles;
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell)
  {
    if (static_cast<int>(components->GetTuple1(cell)) == wanted)
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

/** What is written of one surface: all of it, or component by component. */
void AddComponents(vtkPolyData* surface, std::vector<NamedSurface>& all)
{
  vtkDataArray* components = surface->GetCellData()->GetArray("Component");
  const int last = components ? static_cast<int>(components->GetRange()[1]) : 0;
  if (last == 0)
  {
    all.push_back({ "", surface });
    return;
  }
  for (int i = 0; i <= last; ++i)
  {
    const vtkSmartPointer<vtkPolyData> part = ComponentOf(surface, components, i);
    if (part->GetNumberOfCells() > 0)
    {
      all.push_back({ "component-" + std::to_string(i), part });
    }
  }
}

std::vector<NamedSurface> SurfacesOf(vtkDataObject* input)
{
  std::vector<NamedSurface> all;
  auto* blocks = vtkCompositeDataSet::SafeDownCast(input);
  auto* one = vtkPolyData::SafeDownCast(input);
  if (one && one->GetNumberOfCells() > 0)
  {
    AddComponents(one, all);
  }
  else if (blocks)
  {
    auto leaf = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
    for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
    {
      auto* surface = vtkPolyData::SafeDownCast(leaf->GetCurrentDataObject());
      const bool isNamed = leaf->HasCurrentMetaData() &&
        leaf->GetCurrentMetaData()->Has(vtkCompositeDataSet::NAME());
      if (surface && surface->GetNumberOfCells() > 0)
      {
        all.push_back({ isNamed ? leaf->GetCurrentMetaData()->Get(vtkCompositeDataSet::NAME())
                                : std::to_string(leaf->GetCurrentFlatIndex()),
          surface });
      }
    }
  }
  return all;
}

void WriteEach(const std::vector<NamedSurface>& surfaces, const std::string& file)
{
  const std::filesystem::path path(file);
  const std::string stem = (path.parent_path() / path.stem()).string();
  std::set<std::string> taken; // in small letters, as some systems have it
  for (const NamedSurface& each : surfaces)
  {
    const std::string safe = tool::SafeName(each.Name);
    std::string name = each.Name.empty() ? "" : "-" + safe;
    for (int more = 2; !taken.insert(tool::Lower(name)).second; ++more)
    {
      name = "-" + safe + "-" + std::to_string(more);
    }
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
    if (ranks && ranks->GetNumberOfProcesses() > 1 && input->IsA("vtkPolyData"))
    {
      throw std::runtime_error(
        this->FileName + ": each process has a piece of the surface: use File > Save Data");
    }
    tool::CheckSurfaceName(this->FileName);
    const std::vector<NamedSurface> surfaces = SurfacesOf(input);
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
