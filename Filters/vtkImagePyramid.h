// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkImagePyramid
 * @brief   images of one scene at decreasing resolutions, with any reduction factor under two
 *
 * vtkImagePyramid computes a pyramid from a 2D or 3D image. Each level is smoothed by a Gaussian
 * kernel of five voxels and has T times fewer voxels along each axis than the level below, with
 * 1 < T < 2. The default sqrt(3) is the factor by which vtkDeformableSurface subdivides its mesh.
 *
 * @par Input:
 * Port 0: a vtkImageData with point data, a composite dataset with one image, or a pyramid, whose
 * level 0 is used. SetInputArrayToProcess() chooses the array (default: active point scalars), of any
 * numeric type. Blanked voxels are background: points hidden by the ghost array
 * (vtkDataSetAttributes::HIDDENPOINT), or whose cells are all hidden (HIDDENCELL). Infinite voxels
 * are an error.
 *
 * @par Output:
 * Port 0: a vtkMultiBlockDataSet. Block h is the vtkImageData of level h, named `Level h`. Block 0
 * is the input, whose arrays are shared (of several components the array has the selected one).
 * All levels have the position of the first voxel, the direction and the real size of the input. The
 * spacing of level h is spacing * size / size of level h, and its extent starts at 0.
 *
 * Point data of each level from 1 on:
 * - one array with the name of the input's: double if that is double, or integers of 32 or 64 bits
 *   over 168 times as large as their range (10^9 to 10^9 + 50), else float
 *
 * Field data of each level:
 * - `Level` (int)
 * - `Unit` (double): U_h, the distance that one voxel represents at the level, world units
 *
 * Field data of the output:
 * - `StopReason` (string): `complete`, or `cancelled` after AbortExecute. The output then has the
 *   finished levels, and counts as up to date. Call Modified() to restart.
 * - `NaNVoxels` (vtkIdType): number of NaN voxels of level 0
 *
 * @par Algorithm:
 * Equations 3 to 5 of the paper: voxel i of level h lies at i times the level's spacing. The samples
 * of the kernel are U_h apart along each axis, also where voxels are longer, with U_h = T^h U_0
 * (eq. 4). Beyond the border the nearest voxel counts. Kernel and interpolation are one banded
 * operator per axis. Axes of one voxel stay one voxel. Voxels of coarser levels are the weighted
 * means of valid voxels, neither NaN nor blanked, and NaN where these have under half of the weight.
 * Results are bit-identical for any number of threads.
 *
 * @par Processes:
 * In a parallel run, as in pvserver and pvbatch, the first process (piece 0) requests the whole image
 * and makes all levels. The others have the same blocks without images.
 *
 * @par Errors:
 * On error the filter invokes `ErrorEvent` with a message that names the port, array or value. The
 * output is empty. GetErrorCode() returns vtkErrorCode::UserError for an invalid input or property,
 * vtkErrorCode::UnknownError if memory does not suffice, and 0 after a good run. The pipeline itself
 * reports a missing input by `ErrorEvent` of GetExecutive(). Invalid are:
 * - an input that is not an image (apply vtkResampleToImage to other grids first), is empty, or has
 *   several images that are not a pyramid
 * - an array that does not exist, is cell data, is not numeric, or lacks the selected component
 * - infinite voxels, NaN voxels without NaNIsBackground, and no other voxels than NaN or blanked
 * - a ReductionFactor outside 1 to 2, and more levels than the image can have
 *
 * @par Thanks:
 * J.-O. Lachaud and A. Montanvert, "Volumic Segmentation using Hierarchical Representation and
 * Triangulated Surface", ECCV 1996, section 4.
 *
 * @sa
 * vtkImageGaussianSmooth vtkImageResize
 */
#ifndef vtkImagePyramid_h
#define vtkImagePyramid_h

#include "vtkFiltersVolumicModule.h" // For export macro
#include "vtkImageAlgorithm.h"

#include <vtkSmartPointer.h>

#include <memory> // For what is hidden
#include <string>

