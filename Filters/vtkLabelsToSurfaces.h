// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkLabelsToSurfaces
 * @brief   mesh all labels of a label map conformingly, with a closed surface per label
 *
 * vtkLabelsToSurfaces meshes a segmented image, whose voxels are integer labels. The mesh has
 * exactly the topology of the voxels, see Connectivity. It is conforming: adjacent labels share the
 * triangles between them. It is free of self-intersections, and the block of each label is closed
 * and manifold. Surfaces are smooth and enclose the volume of the voxels. Results are bit-identical
 * for any number of threads.
 *
 * @par Input:
 * Port 0: a vtkImageData, or a composite dataset with one image. SetInputArrayToProcess() chooses
 * the array (default: active scalars): integers of any type, of one component. Point data (voxels
 * are points) and cell data (voxels are cells) are accepted.
 * - Floating-point numbers within 0.01 of integers are rounded, with a warning.
 * - NaN is background, with a warning.
 * - Labels outside the range of int are renumbered, with a warning.
 * - Field data may give names and colors: `LabelValues` (integers) and, with an entry for each
 *   value, `LabelNames` (strings) and `LabelColors` (3 components, 0 to 1, or unsigned char 0 to
 *   255).
 *
 * @par Output:
 * World coordinates.
 * - Port 0: a vtkMultiBlockDataSet with a vtkPolyData per label, sorted by label. A block is named
 *   by the label's name, or `Label 3`. With Merge there is one block, named `Labels 1, 3`. A label
 *   without a surface has an empty block.
 * - Port 1, `Interfaces`: a vtkPolyData with each triangle once. Its cells are the segments of
 *   junction lines, where three or more labels meet (including background), then the triangles.
 *
 * @par Arrays of blocks:
 * The arrays and field data of vtkDeformableSurface, and
 * - cell data `Label` (int): the label, with Merge the label of the nearest merged voxel
 * - point data `GlobalIds` (vtkIdType): index of the point at port 1
 * - field data with an entry for the label, or for each merged label: `Label` (int), `LabelName`
 *   (string), `LabelColor` (double, 3, 0 to 1), `LabelVoxels` (vtkIdType)
 * - field data `WrongVoxels` (vtkIdType): number of misclassified voxels. Their centers are voxels
 *   of the label outside the surface, or other voxels inside it.
 * - field data `MissedVoxels` (vtkIdType): number of misclassified voxels that are farther from the
 *   surface than VoxelTolerance plus Tolerance
 * - field data `VolumeError` (double): enclosed volume divided by the volume of the voxels, minus 1
 * - field data `Parts` (vtkIdType): number of parts of the label, which are voxels joined by faces,
 *   edges or corners. Each part keeps its volume. With periodic BoxFaces the label as a whole does.
 * - field data `WrongParts` (vtkIdType): number of parts whose volume differs by more than a
 *   quarter
 * @par
 * `GlobalIds`, `Residual`, `Motionless`, `Contact` and the cell arrays of components have
 * vtkAbstractArray::GUI_HIDE().
 *
 * @par Arrays of the interfaces:
 * - cell data `BoundaryLabels` (int, 2, as in vtkSurfaceNets3D): the label behind a triangle, and
 *   the label in front of it, to which its normal points. BackgroundLabel stands for labels that
 *   are not selected. Lines have it twice. With Merge the label behind is that of the nearest
 *   voxel.
 * - cell data `BoxFace` (unsigned char, also of blocks), with flat or periodic BoxFaces: the image
 *   side that the triangle lies in, 1 x-min, 2 x-max, 3 y-min, 4 y-max, 5 z-min, 6 z-max, 0 none
 * - point data `Junction` (unsigned char): 0 on an interface, 1 on a junction line, 2 at line ends
 * - point data `EdgeSize` (float, world units): requested edge length, with Tolerance
 * - field data `Label`, `LabelName`, `LabelColor`, `LabelVoxels`: an entry for each label
 * - field data `WorstAngle` (double, degrees), `WorstAnglePosition` (double, 3): the smallest angle
 *   between two interfaces at a junction line, and its position
 * - field data `SmallContacts` (int): number of contacts of two labels that are a single triangle
 *
 * @par Field data of port 0:
 * - `LostLabels` (string), only if labels are not represented well. It names labels without a
 *   surface, labels with more than half of their voxels missed, labels of at least 100 voxels with
 *   a VolumeError of more than 0.03, and labels with WrongParts. The filter also warns if labels of
 *   the first three kinds have more than 5 % of the labels' voxels.
 *
 * @par Connectivity:
 * Labels are ranked: fewest voxels first, then the lower number. Background is last. Voxels of a
 * label are connected
 * - through their faces
 * - through an edge with two opposite voxels of the label, if the other two voxels have two
 *   different labels, or both have a label of later rank
 * - through a corner only if each of four labels has two opposite voxels of the eight, and the
 *   label is the first of the four in rank
 *
 * @par Selection:
 * The filter meshes all labels of the map. The surface of a label is bit-identical for any
 * selection of labels. Exceptions: Merge unites labels before meshing, KeepComponents changes
 * voxels of the selected labels, and a selected BackgroundLabel is meshed as a label. Time and
 * memory grow with the interfaces of all labels.
 *
 * @par Errors:
 * On error the filter invokes `ErrorEvent`, produces empty outputs and sets GetErrorCode(), as
 * vtkDeformableSurface. It warns before meshing if the map looks like a scan: if it has more than
 * 256 labels, and more than a third of the neighboring voxels along x differ.
 *
 * @par Cancelling:
 * The filter tests AbortExecute several times a second. It then outputs the current mesh with
 * `StopReason` `cancelled`, or empty blocks if there is no mesh yet. The next run restarts.
 *
 * @par Processes:
 * In a parallel run, as in pvserver and pvbatch, the first process (piece 0) computes all surfaces
 * and reports errors. The others read the whole label map, too, and have null blocks.
 *
 * @sa
 * vtkVolumeToSurface vtkLabelTable vtkSurfaceNets3D
 */
