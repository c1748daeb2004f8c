// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkImagePyramid
 * @brief   images of one scene at decreasing resolutions, with any reduction factor under two
 *
 * vtkImagePyramid makes level after level of a pyramid from a 2D or 3D image: each level is
 * smoothed by a Gaussian kernel of five voxels and holds T times fewer voxels along every axis
 * than the one below it, where T, the reduction factor, may be any number between 1 and 2. The
 * default sqrt(3) is the factor by which vtkDeformableSurface divides its mesh.
 *
 * @par Input:
 * Port 0: a vtkImageData of any extent, origin, spacing and direction, with point data; or a
 * composite dataset with one image in it, or a pyramid, whose level 0 is taken. The array is chosen
 * by SetInputArrayToProcess(); by default it is the active point scalars. It may be of any numeric
 * type; of several components SelectedComponent chooses one. NaN voxels are background, see
 * NaNIsBackground, and so are blanked ones, without a word: points that the ghost array hides
 * (vtkDataSetAttributes::HIDDENPOINT), or all of whose cells it hides (HIDDENCELL). Infinite voxels
 * are refused.
 *
 * @par Output:
 * Port 0: a vtkMultiBlockDataSet. Block h is the vtkImageData of level h, named `Level h`; block 0
 * is the input itself, whose arrays are shared, not copied (of several components the array holds
 * the selected one, under the same name). All levels have the origin (the place of the first
 * voxel), the direction and the real size of the input; the spacing of level h is
 * spacing * size / size of level h, in world units, and its extent starts at 0.
 *
 * Point data of each level from 1 on:
 * - one array, under the name that it has on the input: double if that is double, or integers of 32
 *   or 64 bits whose differences single precision would lose (their size is over 168 times their
 *   range: 10^9 to 10^9 + 50), else float
 *
 * Field data of every level:
 * - `Level` (int)
 * - `Unit` (double): the U_h of the paper, the distance that stands for one voxel at that level,
 *   world units
 *
 * Field data of the whole:
 * - `StopReason` (string): `complete` or, after AbortExecute, `cancelled`: then the levels that were
 *   finished are there, and count as up to date; to run anew call Modified() before Update()
 * - `NaNVoxels` (vtkIdType): the number of NaN voxels of level 0
 *
 * @par Algorithm:
 * Equations 3 to 5 of the paper, with all places as there: voxel i of level h lies at i times the
 * level's spacing. The offset between two places of the kernel is U_h along every axis, also where
 * voxels are longer: the kernel is cubic in the real space. Past the border the nearest voxel
 * counts. Kernel and interpolation are folded into one banded operator per axis, which gives the
 * same numbers to rounding. U_h is T^h U_0 (eq. 4); the minimum over the axes that the paper also
 * states would differ from it, as sizes are rounded down. Axes of one voxel stay one voxel.
 * Results are the same bits for any number of threads. Where voxels are NaN or blanked, those of
 * the coarser levels are the weighted means of the others alone, and NaN where these have less than
 * half of the weight.
 *
 * @par Processes:
 * In a parallel run, as in pvserver and pvbatch, the first process (piece 0) requests the whole image
 * and makes all levels. The others have the same blocks without images.
 *
 * @par Errors:
 * A message names the port, the array or the value, and the output is empty, when: the input is no
 * image (apply vtkResampleToImage to an AMR, rectilinear, structured or unstructured grid first),
 * or holds several that are no pyramid; the image is empty; there is no such array, or it is cell
 * data or not numeric, or has not the component selected; it has infinite voxels, or NaN without
 * NaNIsBackground, or no others; ReductionFactor is not between 1 and 2; more levels are asked for
 * than the image can give; the memory does not suffice. A warning tells the number of NaN voxels.
 * @par
 * Update() goes on after an error, so that whatever follows in the pipeline gets the empty output.
 * A program asks GetErrorCode() after Update(): 0 (vtkErrorCode::NoError) after a good run,
 * vtkErrorCode::UserError where something given is wrong, vtkErrorCode::UnknownError where the
 * memory does not suffice. Each run sets it anew. The message comes with ErrorEvent; without an
 * observer VTK prints it. A missing input is refused by the pipeline before a run: by ErrorEvent of
 * GetExecutive() only.
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
  vtkSetMacro(ReductionFactor, double);
  vtkGetMacro(ReductionFactor, double);
  ///@}

  ///@{
  /**
   * Number of levels, level 0 (the input) included. 0, the default: as many as MinimumLevelSize
   * allows.
   */
  vtkSetMacro(NumberOfLevels, int);
  vtkGetMacro(NumberOfLevels, int);
  ///@}

  ///@{
  /**
   * With NumberOfLevels 0: no level after level 0 has an axis of fewer voxels than this. Axes
   * along which the input has one voxel do not count. Default: 10.
   */
  vtkSetMacro(MinimumLevelSize, int);
  vtkGetMacro(MinimumLevelSize, int);
  ///@}

  ///@{
  /**
   * Which component of an array of several is taken: 0 for the first one; -1, the default: the
   * magnitude. An array of one component is taken as it is with either.
   */
  vtkSetMacro(SelectedComponent, int);
  vtkGetMacro(SelectedComponent, int);
  ///@}

  ///@{
  /**
   * Voxels that are NaN are background, and a warning tells how many there are. Off: they are
   * refused. Default: on.
   */
  vtkSetMacro(NaNIsBackground, bool);
  vtkGetMacro(NaNIsBackground, bool);
  vtkBooleanMacro(NaNIsBackground, bool);
  ///@}

  ///@{
  /**
   * Number of threads; 0, the default: as many as the process may have processors, or as the host
   * says (VTK_SMP_MAX_THREADS, vtkSMPTools::Initialize). Results do not depend on it.
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, VTK_INT_MAX);
  vtkGetMacro(NumberOfThreads, int);
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

  double ReductionFactor;
  int NumberOfLevels;
  int MinimumLevelSize;
  int SelectedComponent;
  bool NaNIsBackground;
  int NumberOfThreads;

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