class vtkDataObject;
class vtkImageData;
class vtkMultiBlockDataSet;
namespace volumic
{
class RunObserver;
struct ImageLevels;
}

class VTKFILTERSVOLUMIC_EXPORT vtkImagePyramid : public vtkImageAlgorithm
{
public:
  static vtkImagePyramid* New();
  vtkTypeMacro(vtkImagePyramid, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The pyramid. These hide vtkImageAlgorithm::GetOutput(), which is not virtual: it returns a
   * vtkImageData, and would return null here, also in Python, as the output is none. Who calls it
   * by a pointer to the superclass gets null; GetOutputDataObject(0) serves there.
   */
  vtkMultiBlockDataSet* GetOutput();
  vtkMultiBlockDataSet* GetOutput(int port);
  ///@}

  ///@{
  /**
   * T: how many times fewer voxels a level has along each axis than the level below it. Between 1
   * and 2, both excluded. Default: sqrt(3).
   */
  virtual void SetReductionFactor(double value);
  virtual double GetReductionFactor();
  ///@}

  ///@{
  /**
   * Number of levels, level 0 (the input) included. 0, the default: as many as MinimumLevelSize
   * allows.
   */
  virtual void SetNumberOfLevels(int value);
  virtual int GetNumberOfLevels();
  ///@}

  ///@{
  /**
   * With NumberOfLevels 0: no level after level 0 has an axis of fewer voxels than this. Axes
   * along which the input has one voxel do not count. Default: 10.
   */
  virtual void SetMinimumLevelSize(int value);
  virtual int GetMinimumLevelSize();
  ///@}

  ///@{
  /**
   * Which component of an array of several is taken: 0 for the first one; -1, the default: the
   * magnitude. An array of one component is taken as it is with either.
   */
  virtual void SetSelectedComponent(int value);
  virtual int GetSelectedComponent();
  ///@}

  ///@{
  /**
   * Voxels that are NaN are background, and a warning tells how many there are. Off: they are
   * refused. Default: on.
   */
  virtual void SetNaNIsBackground(bool value);
  virtual bool GetNaNIsBackground();
  vtkBooleanMacro(NaNIsBackground, bool);
  ///@}

  ///@{
  /**
   * Number of threads; 0, the default: as many as the process may have processors, or as the host
   * says (VTK_SMP_MAX_THREADS, vtkSMPTools::Initialize). Results do not depend on it.
   */
  virtual void SetNumberOfThreads(int value);
  virtual int GetNumberOfThreads();
  ///@}

  ///@{
  /**
   * Deprecated: has no effect. Set ScratchDirectory, and limit the memory of the process by its
   * cgroup.
   */
  void SetMemoryLimit(int mebibytes);
  int GetMemoryLimit();
  ///@}

  ///@{
  /**
   * Folder on a disk for large arrays, which are then mapped from files without a name; empty (the
   * default): arrays lie in memory. Results do not depend on it.
   */
  void SetScratchDirectory(const char* directory);
  const char* GetScratchDirectory();
  ///@}

  /**
   * How many levels the pyramid of an image of so many voxels has, with these settings; 0 where
   * they don't go together, which Update() tells by an error.
   */
  int CountLevels(int sizeX, int sizeY, int sizeZ) const;

  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

protected:
  vtkImagePyramid();
  ~vtkImagePyramid() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

private:
  vtkImagePyramid(const vtkImagePyramid&) = delete;
  void operator=(const vtkImagePyramid&) = delete;

  int RequestDataObject(vtkInformationVector* output);

  /// @param image gets the image, once it is there
  volumic::ImageLevels MakeLevels(vtkDataObject* input, vtkSmartPointer<vtkImageData>& image,
    volumic::RunObserver& observer);
  /// Blocks without images: parallel writers need the same blocks in all processes.
  void MakeEmptyBlocks(vtkInformationVector* input, vtkMultiBlockDataSet* output);

  class vtkInternals;
  std::unique_ptr<vtkInternals> Internals;
};

#endif
