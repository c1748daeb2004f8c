// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicImagePieces_h
#define volumicImagePieces_h

#include "Core/Common/Communicator.h"
#include "Core/Image/VoxelPieces.h"

#include <vtkSmartPointer.h>

#include <array>

class vtkDataArray;
class vtkImageData;

namespace volumic
{
/**
 * An image that ranks hold in pieces: each a vtkImageData with a part of the extent and the origin
 * of the whole, as VTK's sources give them, or none. Pieces may share voxels. One may have all.
 */
class ImagePieces
{
public:
  /**
   * By all ranks together.
   * @param piece of this rank; null, or without points: none
   * @throws std::invalid_argument, on all ranks, if the pieces don't lie in one image, or leave
   *         voxels out.
   */
  ImagePieces(Communicator& ranks, vtkImageData* piece);

  /** Whether no rank holds any of it. */
  bool IsEmpty() const { return this->Points.Bounds().IsEmpty(); }

  /** Extent and place of the whole image; it has no arrays but the field data `Unit` of a level. */
  vtkImageData* Frame() const { return this->Whole; }

  /** Voxels along each axis of the whole image. */
  std::array<int, 3> Size() const { return this->Points.Bounds().End; }

  /** Who holds which points, the first one of the image being (0, 0, 0). */
  const VoxelPieces& Voxels() const { return this->Points; }

  /** A part of the image, without arrays. */
  vtkSmartPointer<vtkImageData> PartOfFrame(const VoxelBox& box) const;

private:
  vtkSmartPointer<vtkImageData> Whole;
  VoxelPieces Points;
};

/**
 * The voxels of a rank's piece of an image of this size: as VTK cuts images, neighbours share a
 * layer; none where there are more ranks than that gives.
 * @param ghosts layers more, as far as the image goes
 */
VoxelBox PieceOf(const std::array<int, 3>& size, int rank, int ranks, int ghosts = 0);

/**
 * By all ranks together: the values at a box of voxels that this rank wants.
 * @param values of this rank's piece; null where it has none
 * @return an array of the same name, type and number of components, which may be of no tuples; null
 *         where no rank has values
 * @throws std::invalid_argument, on all ranks, if they have others than this one.
 */
vtkSmartPointer<vtkDataArray> FetchVoxels(Communicator& ranks, const VoxelPieces& pieces,
  vtkDataArray* values, const VoxelBox& wanted);

/** The points of an image as a box, where its first one is what `first` names. */
VoxelBox BoxOf(vtkImageData* image, const std::array<int, 3>& first = { 0, 0, 0 });

/**
 * By all ranks together: an array like that of the lowest rank that has one, without tuples, for
 * who has none itself; null where nobody has.
 * @throws std::invalid_argument, on all ranks, if they differ in name, type or components.
 */
vtkSmartPointer<vtkDataArray> AgreeOnArray(Communicator& ranks, vtkDataArray* values);
}

#endif
