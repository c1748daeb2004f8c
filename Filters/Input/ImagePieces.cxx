// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/ImagePieces.h"

#include "Core/Common/Refuse.h"
#include "Host/LargeArray.h"
#include "Input/ImageVoxels.h"

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkExtentTranslator.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace volumic
{
namespace
{
/** Of a rank's piece, as it goes to the others. */
struct Place
{
  int Extent[6] = { 0, -1, 0, -1, 0, -1 };
  double Origin[3] = { 0, 0, 0 };
  double Spacing[3] = { 1, 1, 1 };
  double Direction[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
  double Unit = 0.0; ///< what a level's field data tell; 0: nothing

  bool IsNone() const { return this->Extent[1] < this->Extent[0]; }
};

Place PlaceOf(vtkImageData* piece)
{
  Place place;
  if (!piece || piece->GetNumberOfPoints() == 0)
  {
    return place;
  }
  piece->GetExtent(place.Extent);
  piece->GetOrigin(place.Origin);
  piece->GetSpacing(place.Spacing);
  std::copy_n(piece->GetDirectionMatrix()->GetData(), 9, place.Direction);
  vtkDataArray* unit = piece->GetFieldData()->GetArray("Unit");
  place.Unit = unit && unit->GetNumberOfTuples() == 1 ? unit->GetTuple1(0) : 0.0;
  return place;
}

template <std::size_t N>
bool AreClose(const double (&a)[N], const double (&b)[N], double tolerance)
{
  return std::equal(
    a, a + N, b, [tolerance](double x, double y) { return std::abs(x - y) <= tolerance; });
}

void CheckSamePlace(const Place& first, const Place& other, int rank)
{
  double size = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int last = std::max(std::abs(first.Extent[2 * axis + 1]), 1);
    size = std::max(size, std::abs(first.Spacing[axis]) * last);
  }
  constexpr double share = 1e-6;
  if (!AreClose(first.Spacing, other.Spacing, share * size) ||
    !AreClose(first.Origin, other.Origin, share * size) ||
    !AreClose(first.Direction, other.Direction, share))
  {
    Refuse("the pieces of the image that the processes hold are not of one image: origin, spacing "
           "or direction differ at process ", rank, ".");
  }
}
}

VoxelBox PieceOf(const std::array<int, 3>& size, int rank, int ranks, int ghosts)
{
  VoxelBox box = VoxelBox::Of(size);
  if (ranks == 1)
  {
    return box;
  }
  int whole[6] = { 0, size[0] - 1, 0, size[1] - 1, 0, size[2] - 1 };
  int extent[6];
  vtkNew<vtkExtentTranslator> translator;
  if (!translator->PieceToExtentThreadSafe(
        rank, ranks, ghosts, whole, extent, vtkExtentTranslator::BLOCK_MODE, 0))
  {
    return VoxelBox();
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    box.First[axis] = extent[2 * axis];
    box.End[axis] = extent[2 * axis + 1] + 1;
  }
  return box;
}

VoxelBox BoxOf(vtkImageData* image, const std::array<int, 3>& first)
{
  VoxelBox box;
  const int* extent = image->GetExtent();
  for (int axis = 0; axis < 3; ++axis)
  {
    box.First[axis] = extent[2 * axis] - first[axis];
    box.End[axis] = extent[2 * axis + 1] + 1 - first[axis];
  }
  return box;
}

vtkSmartPointer<vtkDataArray> AgreeOnArray(Communicator& ranks, vtkDataArray* values)
{
  struct Kind
  {
    int Type = -1; // none
    int Components = 0;
  };
  MessageWriter own;
  own.Add(values ? Kind{ values->GetDataType(), values->GetNumberOfComponents() } : Kind());
  own.AddArray(std::string(values && values->GetName() ? values->GetName() : ""));
  vtkSmartPointer<vtkDataArray> agreed;
  int rank = 0;
  for (const Message& message : ranks.GatherOnAll(own.Take()))
  {
    MessageReader reader(message);
    const auto kind = reader.Take<Kind>();
    const std::vector<char> letters = reader.TakeVector<char>();
    const std::string name(letters.begin(), letters.end());
    if (kind.Type >= 0 && !agreed)
    {
      agreed.TakeReference(vtkDataArray::CreateDataArray(kind.Type));
      agreed->SetNumberOfComponents(kind.Components);
      agreed->SetName(name.empty() ? nullptr : name.c_str());
    }
    else if (kind.Type >= 0 &&
      (kind.Type != agreed->GetDataType() || kind.Components != agreed->GetNumberOfComponents() ||
        name != (agreed->GetName() ? agreed->GetName() : "")))
    {
      Refuse("the pieces of the image that the processes hold do not have the same array: process ",
        rank, " has '", name, "' of another name, type or number of components than ",
        NameOf(agreed), ".");
    }
    ++rank;
  }
  return values ? vtkSmartPointer<vtkDataArray>(values) : agreed;
}

ImagePieces::ImagePieces(Communicator& ranks, vtkImageData* piece)
  : Whole(vtkSmartPointer<vtkImageData>::New())
{
  const Place own = PlaceOf(piece);
  const std::vector<Place> all = GatherValues(ranks, own);
  const auto found =
    std::find_if(all.begin(), all.end(), [](const Place& place) { return !place.IsNone(); });
  if (found == all.end())
  {
    this->Points = VoxelPieces(ranks, VoxelBox());
    return;
  }
  int extent[6];
  std::copy_n(found->Extent, 6, extent);
  for (std::size_t rank = 0; rank < all.size(); ++rank)
  {
    const Place& place = all[rank];
    if (place.IsNone())
    {
      continue;
    }
    CheckSamePlace(*found, place, static_cast<int>(rank));
    for (int axis = 0; axis < 3; ++axis)
    {
      extent[2 * axis] = std::min(extent[2 * axis], place.Extent[2 * axis]);
      extent[2 * axis + 1] = std::max(extent[2 * axis + 1], place.Extent[2 * axis + 1]);
    }
  }
  this->Whole->SetExtent(extent);
  this->Whole->SetOrigin(found->Origin);
  this->Whole->SetSpacing(found->Spacing);
  this->Whole->SetDirectionMatrix(found->Direction);
  if (found->Unit > 0.0)
  {
    vtkNew<vtkDoubleArray> unit;
    unit->SetName("Unit");
    unit->InsertNextValue(found->Unit);
    this->Whole->GetFieldData()->AddArray(unit);
  }
  const std::array<int, 3> first = { extent[0], extent[2], extent[4] };
  this->Points = VoxelPieces(ranks, own.IsNone() ? VoxelBox() : BoxOf(piece, first));
  if (!this->Points.HoldAll(BoxOf(this->Whole, first)))
  {
    Refuse("the processes hold only a part of the voxels of the image, ", SizeOf(this->Whole),
      ": some are in the piece of none.");
  }
}

vtkSmartPointer<vtkDataArray> FetchVoxels(Communicator& ranks, const VoxelPieces& pieces,
  vtkDataArray* values, const VoxelBox& wanted)
{
  const vtkSmartPointer<vtkDataArray> own = values ? ContiguousVoxels(values) : nullptr;
  const vtkSmartPointer<vtkDataArray> kind = AgreeOnArray(ranks, own);
  if (!kind)
  {
    return nullptr;
  }
  const vtkSmartPointer<vtkDataArray> fetched = NewLargeArrayLike(kind, wanted.Count());
  const auto bytes = static_cast<std::size_t>(kind->GetDataTypeSize()) *
    static_cast<std::size_t>(kind->GetNumberOfComponents());
  pieces.Fetch(ranks, own ? own->GetVoidPointer(0) : nullptr, bytes, wanted,
    wanted.IsEmpty() ? nullptr : fetched->GetVoidPointer(0));
  return fetched;
}

vtkSmartPointer<vtkImageData> ImagePieces::PartOfFrame(const VoxelBox& box) const
{
  auto part = vtkSmartPointer<vtkImageData>::New();
  part->CopyStructure(this->Whole);
  const int* whole = this->Whole->GetExtent();
  int extent[6];
  for (int axis = 0; axis < 3; ++axis)
  {
    extent[2 * axis] = whole[2 * axis] + box.First[axis];
    extent[2 * axis + 1] = whole[2 * axis] + box.End[axis] - 1;
  }
  part->SetExtent(extent);
  return part;
}
}
