// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkLabelsToSurfaces
 * @brief   a smooth closed surface about each label of a label map
 *
 * vtkLabelsToSurfaces makes surfaces of a segmented image, whose voxels are numbers of objects
 * (labels), drawn by hand or by a network. Each label gets a surface of its own that is closed,
 * oriented, manifold, free of self-intersections and smooth, with well-shaped triangles, and has
 * the centres of the label's voxels inside and all others outside, as far as the triangles can:
 * `WrongVoxels` tells how many they miss. What is thin is not smoothed away.
 *
 * @par Input:
 * Port 0: a vtkImageData with integers of any type, of one component, as point data (voxels are
 * points) or cell data (voxels are cells), chosen by SetInputArrayToProcess(), by default the
 * active scalars. Floating-point numbers within a hundredth of integers serve, NaN as background,
 * and labels that no int holds are numbered anew and named by what they were, all with a warning.
 * A composite dataset with one image in it serves as that image. Names and colours of labels may
 * come with the image as arrays of its field data: `LabelValues` (integers) and, with an entry for
 * each of these, `LabelNames` (strings) and `LabelColors` (3 components, 0 to 1; as unsigned char
 * 0 to 255).
 *
 * @par Output:
 * World coordinates. Port 0: a vtkMultiBlockDataSet, a block (vtkPolyData) per label, in the order
 * of the labels' values, named by the label's name, or `Label 3`; with Merge one block, named
 * `Labels 1, 3`, or `Label 3`. A label that asks for more than the triangles can hold has an empty
 * block.
 *
 * Arrays and field data of each block as vtkDeformableSurface has them, and:
 * - cell data `Label` (int): with Merge, that of the nearest voxel of the merged ones
 *
 * and field data, with an entry for the label, with Merge for each that was merged:
 * - `Label` (int)
 * - `LabelName` (string)
 * - `LabelColor` (double, 3 components, 0 to 1): as given, or one of a fixed palette
 * - `LabelVoxels` (vtkIdType): voxels of the label
 * - `WrongVoxels` (vtkIdType): those of the label that have their centres outside, and those of
 *   others that have them inside; with Gap, those that it puts there count, too
 * - `MissedVoxels` (vtkIdType): those of them that are further from the surface than VoxelTolerance
 *   and Tolerance together
 * - `VolumeError` (double): by which share of the voxels' volume the enclosed volume is more
 *
 * Field data of the whole, only where there is anything to tell:
 * - `LostLabels` (string): which labels are lost, of which more voxels than half are on the wrong
 *   side by more than the tolerances, and of which, of 100 voxels or more, the volume is further
 *   than .03 from theirs; a warning, too, where these are more than 5 % of the labels' voxels
 *
 * Port 1, `Interfaces`: a vtkPolyData, empty but with SharedInterfaces. Its points are those of the
 * blocks, whose point data `GlobalIds` (vtkIdType) then say which. Its cells are the segments of
 * junction lines, where three labels or more meet (outside is one of them), then triangles.
 * - cell data `BoundaryLabels` (int, 2 components, as vtkSurfaceNets3D has them): the label behind
 * a triangle, and that which its normal points to, BackgroundLabel where that is outside; of a line
 *   BackgroundLabel twice. With Merge the label behind is that of the nearest voxel.
 * - cell data `BoxFace` (unsigned char), with flat BoxFaces, of blocks, too: at which side of the
 *   image a triangle is, along its axes: 1 x-min, 2 x-max, 3 y-min, 4 y-max, 5 z-min, 6 z-max; 0:
 * none
 * - point data `Junction` (unsigned char): 0 on an interface, 1 on a junction line, 2 where lines
 *   meet or end
 * - point data `EdgeSize` (float): with Tolerance, the length of edges that is wanted there
 * - field data `Label`, `LabelName`, `LabelColor`, `LabelVoxels`: with an entry for each label
 * - field data `WorstAngle` (double, degrees), `WorstAnglePosition` (double, 3 components): the
 *   least angle between two interfaces about a junction line, and where that is; only where there
 *   are lines, as the next one
 * - field data `SmallContacts` (int): how many triangles have junction lines on all sides. Two
 *   labels touch by one alone there, and lines cannot be straight
 *
 * @par Algorithm:
 * What is not the paper's. The field of which vtkDeformableSurface takes the isopotential is made
 * of each label by itself, see Core/Labels/LabelField.h: its membership, smoothed by a Gaussian, as
 * a distance; corrected so that as much volume is inside near each place as there is in voxels;
 * then held to the labels by the smallest correction (of a Gaussian kernel's norm) that gives all
 * voxel centres the right sign. Where three labels meet, that of the others' that claim the place
 * most is taken off, so that fields of two labels are never both positive: also what labels claim
 * that are not among Labels, so that a label has the same surface whichever others are made. The
 * surface starts as the field's iso-surface at FinestLevel, so that no part is lost by coarser
 * levels. What level 0 does not hold, a label or eight voxels of it or more that stick out, makes
 * level -1 do this label, where nothing else is asked for; its field data `Level` tells.
 * @par
 * Only the voxels about a label are worked on. Labels are made side by side by the threads; results
 * do not depend on their number.
 *
 * @par Errors:
 * As vtkDeformableSurface: the message names the port, the array or the value, and the way out; the
 * output is empty; ask GetErrorCode() after Update(). With Gap a warning tells of which labels
 * triangles touch those of neighbours, or lie within them, all the same.
 *
 * @par Progress:
 * GetProgressText() tells how many surfaces are finished and which is under way, of several the one
 * begun last: `12 of 39, liver`.
 *
 * @par Cancelling:
 * AbortExecute is looked at several times a second: surfaces that are finished then are handed
 * over, that under way has `StopReason` `cancelled`, others are empty blocks with that reason.
 * GoOn() has the next Update() make what is missing, and keep the finished ones, where neither the
 * filter nor its input has changed (without Gap; with it all are made again). TimeLimit ends a run
 * in the same way, and another limit has it go on.
 *
 * @par Processes:
 * Where the controller has several processes, and each asks for the piece of its own number of as
 * many pieces, as ParaView's do, each makes the surfaces of some labels, the largest going first to
 * the process that has least to do. The first one takes the image together, gives the others the
 * labels of its voxels, and gets all surfaces, the same bits; the others have the same blocks,
 * empty. An error of one process is reported by all; AbortExecute of any stops all. Whoever asks
 * for other pieces works alone.
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
class vtkMultiProcessController;
class vtkPolyData;
namespace volumic
{
class Ranks;
struct FilterCall;
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
   * Labels: those that get a surface; none, the default: all that the image has, but for
   * BackgroundLabel. One that the image has not is an error that names those that it has. The order
   * does not matter, nor does adding one twice. An index that is none gives BackgroundLabel.
   */
  void AddLabel(int label);
  void ClearLabels();
  int GetNumberOfLabels();
  int GetLabel(int index);
  ///@}

  ///@{
  /**
   * The label that is nothing: it gets no surface where all others do. Default: 0.
   */
  void SetBackgroundLabel(int label);
  int GetBackgroundLabel();
  ///@}

  ///@{
  /**
   * One surface about all Labels together, instead of one about each. Default: off.
   */
  void SetMerge(bool merge);
  bool GetMerge();
  vtkBooleanMacro(Merge, bool);
  ///@}

  ///@{
  /**
   * Standard deviation of the Gaussian that smooths the labels, the same length along all axes, in
   * smallest distances of voxels, or, where that is more, in 5/8 of the longest; 0: none, stairs
   * stay; at most 10. What it would take away is held: more smoothing makes smoother surfaces
   * between the voxels' centres, not other objects. Default: 2.
   */
  void SetSmoothing(double voxels);
  double GetSmoothing();
  ///@}

  ///@{
  /**
   * How far the centre of a voxel may be on the wrong side of the surface, in smallest distances of
   * voxels, at most 1. With .5 what is one voxel high or deep, as noise and the stairs of resampled
   * maps, becomes smooth; volumes stay, and so does what is thin: a centre may be wrong only where
   * the surface is so near. 0: none is, as far as triangles can: each voxel of a rough label sticks
   * out. A label that loses parts, or volume, is made with 0, and then, if that does not hold the
   * parts, with finer triangles. Default: .5.
   */
  void SetVoxelTolerance(double voxels);
  double GetVoxelTolerance();
  ///@}

  ///@{
  /**
   * Space between the surfaces of neighbouring labels, world units: each is drawn back by half of
   * it, also from the background. At most eight times the smallest distance of voxels. All surfaces
   * are tested against their neighbours, exactly; those that touch, or have parts of others
   * inside, are made again, further inside there, up to five times. Default: 0: they touch, and may
   * overlap by what their triangles cut off differently.
   */
  void SetGap(double gap);
  double GetGap();
  ///@}

  ///@{
  /**
   * One mesh of all labels, in which neighbours have the same triangles between them, instead of
   * surfaces that overlap, or leave a gap: no pair of its triangles intersects, what is between two
   * labels is there once, at output port 1, and each block of port 0 is a closed surface of the
   * same points. What nobody has chosen is outside. Volumes are those of the voxels. KeepComponents
   * leaves parts out by their voxels, and gives these to the neighbour that has most of their
   * faces. The first process makes them. A run that was stopped hands over all surfaces as they are
   * by then, or, before there are any, empty blocks; afterwards all is made anew. Not with Gap or
   * ThinParts. Default: off.
   */
  void SetSharedInterfaces(bool shared);
  bool GetSharedInterfaces();
  vtkBooleanMacro(SharedInterfaces, bool);
  ///@}

  ///@{
  /**
   * What surfaces are where labels reach the border of the image. Rounded, the default: closed as
   * elsewhere, about half a voxel beyond the outermost centres. Flat, with SharedInterfaces only,
   * as boundary conditions of a box want it: exactly in the planes there; cell data `BoxFace` of
   * blocks and interfaces tell in which, edges of the box, and rims where labels end, are lines of
   * the interfaces, and corners are points of Junction 2. Periodic: flat, and opposite sides have
   * the same triangles, with bits of coordinates in common; the image is one period of a map in
   * which labels go on at the other side, which is checked.
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
   * As vtkDeformableSurface: graded triangles, world units. With SharedInterfaces faces keep to
   * where the fields of the labels on both sides are the same, volumes are those of the voxels even
   * so, and junction lines are straightened by no more than the tolerance. Defaults: 0 (none), 0
   * and 0.2.
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
   * As vtkDeformableSurface: with FinestLevel 0 (or -1) what is thinner than triangles as large as
   * voxels can hold gets those of level -1, there alone; a label that loses more than single voxels
   * even so gets them everywhere, as without, and has no `EdgeSize` and `Thickness`. Default: off.
   */
  void SetThinParts(bool value);
  bool GetThinParts();
  vtkBooleanMacro(ThinParts, bool);
  ///@}

  ///@{
  /**
   * As vtkDeformableSurface: 0, the default: triangles as large as voxels; 1, 2, ...: each sqrt(3)
   * times larger; -1: sqrt(3) times smaller, from the start: for what is a voxel thin. With 0 a
   * label that loses more than single voxels gets these, too.
   */
  void SetFinestLevel(int level);
  int GetFinestLevel();
  ///@}

  ///@{
  /**
   * As vtkDeformableSurface, for each label: AllComponents (0, the default), LargestComponent (1)
   * or LargeComponents (3), of at least MinimumComponentVolume.
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
   * Seconds, from the start of RequestData(), after which a run ends as one that is cancelled does,
   * but with the `StopReason` `time limit`; 0, the default: none. With a new limit the next
   * Update() goes on.
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
  /** As vtkDeformableSurface: resident memory, MiB; 0, the default: no limit. */
  void SetMemoryLimit(int mebibytes);
  int GetMemoryLimit();
  ///@}

  ///@{
  /** As vtkDeformableSurface: with MemoryLimit, the folder for what does not fit. */
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

  ///@{
  /** As vtkDeformableSurface: the processes that make the surfaces together, see Processes. */
  void SetController(vtkMultiProcessController* controller);
  vtkMultiProcessController* GetController();
  ///@}

  /** Output port 1: see SharedInterfaces. */
  vtkPolyData* GetInterfaces();

  /**
   * Seconds that the work on the surface of a block took at the last update: of the one thread that
   * made it, or, of a large label, of all together. No field data, as these are the same at each
   * run. 0 for a block that is none.
   */
  double GetSeconds(int block);

  /** After a run that was stopped: the next Update() goes on, see Cancelling. */
  void GoOn();

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
  bool ShowProgress(double share, const std::string& text);
  /** Errors are thrown. */
  void MakeSurfaces(volumic::Ranks& ranks, const volumic::FilterCall& call);
  std::unique_ptr<vtkInternals> Internals; ///< the properties

  vtkLabelsToSurfaces(const vtkLabelsToSurfaces&) = delete;
  void operator=(const vtkLabelsToSurfaces&) = delete;
};

#endif
