// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceFacts.h"

#include "Ranks.h"
#include "ToolErrors.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace tool
{
namespace
{
using Bytes = std::array<unsigned char, 3>;

Bytes AsBytes(const Vector3& color)
{
  Bytes bytes;
  std::transform(color.begin(), color.end(), bytes.begin(),
    [](double part)
    { return static_cast<unsigned char>(std::lround(255.0 * std::clamp(part, 0.0, 1.0))); });
  return bytes;
}
}

std::string StopReason(vtkPolyData* surface)
{
  auto* reason =
    vtkStringArray::SafeDownCast(surface->GetFieldData()->GetAbstractArray("StopReason"));
  return reason && reason->GetNumberOfValues() > 0 ? reason->GetValue(0) : "";
}

std::vector<SurfaceLabel> LabelsOf(vtkPolyData* surface)
{
  vtkFieldData* fields = surface->GetFieldData();
  vtkDataArray* numbers = fields->GetArray("Label");
  auto* names = vtkStringArray::SafeDownCast(fields->GetAbstractArray("LabelName"));
  vtkDataArray* colors = fields->GetArray("LabelColor");
  std::vector<SurfaceLabel> labels;
  for (vtkIdType i = 0; numbers && names && colors && i < numbers->GetNumberOfTuples(); ++i)
  {
    SurfaceLabel label{ static_cast<int>(numbers->GetComponent(i, 0)), names->GetValue(i) };
    colors->GetTuple(i, label.Color.data());
    labels.push_back(label);
  }
  return labels;
}

const int* TriangleLabels(vtkPolyData* surface)
{
  auto* labels = vtkIntArray::SafeDownCast(surface->GetCellData()->GetArray("Label"));
  return labels ? labels->GetPointer(0) : nullptr;
}

vtkSmartPointer<vtkUnsignedCharArray> VertexColors(vtkPolyData* surface)
{
  const int* labels = TriangleLabels(surface);
  std::map<int, Bytes> colors;
  for (const SurfaceLabel& label : LabelsOf(surface))
  {
    colors[label.Label] = AsBytes(label.Color);
  }
  if (!labels || colors.empty())
  {
    return nullptr;
  }
  auto vertices = vtkSmartPointer<vtkUnsignedCharArray>::New();
  vertices->SetName("Color");
  vertices->SetNumberOfComponents(3);
  vertices->SetNumberOfTuples(surface->GetNumberOfPoints());
  vertices->FillValue(0);
  std::vector<bool> isColored(static_cast<std::size_t>(surface->GetNumberOfPoints()), false);
  ForEachPolygon(surface,
    [&](vtkIdType polygon, const vtkIdType* corners, vtkIdType count)
    {
      const Bytes& color = colors[labels[polygon]];
      for (vtkIdType c = 0; c < count; ++c)
      {
        if (!isColored[static_cast<std::size_t>(corners[c])])
        {
          isColored[static_cast<std::size_t>(corners[c])] = true;
          vertices->SetTypedTuple(corners[c], color.data());
        }
      }
    });
  return vertices;
}

// ---- Surfaces of which each rank has a piece ----------------------------------------------------

namespace
{
vtkIdType PointsIn(vtkPolyData* piece)
{
  return piece ? piece->GetNumberOfPoints() : 0;
}

vtkIdType TrianglesIn(vtkPolyData* piece)
{
  return piece ? piece->GetNumberOfPolys() : 0;
}

/** Which elements of the whole those of a piece are; from `next` on, if nothing tells. */
vtkSmartPointer<vtkIdList> IdsOf(vtkDataSetAttributes* piece, vtkIdType count, vtkIdType next)
{
  auto ids = vtkSmartPointer<vtkIdList>::New();
  ids->SetNumberOfIds(count);
  vtkDataArray* told = piece->GetGlobalIds();
  for (vtkIdType i = 0; i < count; ++i)
  {
    ids->SetId(i, told ? static_cast<vtkIdType>(told->GetComponent(i, 0)) : next + i);
  }
  return ids;
}

/** How many points the whole has, as far as the piece tells. */
vtkIdType VerticesBy(vtkPolyData* piece)
{
  vtkIdType count = 0;
  if (piece)
  {
    const auto ids = IdsOf(piece->GetPointData(), PointsIn(piece), 0);
    for (const vtkIdType id : *ids)
    {
      count = std::max(count, id + 1);
    }
  }
  return count;
}

/** The first numbers, from 0 on. */
vtkSmartPointer<vtkIdList> First(vtkIdType count)
{
  auto ids = vtkSmartPointer<vtkIdList>::New();
  ids->SetNumberOfIds(count);
  std::iota(ids->begin(), ids->end(), vtkIdType(0));
  return ids;
}

/** Arrays like those of a piece, for a whole; what tells the ids is of no use in it. */
void Prepare(vtkDataSetAttributes* whole, vtkDataSetAttributes* piece, vtkIdType count)
{
  for (int i = 0; i < piece->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* given = piece->GetArray(i);
    if (given && given != piece->GetGlobalIds() &&
      given->GetName() != std::string(vtkDataSetAttributes::GhostArrayName()))
    {
      const auto array = vtkSmartPointer<vtkDataArray>::Take(given->NewInstance());
      array->SetName(given->GetName());
      array->SetNumberOfComponents(given->GetNumberOfComponents());
      array->SetNumberOfTuples(count);
      const int index = whole->AddArray(array);
      if (const int role = piece->IsArrayAnAttribute(i); role >= 0)
      {
        whole->SetActiveAttribute(index, role);
      }
    }
  }
}

/** Puts values of a piece to their places. What comes from another rank may have another order. */
void Copy(vtkDataSetAttributes* piece, vtkIdList* ids, vtkDataSetAttributes* whole)
{
  const auto all = First(ids->GetNumberOfIds());
  for (int i = 0; i < whole->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = whole->GetArray(i);
    vtkDataArray* given = piece->GetArray(array->GetName());
    FailIf(!given || given->GetDataType() != array->GetDataType() ||
        given->GetNumberOfComponents() != array->GetNumberOfComponents(),
      std::string("the pieces of the ranks differ in their array ") + array->GetName());
    array->InsertTuples(ids, all, given);
  }
}

//------------------------------------------------------------------------------
/** Puts pieces together. */
class Whole
{
public:
  explicit Whole(const SurfaceSize& size)
    : Size(size), IsThere(static_cast<std::size_t>(size.Vertices), false)
  {
  }

  void Add(vtkPolyData* piece);

  /** @throws Failure if a point or a triangle has not come. */
  vtkSmartPointer<vtkPolyData> Take();

private:
  void Start(vtkPolyData* piece);

  SurfaceSize Size;
  vtkSmartPointer<vtkPolyData> Surface;
  vtkSmartPointer<vtkIdTypeArray> Corners;
  std::vector<bool> IsThere;
  vtkIdType NextTriangle = 0;
};

void Whole::Start(vtkPolyData* piece)
{
  this->Surface = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(piece->GetPoints()->GetDataType());
  points->SetNumberOfPoints(this->Size.Vertices);
  this->Surface->SetPoints(points);
  Prepare(this->Surface->GetPointData(), piece->GetPointData(), this->Size.Vertices);
  Prepare(this->Surface->GetCellData(), piece->GetCellData(), this->Size.Triangles);
  this->Corners = vtkSmartPointer<vtkIdTypeArray>::New();
  this->Corners->SetNumberOfValues(3 * this->Size.Triangles);
}

void Whole::Add(vtkPolyData* piece)
{
  const vtkIdType count = TrianglesIn(piece);
  if (count == 0)
  {
    return;
  }
  if (!this->Surface)
  {
    this->Start(piece);
  }
  const auto points = IdsOf(piece->GetPointData(), PointsIn(piece), 0);
  for (const vtkIdType id : *points)
  {
    this->IsThere[static_cast<std::size_t>(id)] = true;
  }
  this->Surface->GetPoints()->InsertPoints(
    points, First(PointsIn(piece)), piece->GetPoints());
  Copy(piece->GetPointData(), points, this->Surface->GetPointData());

  const auto triangles = IdsOf(piece->GetCellData(), count, this->NextTriangle);
  vtkNew<vtkIdList> corners;
  for (vtkIdType t = 0; t < count; ++t)
  {
    piece->GetPolys()->GetCellAtId(t, corners);
    for (int k = 0; k < 3; ++k)
    {
      this->Corners->SetValue(3 * triangles->GetId(t) + k, points->GetId(corners->GetId(k)));
    }
  }
  Copy(piece->GetCellData(), triangles, this->Surface->GetCellData());
  this->NextTriangle += count;
}

vtkSmartPointer<vtkPolyData> Whole::Take()
{
  const auto missing = std::count(this->IsThere.begin(), this->IsThere.end(), false);
  FailIf(missing > 0 || this->NextTriangle != this->Size.Triangles,
    "the pieces of the ranks are no whole surface: " + std::to_string(missing) +
      " points are in none of them");
  vtkNew<vtkCellArray> triangles;
  triangles->SetData(3, this->Corners);
  this->Surface->SetPolys(triangles);
  return this->Surface;
}

vtkPolyData* BlockOf(vtkMultiBlockDataSet* blocks, unsigned int index)
{
  const bool has = blocks && index < blocks->GetNumberOfBlocks();
  return has ? vtkPolyData::SafeDownCast(blocks->GetBlock(index)) : nullptr;
}

/** As many as the rank has that knows of the most. */
unsigned int NumberOfBlocks(const Ranks& ranks, vtkMultiBlockDataSet* pieces)
{
  const std::vector<double> numbers = ranks.GatherOnAll(pieces ? pieces->GetNumberOfBlocks() : 0.0);
  return static_cast<unsigned int>(*std::max_element(numbers.begin(), numbers.end()));
}
}

SurfaceSize SizeOf(const Ranks& ranks, vtkPolyData* piece)
{
  // Numbers of double precision hold all that there can be.
  const std::vector<double> vertices = ranks.GatherOnAll(static_cast<double>(VerticesBy(piece)));
  const std::vector<double> triangles = ranks.GatherOnAll(static_cast<double>(TrianglesIn(piece)));
  return { static_cast<vtkIdType>(*std::max_element(vertices.begin(), vertices.end())),
    static_cast<vtkIdType>(std::accumulate(triangles.begin(), triangles.end(), 0.0)) };
}

std::vector<SurfaceSize> SizesOf(const Ranks& ranks, vtkMultiBlockDataSet* pieces)
{
  std::vector<SurfaceSize> sizes(NumberOfBlocks(ranks, pieces));
  for (unsigned int i = 0; i < sizes.size(); ++i)
  {
    sizes[i] = SizeOf(ranks, BlockOf(pieces, i));
  }
  return sizes;
}

vtkSmartPointer<vtkPolyData> GatherSurface(const Ranks& ranks, vtkPolyData* piece)
{
  if (ranks.IsOne())
  {
    return piece;
  }
  const std::vector<double> counts = ranks.GatherOnAll(static_cast<double>(TrianglesIn(piece)));
  const SurfaceSize size = SizeOf(ranks, piece);
  if (!ranks.IsFirst())
  {
    if (TrianglesIn(piece) > 0)
    {
      ranks.SendToFirst(piece);
    }
    return nullptr;
  }
  // Of the others' pieces one is in memory at a time.
  Whole whole(size);
  whole.Add(piece);
  for (int rank = 1; rank < ranks.Count(); ++rank)
  {
    if (counts[static_cast<std::size_t>(rank)] > 0)
    {
      vtkNew<vtkPolyData> received;
      ranks.Receive(received, rank);
      whole.Add(received);
    }
  }
  if (size.Triangles == 0)
  {
    return piece;
  }
  const vtkSmartPointer<vtkPolyData> surface = whole.Take();
  if (piece)
  {
    surface->GetFieldData()->ShallowCopy(piece->GetFieldData());
  }
  return surface;
}

vtkSmartPointer<vtkMultiBlockDataSet> GatherBlocks(
  const Ranks& ranks, vtkMultiBlockDataSet* pieces)
{
  if (ranks.IsOne())
  {
    return pieces;
  }
  auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  const unsigned int count = NumberOfBlocks(ranks, pieces);
  if (ranks.IsFirst())
  {
    blocks->ShallowCopy(pieces);
  }
  for (unsigned int i = 0; i < count; ++i)
  {
    const vtkSmartPointer<vtkPolyData> surface = GatherSurface(ranks, BlockOf(pieces, i));
    if (ranks.IsFirst() && surface)
    {
      blocks->SetBlock(i, surface);
    }
  }
  return blocks;
}
}