#ifndef vtkLabelsToSurfaces_h
#define vtkLabelsToSurfaces_h

#include "vtkFiltersVolumicModule.h" // For export macro
#include "vtkMultiBlockDataSetAlgorithm.h"
#include "vtkVolumicPropertyMacros.h" // For volumicPropertyMacro

#include <memory> // For std::unique_ptr

class vtkDataObject;
class vtkMultiBlockDataSet;
class vtkPolyData;
namespace volumic
{
class RunObserver;
}

class VTKFILTERSVOLUMIC_EXPORT vtkLabelsToSurfaces : public vtkMultiBlockDataSetAlgorithm
{
public:
  static vtkLabelsToSurfaces* New();
  vtkTypeMacro(vtkLabelsToSurfaces, vtkMultiBlockDataSetAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Space in which edge lengths are uniform, as in vtkDeformableSurface.
  enum MetricType
  {
    Voxels = 0,
    World = 1
  };
  /// Shape of surfaces at the border of the image.
  enum BoxFacesType
  {
    Rounded = 0,
    Flat = 1,
    Periodic = 2
  };

  ///@{
  /**
   * Add a label that gets a surface. Without any, all labels except BackgroundLabel get one. It is
   * an error if the image does not have the label. Order and repetitions have no effect.
   */
  void AddLabel(int label);
  /** Remove all selected labels. */
  void ClearLabels();
  /** Return the number of selected labels. */
  int GetNumberOfLabels();
  /** Return a selected label, or BackgroundLabel if the index is out of range. */
  int GetLabel(int index);
  /** Set/Get the label that denotes background (default: 0). It gets a surface only if selected. */
  volumicPropertyMacro(BackgroundLabel, int);
  /**
   * Set/Get whether the selected labels are united into one surface before meshing (default: off).
   */
  volumicBooleanPropertyMacro(Merge);
  ///@}

  ///@{
  /**
   * Set/Get the standard deviation of the Gaussian that smooths the labels in smallest voxel
   * spacings, 0 to 10 (default: 2). The unit is 5/8 of the largest spacing if that is more. The
   * length is the same along all axes. 0 leaves voxel steps. Topology and volumes do not depend on
   * it. More than 3 changes little unless boundaries are rough.
   */
  volumicPropertyMacro(Smoothing, double);
  /**
   * Set/Get the allowed distance of a misclassified voxel center from the surface in smallest voxel
   * spacings, at most 1 (default -1: automatic). Automatic: a quarter of Smoothing, at most 1. 0.5
   * smooths the steps of noise and resampling. 0 constrains all centers as far as triangles can.
   */
  volumicPropertyMacro(VoxelTolerance, double);
  /**
   * Set/Get the shape of surfaces at the border of the image (default: Rounded).
   * - Rounded: closed as elsewhere, about half a voxel beyond the outermost centers
   * - Flat: exactly in the planes half a voxel beyond the outermost centers, see `BoxFace`. Edges
   *   of the box and boundary loops of its faces are junction lines, and corners have `Junction` 2.
   * - Periodic: flat, and opposite sides have the same triangles with bit-identical coordinates.
   *   The image is one period. It is an error if labels do not continue on the other side.
   */
  volumicPropertyMacro(BoxFaces, int);
  void SetBoxFacesToRounded() { this->SetBoxFaces(Rounded); }
  void SetBoxFacesToFlat() { this->SetBoxFaces(Flat); }
  void SetBoxFacesToPeriodic() { this->SetBoxFaces(Periodic); }
  ///@}

  ///@{
  /**
   * Set/Get the space in which edge lengths are uniform, as in vtkDeformableSurface (default:
   * World).
   */
  volumicPropertyMacro(Metric, int);
  void SetMetricToVoxels() { this->SetMetric(Voxels); }
  void SetMetricToWorld() { this->SetMetric(World); }
  /** Set/Get the mean edge length in world units (default 0: from FinestLevel). */
  volumicPropertyMacro(EdgeLength, double);
  /**
   * Set/Get the level that determines the edge length if EdgeLength is 0 (default: 0). Level 0 has
   * triangles as large as voxels. Each further level has sqrt(3) times longer edges, level -1
   * sqrt(3) times shorter ones.
   */
  volumicPropertyMacro(FinestLevel, int);
  /**
   * Set/Get the largest distance from the interfaces that longer edges may cause, in world units
   * (default 0: uniform edges). Volumes remain those of the voxels. Junction lines move by at most
   * this distance.
   */
  volumicPropertyMacro(Tolerance, double);
  /** Set/Get the maximum edge length with Tolerance in world units (default 0: automatic). */
  volumicPropertyMacro(MaximumEdgeLength, double);
  /**
   * Set/Get the growth of the edge length per distance with Tolerance, in (0, 0.3] (default: 0.2).
   */
  volumicPropertyMacro(Gradation, double);
  ///@}

  ///@{
  /**
   * Set/Get the components of each selected label to keep (default: 0, AllComponents). Other values
   * are LargestComponent (1) and LargeComponents (3), of at least MinimumComponentVolume, as in
   * vtkDeformableSurface. Components are voxels joined by faces, edges or corners. Voxels of
   * removed components become part of the neighbor that has most of their faces.
   */
  volumicPropertyMacro(KeepComponents, int);
  /** Set/Get the minimum volume of LargeComponents in world units cubed (default: 0). */
  volumicPropertyMacro(MinimumComponentVolume, double);
  ///@}

  ///@{
  /**
   * Set/Get the maximum time in seconds from the start of RequestData() (default 0: none). Then the
   * run ends as a cancelled one, but with `StopReason` `time limit`.
   */
  volumicPropertyMacro(TimeLimit, double);
  /** Set/Get the number of threads, as in vtkImagePyramid (default 0: all). */
  volumicPropertyMacro(NumberOfThreads, int);
  /** Set/Get the directory for large arrays in memory-mapped files (default empty: in memory). */
  volumicPropertyMacro(ScratchDirectory, const char*);
  /**
   * Deprecated, without effect (default: 0). Set ScratchDirectory, and limit memory by the cgroup.
   */
  volumicPropertyMacro(MemoryLimit, int);
  /**
   * Deprecated, without effect (default: on): interfaces are always shared. It will be removed in
   * the next release.
   */
  volumicBooleanPropertyMacro(SharedInterfaces);
  ///@}

  ///@{
  /** Set the name of a label, for its block. It overrides the name in the image. Empty: none. */
  void SetLabelName(int label, const char* name);
  /** Return the name that SetLabelName() has set, or an empty string. */
  const char* GetLabelName(int label);
  /** Remove all names. */
  void ClearLabelNames();
  /** Set the color of a label, 0 to 1, for `LabelColor`. It overrides the color in the image. */
  void SetLabelColor(int label, double red, double green, double blue);
  /** Remove all colors. */
  void ClearLabelColors();
  ///@}

  /** Return output port 1. */
  vtkPolyData* GetInterfaces();

#ifndef __VTK_WRAP__ // Not a property.
  /** Has no effect unless the filter is running. */
  void SetAbortExecute(vtkTypeBool abort) override;
#endif

protected:
  vtkLabelsToSurfaces();
  ~vtkLabelsToSurfaces() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

private:
  class vtkInternals;
  /** Fill the outputs. Throw an exception on error. */
  void MakeSurfaces(
    vtkDataObject* input, vtkInformationVector* outputs, volumic::RunObserver& observer);
  /** Make null blocks with the names of the first process. Make none if the input is invalid. */
  void MakeEmptyBlocks(vtkInformationVector* input, vtkMultiBlockDataSet* output);
  std::unique_ptr<vtkInternals> Internals; ///< the properties

  vtkLabelsToSurfaces(const vtkLabelsToSurfaces&) = delete;
  void operator=(const vtkLabelsToSurfaces&) = delete;
};

#endif
