// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The outputs of LabelInterfaceMaker: poly data in world coordinates.

#include "Labels/LabelInterfaces.h"

#include "Core/Interfaces/InterfaceSizes.h"
#include "Core/Interfaces/JunctionWedges.h"
#include "Output/SurfaceOutput.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace volumic
{
namespace
{
template <typename Array>
vtkSmartPointer<Array> NewArray(const char* name, int components = 1)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  return array;
}
}

Point LabelInterfaceMaker::PositionOf(int v) const
{
  const std::array<double, 3>& step = this->Space.Step();
  const Vector& inBox = this->Mesh.Position[static_cast<std::size_t>(v)];
  Point position = { inBox.X + this->First[0] * step[0], inBox.Y + this->First[1] * step[1],
    inBox.Z + this->First[2] * step[2] };
  this->Mesh.ForFaces(v,
    [&](int f)
    {
      if (const int side = this->BoxFaceOf(this->Mesh.Faces[static_cast<std::size_t>(f)]))
      {
        const int axis = (side - 1) / 2;
        const int voxel = (side % 2 == 1 ? this->InImage.First : this->InImage.End)[axis];
        position[axis] = step[axis] * (this->First[axis] + voxel - 0.5);
      }
    });
  return position;
}

float LabelInterfaceMaker::ResidualAt(int v, int object) const
{
  const Vector& position = this->Mesh.Position[static_cast<std::size_t>(v)];
  std::vector<int> objects;
  this->Mesh.FindObjects(v, objects);
  const int part = *std::find_if(
    objects.begin(), objects.end(), [&](int other) { return this->Map.Whole(other) == object; });
  const float own = this->Fields->ValueAt(part, position);
  // A vertex between an object and sides of the box has no residual.
  float others =
    objects.size() == 1 || this->Mesh.IsSide(objects[1]) ? own : -2.f * LabelField::Far;
  for (const int other : objects)
  {
    others = other == part || this->Mesh.IsSide(other)
      ? others
      : std::max(others, this->Fields->ValueAt(other, position));
  }
  return static_cast<float>(0.5 * this->Space.WorldUnit() * (own - others));
}

SurfaceResult LabelInterfaceMaker::ResultOf(int object, const std::vector<int>& faces,
  const IndexedSurface& ofMesh, const std::vector<int>& vertices) const
{
  SurfaceResult surface;
  static_cast<IndexedSurface&>(surface) = ofMesh;
  std::vector<VectorD> normals(vertices.size());
  for (std::size_t n = 0; n < faces.size(); ++n)
  {
    const InterfaceMesh::Face& face = this->Mesh.Faces[static_cast<std::size_t>(faces[n])];
    const VectorD across =
      this->Mesh.NormalOf(face) * (this->Map.Whole(face.Behind) == object ? 1.0 : -1.0);
    for (const int corner : surface.Triangles[n])
    {
      normals[static_cast<std::size_t>(corner)] += across;
    }
  }
  surface.Delta = this->EdgeLength() / SizingField::RestLengthInDelta;
  const double tolerance = this->Options().Tolerance;
  if (tolerance > 0.)
  {
    surface.FitToTolerance = MeasureFit(this->Mesh, *this->Fields, faces, tolerance);
    for (const int v : vertices)
    {
      surface.Size.push_back(
        static_cast<float>(surface.Delta) * this->Mesh.Size[static_cast<std::size_t>(v)]);
    }
  }
  for (std::size_t n = 0; n < vertices.size(); ++n)
  {
    surface.Points[n] = this->PositionOf(vertices[n]);
    const VectorD normal = Normalized(normals[n]);
    surface.Normals.push_back(
      { static_cast<float>(normal.X), static_cast<float>(normal.Y), static_cast<float>(normal.Z) });
    surface.Residual.push_back(this->ResidualAt(vertices[n], object));
  }
  surface.Motionless.assign(vertices.size(), this->IsFinished ? 1 : 0);
  surface.Held.assign(vertices.size(), 0);
  return surface;
}

