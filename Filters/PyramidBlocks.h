// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPyramidBlocks_h
#define volumicPyramidBlocks_h

#include "Core/Common/Communicator.h"
#include "Core/Image/PyramidGeometry.h"
#include "ImagePieces.h"
#include "LevelVoxels.h"

#include <vtkSmartPointer.h>

#include <string>

class vtkDataArray;
class vtkImageData;
class vtkMultiBlockDataSet;

namespace volumic
{
/** What vtkImagePyramid is asked for. */
struct PyramidRequest
{
  PyramidOptions Levels;
  bool NaNIsBackground = true;
  int NumberOfThreads = 0;
  int GhostLevels = 0; ///< layers that each rank's pieces have beyond what they share
  PyramidProgress Progress;
};

/** The level 0 of a pyramid, which ranks hold in pieces. */
struct PyramidImage
{
  /**
   * By all ranks together.
   * @param piece  of this rank; null: none
   * @param voxels of it, of one component; null where there is none
   */
  PyramidImage(Communicator& ranks, vtkImageData* piece, vtkDataArray* voxels);

  ImagePieces Pieces;
  vtkSmartPointer<vtkImageData> Piece;  ///< or null
  vtkSmartPointer<vtkDataArray> Voxels; ///< without tuples where this rank has no piece
};

/** The blocks of vtkImagePyramid's output, with its field data. */
struct PyramidBlocks
{
  vtkSmartPointer<vtkMultiBlockDataSet> Blocks; ///< Those are null of which this rank has no piece.
  std::string AboutNaNs; ///< what to warn of; empty: nothing
};

/** By all ranks together. @throws as vtkImagePyramid reports. */
PyramidBlocks MakePyramidBlocks(
  Communicator& ranks, const PyramidImage& image, const PyramidRequest& request);

/** Those where the work was stopped before there was an image. */
PyramidBlocks StoppedPyramidBlocks();
}

#endif
