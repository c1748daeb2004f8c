// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Labels/LabelInterfaces.h"

#include "Core/Common/Refuse.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "Core/Image/VoxelNumbers.h"
#include "Core/Interfaces/InterfaceSizes.h"
#include "Core/Interfaces/LineWedges.h"
#include "Core/Labels/MapBeyond.h"
#include "Core/Labels/SmallParts.h"
#include "Core/Labels/WrongVoxels.h"
#include "Core/Surface/SizingField.h"
#include "Output/SurfaceOutput.h"
#include "Settings/SegmentationSettings.h"

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
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <utility>

namespace volumic
{
namespace
{
/**
 * Voxels of nothing about the objects: whole bricks, as far as the Gaussian reaches, less the brick
 * beyond the map that fields have.
 */
int MarginFor(double sigma)
{
  constexpr int side = LabelBricks::Side;
  const int reach = static_cast<int>(std::ceil(3.0 * sigma)) - side;
  return std::max(1, (reach + side - 1) / side) * side;
}

/** A period, at least, in wanted edges: what is at its two ends is far from each other. */
constexpr double LeastPeriod = 4.;

/** Of the whole work. */
constexpr double FieldShare = 0.4;

double EdgeOf(const LabelSettings& settings, const Workspace& space)
{
  return settings.EdgeLength != 0.0 ? settings.EdgeLength / space.WorldUnit()
                                    : SizingField::RestLengthInDelta *
      SurfaceOptions().SamplingRatio * std::pow(std::sqrt(3.0), settings.FinestLevel);
}
}

VoxelBox LabelInterfaceMaker::BoxOf(const LabelMap& map, int objects)
{
  VoxelBox box;
  map.ForParts(VoxelBox::Of(map.Size()),
    [&](const VoxelBox& part, LabelMap::Number object)
    { box = object > 0 && object <= objects ? box.With(part) : box; });
  for (int& first : box.First)
  {
    first -= first % LabelBricks::Side; // Whole bricks, so that what is about does not matter.
  }
  return box;
}

LabelMap LabelInterfaceMaker::Padded(
  const LabelMap& map, int objects, const VoxelBox& box, int margin)
{
  constexpr int side = LabelBricks::Side;
  std::array<int, 3> size;
  for (int axis = 0; axis < 3; ++axis)
  {
    size[axis] = (box.Length(axis) + side - 1) / side * side + 2 * margin;
  }
  LabelMap padded(size);
  padded.Spacing = map.Spacing;
  padded.NumberOfObjects = objects;
  std::vector<LabelMap::Number> voxels;
  for (int layer = 0; layer < padded.NumberOfLayers(); ++layer)
  {
    const VoxelBox slices = padded.Layer(layer);
    voxels.assign(static_cast<std::size_t>(slices.Count()), 0);
    VoxelBox source = box;
    source.First[2] = std::max(box.First[2], slices.First[2] + box.First[2] - margin);
    source.End[2] = std::min(box.End[2], slices.End[2] + box.First[2] - margin);
    map.ForParts(source,
      [&](const VoxelBox& part, LabelMap::Number object)
      {
        VoxelBox to;
        for (int axis = 0; axis < 3; ++axis)
        {
          to.First[axis] = part.First[axis] - box.First[axis] + margin;
          to.End[axis] = part.End[axis] - box.First[axis] + margin;
        }
        ForRowsOf(to, slices,
          [&](std::int64_t first, std::int64_t count) {
            std::fill_n(
              voxels.begin() + first, count, object > objects ? LabelMap::Number(0) : object);
          });
      });
    padded.PutLayer(layer, voxels.data());
  }
  return padded;
}

LabelInterfaceMaker::LabelInterfaceMaker(LabelMap map, int objects, vtkImageData* image,
  const LabelSettings& settings, HostThreads& threads)
  : Settings(settings), Space(image, static_cast<Metric>(settings.Metric))
{
  LabelSurfaceMaker::PlanOf(settings, image); // Lengths have the same limits.
  const bool isFlat = settings.HasFlatBox();
  const VoxelBox box = settings.IsPeriodic() ? VoxelBox::Of(map.Size()) : BoxOf(map, objects);
  // With flat faces fields are those of labels that go on beyond them, for the whole Gaussian.
  const int margin = MarginFor(LabelSurfaceMaker::FieldOptions(settings, map).Sigma) +
    (isFlat ? LabelBricks::Side : 0);
  std::transform(box.First.begin(), box.First.end(), this->First.begin(),
    [margin](int first) { return first - margin; });
  const auto keep = static_cast<KeepComponentsType>(settings.KeepComponents);
  if (keep != KeepComponentsType::AllComponents)
  {
    const double ofVoxel =
      map.Spacing[0] * map.Spacing[1] * map.Spacing[2] * std::pow(this->Space.WorldUnit(), 3.0);
    const double least = std::min(std::ceil(settings.MinimumComponentVolume / ofVoxel),
      static_cast<double>(VoxelBox::Of(map.Size()).Count()) + 1.0);
    this->WholeMap = Padded(map, objects, box, margin);
    threads.Run([&] { this->WholeBricks.emplace(this->WholeMap, threads); });
    GiveAwaySmallParts(
      map, objects, static_cast<std::int64_t>(least), keep == KeepComponentsType::LargestComponent);
  }
  this->Map = Padded(map, objects, box, margin);
  for (int axis = 0; axis < 3; ++axis)
  {
    this->InImage.First[axis] = std::max(-this->First[axis], 0);
    this->InImage.End[axis] =
      std::min(map.Size()[axis] - this->First[axis], this->Map.Size()[axis]);
  }
  if (settings.IsPeriodic())
  {
    this->CheckPeriod();
  }
  if (isFlat)
  {
    GoOnBeyond(this->Map, this->InImage, settings.IsPeriodic());
  }
  threads.Run(
    [&]
    {
      this->Bricks.emplace(
        this->Map, threads, isFlat ? this->InImage : VoxelBox::Of(this->Map.Size()));
    });
}

void LabelInterfaceMaker::CheckPeriod() const
{
  CheckPeriodic(this->Map, this->InImage);
  const double edge = EdgeOf(this->Settings, this->Space);
  for (int axis = 0; axis < 3; ++axis)
  {
    const double period = this->InImage.Length(axis) * this->Space.Step()[axis];
    if (period < LeastPeriod * edge)
    {
      Refuse("Box Faces are to be periodic, but the volume is only ",
        period * this->Space.WorldUnit(), " wide along ", "xyz"[axis], ": it must be ", LeastPeriod,
        " Edge Lengths, which are ", edge * this->Space.WorldUnit(),
        ". Set a shorter Edge Length, or Box Faces to flat.");
    }
  }
}

InterfaceOptions LabelInterfaceMaker::Options() const
{
  InterfaceOptions options;
  options.Edge = EdgeOf(this->Settings, this->Space);
  options.VoxelTolerance = this->Settings.VoxelTolerance;
  Grading grading = this->Settings.Grading;
  grading.MaximumEdgeLength /= this->Space.WorldUnit();
  options.Tolerance = grading.Tolerance / this->Space.WorldUnit();
  options.MostSize = grading.Growth(InterfaceOptions::LongestInEdge * options.Edge);
  options.Gradation = SizingField::RestLengthInDelta * grading.Gradation / options.Edge;
  return options;
}

void LabelInterfaceMaker::Make(HostThreads& threads, const LabelSurfaceMaker::Progress& progress)
{
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<bool> goesOn{ true };
  const auto tell = [&](double share, const char* text)
  {
    if (std::this_thread::get_id() == caller && !progress(share, text))
    {
      goesOn = false;
    }
    return goesOn.load();
  };
  threads.Run(
    [&]
    {
      this->Fields.emplace(
        *this->Bricks, LabelSurfaceMaker::FieldOptions(this->Settings, this->Map),
        this->Space.Step(), threads,
        [&](double share) { return tell(FieldShare * share, "Fields of the labels"); },
        this->Settings.IsPeriodic());
      if (goesOn)
      {
        this->Mesh = MakeInterfaces(*this->Fields, this->Options(), threads,
          [&](double share)
          { return tell(FieldShare + (1.0 - FieldShare) * share, "Interfaces of the labels"); });
      }
    });
  this->IsFinished = goesOn;
}

Point LabelInterfaceMaker::InWorkspace(const Vector& place) const
{
  const std::array<double, 3>& step = this->Space.Step();
  return { place.X + this->First[0] * step[0], place.Y + this->First[1] * step[1],
    place.Z + this->First[2] * step[2] };
}

Point LabelInterfaceMaker::PlaceOf(int v) const
{
  Point place = this->InWorkspace(this->Mesh.Position[static_cast<std::size_t>(v)]);
  this->Mesh.ForFaces(v,
    [&](int f)
    {
      if (const int side = this->BoxFaceOf(this->Mesh.Faces[static_cast<std::size_t>(f)]))
      {
        const int axis = (side - 1) / 2;
        const int voxel = (side % 2 == 1 ? this->InImage.First : this->InImage.End)[axis];
        place[axis] = this->Space.Step()[axis] * (this->First[axis] + voxel - 0.5);
      }
    });
  return place;
}

LabelSurface LabelInterfaceMaker::SurfaceOf(int object, const std::vector<int>& faces) const
{
  LabelSurface made;
  made.IsFinished = this->IsFinished;
  made.WrongVoxels = made.MissedVoxels = this->Counted().ExtentOf(object).Voxels;
  if (faces.empty())
  {
    if (this->IsFinished)
    {
      made.Surface = MakeStopped(this->Settings.FinestLevel, "vanished");
    }
    return made;
  }
  const std::array<double, 3>& step = this->Space.Step();
  std::vector<int> vertices;
  SurfaceResult surface;
  static_cast<IndexedSurface&>(surface) = this->Mesh.SurfaceOf(object, faces, vertices);
  IndexedSurface inVoxels = surface;
  std::vector<VectorD> normals(vertices.size());
  for (std::size_t n = 0; n < faces.size(); ++n)
  {
    const InterfaceMesh::Face& face = this->Mesh.Faces[static_cast<std::size_t>(faces[n])];
    const VectorD across = this->Mesh.NormalOf(face) * (face.Behind == object ? 1.0 : -1.0);
    for (const int corner : surface.Triangles[n])
    {
      normals[static_cast<std::size_t>(corner)] += across;
    }
  }
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("GlobalIds");
  surface.Delta = EdgeOf(this->Settings, this->Space) / SizingField::RestLengthInDelta;
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
  std::vector<int> objects;
  for (std::size_t n = 0; n < vertices.size(); ++n)
  {
    const Vector& place = this->Mesh.Position[static_cast<std::size_t>(vertices[n])];
    surface.Points[n] = this->PlaceOf(vertices[n]);
    inVoxels.Points[n] = { place.X / step[0], place.Y / step[1], place.Z / step[2] };
    const VectorD normal = Normalized(normals[n]);
    surface.Normals.push_back(
      { static_cast<float>(normal.X), static_cast<float>(normal.Y), static_cast<float>(normal.Z) });
    this->Mesh.FindObjects(vertices[n], objects);
    const float own = this->Fields->ValueAt(object, place);
    // Where there are only sides of the box beside it, it is where it should be.
    float others =
      objects.size() == 1 || this->Mesh.IsSide(objects[1]) ? own : -2.f * LabelField::Far;
    for (const int other : objects)
    {
      others = other == object || this->Mesh.IsSide(other)
        ? others
        : std::max(others, this->Fields->ValueAt(other, place));
    }
    surface.Residual.push_back(static_cast<float>(0.5 * this->Space.WorldUnit() * (own - others)));
    surface.Motionless.push_back(this->IsFinished ? 1 : 0);
    surface.Held.push_back(0);
    ids->InsertNextValue(vertices[n]);
  }
  SurfaceDescription description;
  description.Level = this->Settings.FinestLevel;
  description.Unit = this->Space.WorldUnit() * std::pow(std::sqrt(3.0), this->Settings.FinestLevel);
  description.StopReason =
    Describe(this->IsFinished ? StopReason::Converged : StopReason::Cancelled);
  const std::vector<std::int64_t> wrong =
    FindWrongVoxels(this->Counted(), object, inVoxels, this->InImage);
  made.WrongVoxels = static_cast<vtkIdType>(wrong.size());
  const double allowed = this->Settings.VoxelTolerance + tolerance;
  made.MissedVoxels =
    static_cast<vtkIdType>(FindMissedVoxels(this->Map, wrong, inVoxels, allowed).size());
  made.VolumeError = VolumeErrorOf(inVoxels, this->Counted().ExtentOf(object).Voxels);
  made.Surface = MakePolyData(std::move(surface), description, this->Space);
  made.Surface->GetPointData()->SetGlobalIds(ids);
  if (this->Settings.HasFlatBox())
  {
    vtkNew<vtkUnsignedCharArray> boxFaces;
    boxFaces->SetName("BoxFace");
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
  std::vector<LabelSurface> surfaces(static_cast<std::size_t>(this->Map.NumberOfObjects));
  std::vector<std::vector<int>> faces = this->Mesh.FindFacesOfObjects();
  faces.resize(surfaces.size() + 1);
  threads.Run(
    [&]
    {
      threads.For(surfaces.size(), 1,
        [&](std::size_t begin, std::size_t end)
        {
          for (std::size_t n = begin; n < end; ++n)
          {
            surfaces[n] = this->SurfaceOf(static_cast<int>(n) + 1, faces[n + 1]);
          }
        });
    });
  return surfaces;
}

void LabelInterfaceMaker::TellOfLines(vtkPolyData* interfaces) const
{
  const LineWedge worst = NarrowestWedge(this->Mesh);
  if (worst.Edge[0] < 0)
  {
    return;
  }
  vtkNew<vtkDoubleArray> angle;
  angle->SetName("WorstAngle");
  angle->InsertNextValue(worst.Angle * 180.0 / vtkMath::Pi());
  vtkNew<vtkDoubleArray> position;
  position->SetName("WorstAnglePosition");
  position->SetNumberOfComponents(3);
  double ends[2][3];
  interfaces->GetPoint(worst.Edge[0], ends[0]);
  interfaces->GetPoint(worst.Edge[1], ends[1]);
  position->InsertNextTuple3(0.5 * (ends[0][0] + ends[1][0]), 0.5 * (ends[0][1] + ends[1][1]),
    0.5 * (ends[0][2] + ends[1][2]));
  vtkNew<vtkIntArray> contacts;
  contacts->SetName("SmallContacts");
  contacts->InsertNextValue(CountContactsOfOneTriangle(this->Mesh));
  interfaces->GetFieldData()->AddArray(angle);
  interfaces->GetFieldData()->AddArray(position);
  interfaces->GetFieldData()->AddArray(contacts);
}

vtkSmartPointer<vtkPolyData> LabelInterfaceMaker::Interfaces(
  const std::vector<int>& labels, int outside) const
{
  auto interfaces = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkUnsignedCharArray> junction;
  junction->SetName("Junction");
  vtkNew<vtkFloatArray> sizes;
  sizes->SetName("EdgeSize");
  const double edge = EdgeOf(this->Settings, this->Space) * this->Space.WorldUnit();
  for (std::size_t v = 0; v < this->Mesh.Position.size(); ++v)
  {
    points->InsertNextPoint(this->Space.ToWorld(this->PlaceOf(static_cast<int>(v))).data());
    junction->InsertNextValue(static_cast<unsigned char>(this->Mesh.StratumOf[v]));
    sizes->InsertNextValue(static_cast<float>(edge * this->Mesh.Size[v]));
  }
  vtkNew<vtkIntArray> sides;
  sides->SetName("BoundaryLabels");
  sides->SetNumberOfComponents(2);
  vtkNew<vtkUnsignedCharArray> boxFaces;
  boxFaces->SetName("BoxFace");
  vtkNew<vtkCellArray> lines;
  for (const std::array<int, 2>& edge : this->Mesh.FindLines())
  {
    lines->InsertNextCell({ edge[0], edge[1] });
    const int nothing[2] = { outside, outside };
    sides->InsertNextTypedTuple(nothing);
    boxFaces->InsertNextValue(0);
  }
  const auto labelOf = [&](int object)
  {
    return object > 0 && !this->Mesh.IsSide(object) ? labels[static_cast<std::size_t>(object) - 1]
                                                    : outside;
  };
  vtkNew<vtkCellArray> triangles;
  for (const InterfaceMesh::Face& face : this->Mesh.Faces)
  {
    // What faces the outside is seen from there.
    const bool isTurned = face.Behind == 0;
    const int second = this->Space.IsMirrored() != isTurned ? 2 : 1;
    triangles->InsertNextCell({ face.Vertex[0], face.Vertex[second], face.Vertex[3 - second] });
    const int both[2] = { labelOf(isTurned ? face.Front : face.Behind),
      labelOf(isTurned ? face.Behind : face.Front) };
    sides->InsertNextTypedTuple(both);
    boxFaces->InsertNextValue(this->BoxFaceOf(face));
  }
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
  this->TellOfLines(interfaces);
  return interfaces;
}
}