LabelSurface LabelInterfaceMaker::SurfaceOf(int object, const std::vector<int>& faces) const
{
  LabelSurface made = this->Counts[static_cast<std::size_t>(object)];
  if (faces.empty())
  {
    if (this->IsFinished)
    {
      made.Surface = MakeStopped(this->Settings.FinestLevel, "vanished");
    }
    return made;
  }
  std::vector<int> vertices;
  const IndexedSurface surface = this->Mesh.SurfaceOf(object, faces, vertices);
  SurfaceDescription description;
  description.Level = description.StartLevel = this->Settings.FinestLevel;
  description.Unit = this->Space.WorldUnit() * std::pow(std::sqrt(3.0), this->Settings.FinestLevel);
  description.StopReason =
    Describe(this->IsFinished ? StopReason::Converged : StopReason::Cancelled);
  made.Surface =
    MakePolyData(this->ResultOf(object, faces, surface, vertices), description, this->Space);
  const auto ids = NewArray<vtkIdTypeArray>("GlobalIds");
  for (const int v : vertices)
  {
    ids->InsertNextValue(this->IdOf[static_cast<std::size_t>(v)]);
  }
  made.Surface->GetPointData()->SetGlobalIds(ids);
  HideArrays(made.Surface->GetPointData(), { "Residual", "Contact", "GlobalIds" });
  HideArrays(made.Surface->GetCellData(),
    { "Component", "ComponentArea", "ComponentVolume", "ComponentGenus" });
  if (this->Settings.HasFlatBox())
  {
    const auto boxFaces = NewArray<vtkUnsignedCharArray>("BoxFace");
    for (const int f : faces)
    {
      boxFaces->InsertNextValue(this->BoxFaceOf(this->Mesh.Faces[static_cast<std::size_t>(f)]));
    }
    made.Surface->GetCellData()->AddArray(boxFaces);
  }
  return made;
}

std::vector<LabelSurface> LabelInterfaceMaker::Surfaces(HostThreads& threads) const
{
  std::vector<LabelSurface> surfaces(this->Selected.size());
  std::vector<std::vector<int>> faces = this->Mesh.FindFacesOfObjects();
  faces.resize(static_cast<std::size_t>(this->Map.NumberOfObjects) + 1);
  for (std::size_t object = 1; object < faces.size(); ++object)
  {
    std::vector<int>& whole = faces[this->Map.Whole(static_cast<int>(object))];
    if (&whole != &faces[object])
    {
      whole.insert(whole.end(), faces[object].begin(), faces[object].end());
    }
  }
  threads.For(surfaces.size(), 1,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t n = begin; n < end; ++n)
      {
        const int object = this->Selected[n];
        surfaces[n] = this->SurfaceOf(object, faces[static_cast<std::size_t>(object)]);
      }
    });
  return surfaces;
}

void LabelInterfaceMaker::AddLineFields(
  const std::vector<std::array<int, 2>>& lines, vtkPolyData* interfaces) const
{
  const JunctionWedge worst = NarrowestWedge(this->Mesh, lines);
  if (worst.Edge[0] < 0)
  {
    return;
  }
  const auto angle = NewArray<vtkDoubleArray>("WorstAngle");
  angle->InsertNextValue(worst.Angle * 180.0 / vtkMath::Pi());
  const auto position = NewArray<vtkDoubleArray>("WorstAnglePosition", 3);
  const Point first = this->Space.ToWorld(this->PositionOf(worst.Edge[0]));
  const Point second = this->Space.ToWorld(this->PositionOf(worst.Edge[1]));
  position->InsertNextTuple3(
    0.5 * (first[0] + second[0]), 0.5 * (first[1] + second[1]), 0.5 * (first[2] + second[2]));
  const auto contacts = NewArray<vtkIntArray>("SmallContacts");
  contacts->InsertNextValue(CountContactsOfOneTriangle(this->Mesh, lines));
  interfaces->GetFieldData()->AddArray(angle);
  interfaces->GetFieldData()->AddArray(position);
  interfaces->GetFieldData()->AddArray(contacts);
}

