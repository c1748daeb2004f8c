// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkLabelsToSurfaces
 * @brief   one conforming mesh of all labels of a label map, and a closed surface of each
 *
 * vtkLabelsToSurfaces meshes a segmented image, whose voxels are numbers of objects (labels). The
 * mesh has exactly the topology of the voxels, see Connectivity. It is conforming: neighbouring
 * labels share the triangles between them. It has no intersections, and the block of each label is
 * closed and manifold. No part of a label is lost, and no labels are joined that do not touch.
 * Surfaces are smooth, have well-shaped triangles, and enclose the volume of the voxels.
 *
 * @par Input:
 * Port 0: a vtkImageData with integers of any type, of one component, as point data (voxels are
 * points) or cell data (voxels are cells), chosen by SetInputArrayToProcess(), by default the
 * active scalars. The filter rounds floating-point numbers within a hundredth of integers, takes
 * NaN as background, and renumbers labels that no int holds, each with a warning. It also accepts a
 * composite dataset with one image. Names and colours of labels may come as arrays of the image's
 * field data: `LabelValues` (integers) and, with an entry for each of these, `LabelNames` (strings)
 * and `LabelColors` (3 components, 0 to 1; as unsigned char 0 to 255).
 *
 * @par Output:
 * World coordinates. Port 0: a vtkMultiBlockDataSet with a block (vtkPolyData) per label, in the
 * order of the labels' values, named by the label's name, or `Label 3`; with Merge one block, named
 * `Labels 1, 3`. A label without a surface has an empty block.
 *
 * Arrays and field data of each block as of vtkDeformableSurface, and:
 * - cell data `Label` (int): with Merge, that of the nearest voxel of the merged ones
 * - point data `GlobalIds` (vtkIdType): the point of port 1
 *
 * `GlobalIds`, `Residual`, `Motionless`, `Contact` and the cell arrays of components have
 * vtkAbstractArray::GUI_HIDE(): ParaView does not offer them.
 *
 * and field data, with an entry for the label, with Merge for each merged one:
 * - `Label` (int), `LabelName` (string)
 * - `LabelColor` (double, 3 components, 0 to 1): as given, or one of a fixed palette
 * - `LabelVoxels` (vtkIdType): voxels of the label
 * - `WrongVoxels` (vtkIdType): misclassified voxels: centres of the label's voxels outside, of
 *   others inside
 * - `MissedVoxels` (vtkIdType): those of them that are further from the surface than VoxelTolerance
 *   and Tolerance together
 * - `VolumeError` (double): enclosed volume over the voxels' volume, less 1
 * - `Parts` (vtkIdType): parts of the label, voxels joined by faces, edges or corners, each of which
 *   is to keep its volume; with periodic BoxFaces the label as a whole is
 * - `WrongParts` (vtkIdType): those whose enclosed volume is off by more than a quarter
 *
 * Field data of the whole, only where there is anything to report:
 * - `LostLabels` (string): labels without a surface, labels with more than half of their voxels
 *   missed, labels of 100 voxels or more whose VolumeError exceeds .03, and labels with WrongParts.
 *   It is a warning, too, where the first three are more than 5 % of the labels' voxels.
 *
 * Port 1, `Interfaces`: a vtkPolyData, each triangle once. Its cells are the segments of junction
 * lines, where three labels or more meet (background is one of them), then the triangles.
 * - cell data `BoundaryLabels` (int, 2 components, as of vtkSurfaceNets3D): the label behind a
 *   triangle, and the label that its normal points to. BackgroundLabel stands for all that is not
 *   selected; a line has it twice. With Merge the label behind is that of the nearest voxel.
 * - cell data `BoxFace` (unsigned char), with flat BoxFaces, of blocks, too: the side of the image
 *   that a triangle lies in, 1 x-min, 2 x-max, 3 y-min, 4 y-max, 5 z-min, 6 z-max; 0: none
 * - point data `Junction` (unsigned char): 0 on an interface, 1 on a junction line, 2 where lines
 *   meet or end
 * - point data `EdgeSize` (float): with Tolerance, the requested edge length
 * - field data `Label`, `LabelName`, `LabelColor`, `LabelVoxels`: with an entry for each label
 * - field data `WorstAngle` (double, degrees), `WorstAnglePosition` (double, 3 components): the
 *   least angle between two interfaces about a junction line, and its position; only with lines
 * - field data `SmallContacts` (int): triangles with junction lines on all sides, by one of which
 *   alone two labels touch; only with lines
 *
 * @par Connectivity:
 * A label holds together through the faces of voxels. Through an edge of a voxel it holds together
 * if its two voxels are opposite there, and the other two are of two different labels, or both of
 * one label of later rank. Ranks: fewest voxels first, then the lower number; background last.
 * Through a corner it does not hold together, except in one pattern: four labels, each with two
 * opposite voxels of the eight; there the first in rank does.
 *
 * @par Selection:
 * The mesh is made of all labels of the map, whichever are selected: the surface of a label is
 * bit-identical for any selection. Exceptions: Merge unites labels before meshing, KeepComponents
 * changes voxels of the selected labels, and BackgroundLabel, if selected, is a label. Time and
 * memory grow with the interfaces of all labels.
 *
 * @par Errors:
 * As vtkDeformableSurface: on error the filter invokes `ErrorEvent`, produces empty outputs and
 * sets GetErrorCode(). A map looks like a scan if it has more than 256 labels and more than a third
 * of the neighbouring voxels along x differ. The filter warns of it before meshing begins.
 *
 * @par Cancelling:
 * The filter tests AbortExecute several times a second. It then outputs the mesh as it is, whose
 * blocks have `StopReason` `cancelled`, or, before there is a mesh, empty blocks with that reason.
 * TimeLimit ends a run in the same way. The next run starts anew.
 *
 * @par Processes:
 * In a parallel run, as in pvserver and pvbatch, the first process (piece 0) makes all surfaces. The
 * others read the whole label map, too, and have the same blocks without surfaces. The first process
 * reports errors.
 *
 * @sa
 * vtkVolumeToSurface vtkLabelTable
 */
