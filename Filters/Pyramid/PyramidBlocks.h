// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPyramidBlocks_h
#define volumicPyramidBlocks_h

#include "Core/Common/Communicator.h"
#include "Core/Image/PyramidGeometry.h"
#include "Input/ImagePieces.h"
#include "Pyramid/LevelVoxels.h"

#include <vtkSmartPointer.h>

#include <string>

class vtkDataArray;
class vtkImageData;
class vtkInformation;
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
   * @param piece     of this rank; null: none
   * @param selection of its voxels, as GetInputArrayInformation()
   * @param component of them, as SelectComponent() takes it
   */
  PyramidImage(
    Communicator& ranks, vtkImageData* piece, vtkInformation* selection, int component);

  ImagePieces Pieces;
  vtkSmartPointer<vtkImageData> Piece;  ///< or null
  vtkSmartPointer<vtkDataArray> Voxels; ///< without tuples where this rank has no piece

private:
  PyramidImage(
    Communicator& ranks, vtkImageData* piece, const vtkSmartPointer<vtkDataArray>& voxels);
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