std::vector<std::array<int, 2>> LabelInterfaceMaker::ShownLines() const
{
  std::vector<std::array<int, 2>> lines = this->Mesh.FindLines();
  std::vector<int> faces;
  const auto isHidden = [&](const std::array<int, 2>& ends)
  {
    this->Mesh.FindFaces(ends[0], ends[1], faces);
    return std::none_of(faces.begin(), faces.end(),
      [this](int f) { return this->IsShown(this->Mesh.Faces[static_cast<std::size_t>(f)]); });
  };
  lines.erase(std::remove_if(lines.begin(), lines.end(), isHidden), lines.end());
  return lines;
}

vtkSmartPointer<vtkPolyData> LabelInterfaceMaker::Interfaces(
  const std::vector<int>& labels, int outside) const
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  const auto junction = NewArray<vtkUnsignedCharArray>("Junction");
  const auto sizes = NewArray<vtkFloatArray>("EdgeSize");
  const double edge = this->EdgeLength() * this->Space.WorldUnit();
  for (std::size_t v = 0; v < this->Mesh.Position.size(); ++v)
  {
    if (this->IdOf[v] >= 0)
    {
      points->InsertNextPoint(this->Space.ToWorld(this->PositionOf(static_cast<int>(v))).data());
      junction->InsertNextValue(static_cast<unsigned char>(this->Mesh.StratumOf[v]));
      sizes->InsertNextValue(static_cast<float>(edge * this->Mesh.Size[v]));
    }
  }
  const auto sides = NewArray<vtkIntArray>("BoundaryLabels", 2);
  const auto boxFaces = NewArray<vtkUnsignedCharArray>("BoxFace");
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkCellArray> triangles;
  const auto idOf = [&](int v) { return this->IdOf[static_cast<std::size_t>(v)]; };
  const std::vector<std::array<int, 2>> shownLines = this->ShownLines();
  for (const std::array<int, 2>& ends : shownLines)
  {
    lines->InsertNextCell({ idOf(ends[0]), idOf(ends[1]) });
    const int nothing[2] = { outside, outside };
    sides->InsertNextTypedTuple(nothing);
    boxFaces->InsertNextValue(0);
  }
  const auto labelOf = [&](int object)
  {
    const int selection = this->SelectionOf(object);
    return selection < 0 ? outside : labels[static_cast<std::size_t>(selection)];
  };
  for (const InterfaceMesh::Face& face : this->Mesh.Faces)
  {
    if (this->IsShown(face))
    {
      // The normal points away from the selected object.
      const bool isTurned = this->SelectionOf(face.Behind) < 0;
      const int second = this->Space.IsMirrored() != isTurned ? 2 : 1;
      triangles->InsertNextCell(
        { idOf(face.Vertex[0]), idOf(face.Vertex[second]), idOf(face.Vertex[3 - second]) });
      const int both[2] = { labelOf(isTurned ? face.Front : face.Behind),
        labelOf(isTurned ? face.Behind : face.Front) };
      sides->InsertNextTypedTuple(both);
      boxFaces->InsertNextValue(this->BoxFaceOf(face));
    }
  }
  auto interfaces = vtkSmartPointer<vtkPolyData>::New();
  interfaces->SetPoints(points);
  interfaces->SetLines(lines);
  interfaces->SetPolys(triangles);
  interfaces->GetCellData()->AddArray(sides);
  interfaces->GetPointData()->AddArray(junction);
  if (this->Settings.HasFlatBox())
  {
    interfaces->GetCellData()->AddArray(boxFaces);
  }
  if (this->Settings.Grading.HasTolerance())
  {
    interfaces->GetPointData()->AddArray(sizes);
  }
  this->AddLineFields(shownLines, interfaces);
  return interfaces;
}
}