#ifndef vtkLabelsToSurfaces_h
#define vtkLabelsToSurfaces_h

#include "vtkFiltersVolumicModule.h" // For export macro
#include "vtkMultiBlockDataSetAlgorithm.h"

#include <memory> // For what is hidden

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

  /// As vtkDeformableSurface::MetricType.
  enum MetricType
  {
    Voxels = 0,
    World = 1
  };

  enum BoxFacesType
  {
    Rounded = 0,
    Flat = 1,
    Periodic = 2
  };

  ///@{
  /**
   * Labels that get a surface; none, the default: all labels of the image except BackgroundLabel.
   * The filter reports an error for a label that the image does not have. Order and repetitions
   * have no effect. GetLabel() returns BackgroundLabel if the index is out of range.
   */
  void AddLabel(int label);
  void ClearLabels();
  int GetNumberOfLabels();
  int GetLabel(int index);
  ///@}

  ///@{
  /**
   * Label that denotes background; no surface is generated for it unless it is one of Labels.
   * Default: 0.
   */
  void SetBackgroundLabel(int label);
  int GetBackgroundLabel();
  ///@}

  ///@{
  /**
   * Unite Labels before meshing, into one surface. Default: off.
   */
  void SetMerge(bool merge);
  bool GetMerge();
  vtkBooleanMacro(Merge, bool);
  ///@}

  ///@{
  /**
   * Standard deviation of the Gaussian that smooths the labels, the same length along all axes, in
   * smallest voxel spacings, or, where that is more, in 5/8 of the largest. 0: none, stairs stay.
   * At most 10. Topology and volumes do not depend on it. More than 3 changes little unless
   * boundaries are rough. Default: 2.
   */
  void SetSmoothing(double voxels);
  double GetSmoothing();
  ///@}

  ///@{
  /**
   * Distance by which the centre of a voxel may be on the wrong side of the surface, in smallest
   * voxel spacings, at most 1. With .5 the steps that noise and resampling leave become
   * smooth. With 0 no centre is, as far as triangles can. -1, the default: a quarter of Smoothing,
   * at most 1.
   */
  void SetVoxelTolerance(double voxels);
  double GetVoxelTolerance();
  ///@}

  ///@{
  /**
   * Has no effect: labels always share their interfaces. It leaves with the next release.
   * Default: on.
   */
  void SetSharedInterfaces(bool shared);
  bool GetSharedInterfaces();
  vtkBooleanMacro(SharedInterfaces, bool);
  ///@}

  ///@{
  /**
   * Shape of surfaces where labels reach the border of the image. Rounded, the default: closed as
   * elsewhere, about half a voxel beyond the outermost centres. Flat: exactly in the planes there.
   * Cell data `BoxFace` gives the plane, edges of the box and boundary loops of its faces are lines
   * of the interfaces, and corners are points of Junction 2. Periodic: flat, and opposite sides
   * have the same triangles, with bit-identical coordinates. The image is then one period of a map,
   * and the filter reports an error if labels do not continue on the other side.
   */
  void SetBoxFaces(int value);
  int GetBoxFaces();
  void SetBoxFacesToRounded() { this->SetBoxFaces(Rounded); }
  void SetBoxFacesToFlat() { this->SetBoxFaces(Flat); }
  void SetBoxFacesToPeriodic() { this->SetBoxFaces(Periodic); }
  ///@}

  ///@{
  /** As vtkDeformableSurface. Default: World. */
  void SetMetric(int value);
  int GetMetric();
  void SetMetricToVoxels() { this->SetMetric(Voxels); }
  void SetMetricToWorld() { this->SetMetric(World); }
  ///@}

  ///@{
  /** As vtkDeformableSurface: mean length of edges, world units; 0, the default: by FinestLevel. */
  void SetEdgeLength(double length);
  double GetEdgeLength();
  ///@}

  ///@{
  /**
   * As vtkDeformableSurface: graded triangles, world units. Volumes remain those of the voxels, and
   * junction lines are straightened by at most the tolerance. Defaults: 0 (none), 0 and 0.2.
   */
  void SetTolerance(double value);
  double GetTolerance();
  void SetMaximumEdgeLength(double value);
  double GetMaximumEdgeLength();
  void SetGradation(double value);
  double GetGradation();
  ///@}

  ///@{
  /**
   * Edge length, if EdgeLength is 0, as of vtkDeformableSurface. 0, the default: as for voxels; 1,
   * 2, ...: each sqrt(3) times longer; -1: sqrt(3) times shorter.
   */
  void SetFinestLevel(int level);
  int GetFinestLevel();
  ///@}

  ///@{
  /**
   * As vtkDeformableSurface, for each selected label: AllComponents (0, the default),
   * LargestComponent (1) or LargeComponents (3), of at least MinimumComponentVolume. Components are
   * those of voxels joined by faces, edges or corners. Voxels left out become part of the neighbour
   * that has most of their faces.
   */
  void SetKeepComponents(int value);
  int GetKeepComponents();
  ///@}

  ///@{
  /** As vtkDeformableSurface, world units cubed. Default: 0. */
  void SetMinimumComponentVolume(double volume);
  double GetMinimumComponentVolume();
  ///@}

  ///@{
  /**
   * Seconds after the start of RequestData() at which a run ends as a cancelled one does, but with
   * the `StopReason` `time limit`; 0, the default: none.
   */
  void SetTimeLimit(double seconds);
  double GetTimeLimit();
  ///@}

  ///@{
  /** As vtkDeformableSurface: 0, the default: all. */
  void SetNumberOfThreads(int number);
  int GetNumberOfThreads();
  ///@}

  ///@{
  /** Deprecated, as vtkDeformableSurface::SetMemoryLimit(): has no effect. */
  void SetMemoryLimit(int mebibytes);
  int GetMemoryLimit();
  ///@}

  ///@{
  /** As vtkDeformableSurface: folder on a disk for large arrays; empty (the default): none. */
  void SetScratchDirectory(const char* directory);
  const char* GetScratchDirectory();
  ///@}

  ///@{
  /**
   * The name of a label, for its block; empty: none. It goes before one that comes with the image.
   */
  void SetLabelName(int label, const char* name);
  const char* GetLabelName(int label);
  void ClearLabelNames();
  ///@}

  ///@{
  /**
   * The colour of a label, 0 to 1, for `LabelColor`. It goes before one that comes with the image.
   */
  void SetLabelColor(int label, double red, double green, double blue);
  void ClearLabelColors();
  ///@}

  /** Return output port 1. */
  vtkPolyData* GetInterfaces();

#ifndef __VTK_WRAP__ // It is no property of ours.
  /** As of all algorithms, but while no run is under way it asks for and changes nothing. */
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
  /** Errors are thrown. */
  void MakeSurfaces(
    vtkDataObject* input, vtkInformationVector* outputs, volumic::RunObserver& observer);
  /** The blocks of the first process without surfaces; none if the input is refused. */
  void MakeEmptyBlocks(vtkInformationVector* input, vtkMultiBlockDataSet* output);
  std::unique_ptr<vtkInternals> Internals; ///< the properties

  vtkLabelsToSurfaces(const vtkLabelsToSurfaces&) = delete;
  void operator=(const vtkLabelsToSurfaces&) = delete;
};

#endif
