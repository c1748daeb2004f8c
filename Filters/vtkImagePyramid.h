// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkImagePyramid
 * @brief   compute an image pyramid with any reduction factor between 1 and 2
 *
 * vtkImagePyramid computes a pyramid from a 2D or 3D image. Each level is smoothed by a Gaussian
 * kernel of five voxels and has T times fewer voxels along each axis than the next finer level. The
 * default factor T = sqrt(3) is the factor by which vtkDeformableSurface subdivides its mesh.
 * Results are bit-identical for any number of threads.
 *
 * @par Input:
 * Port 0: a vtkImageData with point data, a composite dataset with one image, or a pyramid, of
 * which the filter uses level 0. SetInputArrayToProcess() chooses the array (default: active point
 * scalars), of any numeric type. Blanked voxels are background: points hidden by the ghost array
 * (vtkDataSetAttributes::HIDDENPOINT), and points whose cells are all hidden (HIDDENCELL).
 *
 * @par Output:
 * Port 0: a vtkMultiBlockDataSet. Block h, named `Level h`, is the vtkImageData of level h. Block 0
 * is the input and shares its arrays. If the array has several components, block 0 has the selected
 * one. All levels have the position of the first voxel, the direction and the physical size of the
 * input. The extent of a level starts at 0.
 * - Point data of each level from 1 on: an array with the name of the input array. It is double for
 *   double input, and for integers that float cannot distinguish, such as 10^9 to 10^9 + 50. It is
 *   float otherwise.
 * - Field data of each level: `Level` (int), and `Unit` (double), the distance U_h in world units
 *   that one voxel of the level represents.
 * - Field data of the output: `StopReason` (string), `complete` or `cancelled`, and `NaNVoxels`
 *   (vtkIdType), the number of NaN voxels of level 0.
 *
 * @par Algorithm:
 * The filter implements equations 3 to 5 of the paper. Voxel i of level h lies at i times the
 * level's spacing. The samples of the kernel are U_h = T^h U_0 apart along each axis, also if
 * voxels are anisotropic. The image is extended by its nearest voxels. Axes of one voxel are not
 * reduced. A voxel of a coarser level is the weighted mean of valid voxels, which are neither NaN
 * nor blanked. It is NaN if valid voxels have less than half of the weight.
 *
 * @par Errors:
 * On error the filter invokes `ErrorEvent`, produces an empty output and sets GetErrorCode(): to
 * vtkErrorCode::UserError for an invalid input or property, to vtkErrorCode::UnknownError if memory
 * does not suffice. The executive reports a missing input. Errors are
 * - an input that is not an image (use vtkResampleToImage for other grids), is empty, or has
 *   several images that are not a pyramid
 * - an array that does not exist, is cell data, is not numeric, or lacks the selected component
 * - infinite voxels, NaN voxels with NaNIsBackground off, and images without valid voxels
 * - a ReductionFactor outside 1 to 2, and more levels than the image can have
 *
 * @par Cancelling:
 * After AbortExecute the output has the finished levels and counts as up to date. Call Modified()
 * to restart.
 *
 * @par Processes:
 * In a parallel run, as in pvserver and pvbatch, the first process (piece 0) requests the whole
 * image and computes all levels. The others have null blocks.
 *
 * @par Thanks:
 * J.-O. Lachaud and A. Montanvert, "Volumic Segmentation using Hierarchical Representation and
 * Triangulated Surface", ECCV 1996, section 4.
 *
 * @sa
 * vtkDeformableSurface vtkImageGaussianSmooth vtkImageResize
 */
#ifndef vtkImagePyramid_h
#define vtkImagePyramid_h

#include "vtkFiltersVolumicModule.h" // For export macro
#include "vtkImageAlgorithm.h"
#include "vtkVolumicPropertyMacros.h" // For volumicPropertyMacro

#include <vtkSmartPointer.h>

#include <memory> // For std::unique_ptr

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
   * Return the pyramid. This method hides vtkImageAlgorithm::GetOutput(), which is not virtual and
   * returns null, as the output is not a vtkImageData. Through a pointer to the superclass call
   * GetOutputDataObject(0).
   */
  vtkMultiBlockDataSet* GetOutput();
  vtkMultiBlockDataSet* GetOutput(int port);
  ///@}

  ///@{
  /**
   * Set/Get the reduction factor between consecutive levels along each axis, in (1, 2) (default:
   * sqrt(3)).
   */
  volumicPropertyMacro(ReductionFactor, double);
  /** Set/Get the number of levels, including the input (default 0: limited by MinimumLevelSize). */
  volumicPropertyMacro(NumberOfLevels, int);
  /**
   * Set/Get the smallest number of voxels along an axis of a level, with NumberOfLevels 0 (default:
   * 10). Level 0 may have fewer. Axes along which the input has one voxel do not count.
   */
  volumicPropertyMacro(MinimumLevelSize, int);
  /**
   * Set/Get the component of the voxels, from 0 (default -1: the magnitude of all components). An
   * array of one component is not changed by -1 or 0.
   */
  volumicPropertyMacro(SelectedComponent, int);
  /** Set/Get whether NaN voxels are background, with a warning (default: on). Off: an error. */
  volumicBooleanPropertyMacro(NaNIsBackground);
  /**
   * Set/Get the number of threads (default 0: all). Results do not depend on it. 0 means all
   * processors of the process, limited by VTK_SMP_MAX_THREADS and vtkSMPTools::Initialize().
   */
  volumicPropertyMacro(NumberOfThreads, int);
  /** Set/Get the directory for large arrays in memory-mapped files (default empty: in memory). */
  volumicPropertyMacro(ScratchDirectory, const char*);
  /**
   * Deprecated, without effect (default: 0). Set ScratchDirectory, and limit memory by the cgroup.
   */
  volumicPropertyMacro(MemoryLimit, int);
  ///@}

  /**
   * Return the number of levels of an image of this size in voxels with these settings. Return 0 if
   * the settings are invalid for it, which Update() reports as an error.
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

  /// Compute the levels. @param image set to the input image, also if an exception follows
  volumic::ImageLevels MakeLevels(
    vtkDataObject* input, vtkSmartPointer<vtkImageData>& image, volumic::RunObserver& observer);
  /// Make null blocks. Parallel writers need the same blocks in all processes.
  void MakeEmptyBlocks(vtkInformationVector* input, vtkMultiBlockDataSet* output);

  class vtkInternals;
  std::unique_ptr<vtkInternals> Internals;
};

#endif
