// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDeformableSurface
 * @brief   segment a 3D image with a closed surface that evolves on a pyramid, from coarse to fine
 *
 * vtkDeformableSurface computes the boundary of an object in a 3D image: the isosurface of IsoValue
 * in the interpolated image. Every output surface is closed, oriented, manifold and free of
 * self-intersections, also if the run was stopped. Results are bit-identical for any number of
 * threads. Lengths are in world units. Documentation/reference.md describes all arrays in detail.
 *
 * @par Input:
 * - Port 0: a vtkMultiBlockDataSet from vtkImagePyramid, or a vtkImageData, for which the filter
 *   computes the pyramid with default settings. Each axis has at least 8 voxels.
 *   SetInputArrayToProcess() chooses the array (default: active point scalars). It may have any
 *   numeric type and absolute values of at most 1e37. Blanked voxels are background. Infinite
 *   voxels are an error.
 * - Port 1, optional: a vtkPolyData. With Initialization InputSurface its polygons are the initial
 *   surface, which must be closed, oriented outward, manifold and free of self-intersections. It is
 *   at most five times as wide as the image. With Initialization Seeds the points are seeds.
 * - Port 2, optional: a vtkPolyData with points known to belong to the object, see
 *   PointAttractionWeight. Optional point arrays: `Weight` (at least 0, default 1) and `Radius`
 *   (world units, default 0: two units of the level).
 * - Points of ports 1 and 2 are the points of vertex cells, or all points if there are no cells.
 *   Lines or polygons without vertex cells are an error.
 * - Edge map, optional, see EdgeAttractionWeight: a second point array of the image of port 0,
 *   chosen by SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name).
 *
 * @par Output:
 * - Port 0, `Surface`: vtkPolyData, the surface of the finest level that was reached.
 * - Port 1, `Levels`: vtkMultiBlockDataSet. Block h, named `Level h`, is the converged surface of
 *   level h. It is empty if the run did not reach the level. FinestLevel -1 adds a last block.
 * - Port 2, `History`: vtkTable, a row per iteration.
 * - Port 3, `Snapshots`: vtkMultiBlockDataSet of intermediate surfaces, see SnapshotInterval.
 *   Blocks are named `Level 3, iteration 20`.
 * @par
 * Points are in world coordinates (double). Triangles and normals are oriented outward.
 *
 * @par Point arrays:
 * - `Normals` (float, 3, active): unit normals
 * - `Residual` (float, units of the voxels): field minus IsoValue at the vertex
 * - `Motionless` (unsigned char): 1 for converged vertices; with vtkAbstractArray::GUI_HIDE()
 * - `Contact` (unsigned char): 1 where walls or gaps are thinner than the triangles can represent
 * - `EdgeSize` (float, world units): requested edge length, with Tolerance or ThinParts
 * - `Thickness` (float, world units): of the object or of the gap outside, the less, with ThinParts
 *
 * @par Cell arrays:
 * - `Component` (int): index of the component, 0 for the largest area
 * - `ComponentArea`, `ComponentVolume` (float), `ComponentGenus` (int): of that component
 *
 * @par Field data:
 * - `Level`, `StartLevel`, `Iterations` (int): level, level of the start, iterations at this level
 * - `Delta`, `Unit` (double, world units): delta and U of the level, see Algorithm
 * - `NumberOfComponents`, `EulerCharacteristic`, `Genus` (int), `Area`, `Volume` (double)
 * - `StopReason` (string): `converged`, `limit cycle` (also finished), `iteration limit`,
 *   `cancelled`, `time limit` or `vanished`
 * - `ContactVertices` (int): number of vertices with `Contact`
 * - `RemainingContacts` (int): number of pairs of vertices that are too close to each other
 * - `LargestDistance` (double, world units), `WithinTolerance` (double, 0 to 1): with Tolerance
 * - `ResidualQuantile` (double): 98th percentile of the absolute `Residual`
 * - `LostParts`, `RecoveredParts`, `LostCavities`, `RecoveredCavities`, `MissingParts` (int),
 *   `MissingBoundary` (double, 0 to 1): see Recovery
 * - `ComponentArea`, `ComponentVolume` (double), `ComponentGenus` (int): an entry per component
 * - `ComponentOwner` (int): index of the component, for a cavity of the component around it or -1
 * - `ComponentCentroid` (double, 3), `ComponentInertia` (double, 6): of the enclosed solid
 * - `Iteration` (int): in snapshots instead of `StopReason`, last row of the history then
 *
 * @par Columns of the history:
 * `Iteration` (from 1, over all levels), `Level`, `Vertices`, `KineticEnergy`, `MeanEdgeLength`,
 * `Seconds`, `TimeStep`, `ActiveVertices`, `Merges`, `Cuts`, `Splits`, `Collapses`, `Flips`,
 * `EulerCharacteristic`, `Components`.
 *
 * @par Algorithm:
 * The run starts at the coarsest level of an image pyramid. Forces move a closed triangulated
 * surface, which merges with itself and splits as the object requires, until it has converged. The
 * surface is then subdivided for the next finer level, and missed components are recovered. U is
 * the distance that one voxel of the level represents, and delta is SamplingRatio times U. At the
 * end of a level edges are between delta and 2.5 delta long.
 *
 * @par Errors:
 * On error the filter invokes `ErrorEvent`, produces empty outputs and sets GetErrorCode(): to
 * vtkErrorCode::UserError for an invalid input or property, to vtkErrorCode::UnknownError if memory
 * does not suffice. GetErrorCode() is 0 after a successful or cancelled run. The message names the
 * port, array or value and how to fix it. The executive reports a missing input, and other types at
 * ports 1 and 2.
 * @par
 * The filter warns at the end of a run of
 * - an empty surface, also if KeepComponents selects no component
 * - NaN voxels, with their number
 * - a `MissingBoundary` of more than 0.05 at the finest level. There is no such warning with
 *   Preview, without Recovery, and if KeepComponents or seeds select components.
 *
 * @par Cancelling:
 * The filter tests AbortExecute several times a second. It then outputs the current surface with
 * `StopReason` `cancelled`, or an empty one at the start. The output counts as up to date. Call
 * GoOn() to resume, or Modified() to restart.
 *
 * @par Resuming:
 * The filter keeps its last run. If only FinestLevel, Preview, ShowLevels, TimeLimit,
 * ScratchDirectory or NumberOfThreads change, it outputs a finished level at once, and resumes a
 * run that ended at level 1 or above. The result is bit-identical to the result of a new run.
 * ForgetRun(), errors and the release of data free the kept run.
 *
 * @par Memory:
 * Voxels keep their type, and input voxels are not copied. With ScratchDirectory, large arrays are
 * memory-mapped from unnamed files there, output arrays until they are freed. A full disk is an
 * error. Limit the memory of a process by its cgroup: `systemd-run --user --scope -p MemoryMax=2G`.
 *
 * @par Processes:
 * In a parallel run, as in pvserver and pvbatch, the first process (piece 0) requests the whole of
 * all inputs and computes the whole surface. The other processes have null blocks for the levels.
 * Their other outputs are empty, and ShowLevels has no effect.
 *
 * @par Thanks:
 * J.-O. Lachaud and A. Montanvert, "Volumic Segmentation using Hierarchical Representation and
 * Triangulated Surface", ECCV 1996. Documentation/differences.md lists the differences.
 *
 * @sa vtkImagePyramid vtkVolumeToSurface vtkFlyingEdges3D
 */
#ifndef vtkDeformableSurface_h
#define vtkDeformableSurface_h

#include "vtkFiltersVolumicModule.h" // For export macro
#include "vtkPolyDataAlgorithm.h"
#include "vtkVolumicPropertyMacros.h" // For volumicPropertyMacro

#include <vtkSmartPointer.h> // For NewLeftOutComponents()

#include <memory> // For std::unique_ptr

class vtkAlgorithmOutput;
class vtkDataObject;
class vtkInformation;
class vtkMultiBlockDataSet;
class vtkPolyData;
class vtkTable;

class VTKFILTERSVOLUMIC_EXPORT vtkDeformableSurface : public vtkPolyDataAlgorithm
{
public:
  static vtkDeformableSurface* New();
  vtkTypeMacro(vtkDeformableSurface, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Initial surface.
  enum InitializationType
  {
    EnclosingIcosahedron = 0,
    Seeds = 1,
    IsoSurface = 2,
    InputSurface = 3
  };
  /// Space in which edge lengths are uniform.
  enum MetricType
  {
    Voxels = 0,
    World = 1
  };
  /// Field outside the image.
  enum BorderValueType
  {
    Background = 0,
    Replicate = 1
  };
  /// Features missed by coarser levels to recover.
  enum RecoveryType
  {
    NoRecovery = 0,
    RecoverObjects = 1,
    RecoverObjectsAndCavities = 2
  };
  /// Components in the outputs.
  enum KeepComponentsType
  {
    AllComponents = 0,
    LargestComponent = 1,
    ComponentsAtPoints = 2,
    LargeComponents = 3,
    ComponentsNotAtSeeds = 4
  };

  ///@{
  /** Set/Get the isosurface value in the units of the voxels (default NaN: it must be set). */
  volumicPropertyMacro(IsoValue, double);
  /**
   * Set/Get whether the object is above IsoValue (default: on). Off: it is below. With UpperValue,
   * on means between the two values, and off means not between them.
   */
  volumicBooleanPropertyMacro(ObjectIsBright);
  /**
   * Set/Get the upper limit of the object's values, in the units of the voxels (default: infinite).
   * The filter then segments min(image, IsoValue + UpperValue - image). It reads only level 0 of an
   * input pyramid and recomputes the coarser levels.
   */
  volumicPropertyMacro(UpperValue, double);
  /** Set/Get whether UpperValue is used (default: on). */
  volumicBooleanPropertyMacro(UseUpperValue);
  /** Set/Get the component of the voxels, from 0 (default -1: the magnitude of all components). */
  volumicPropertyMacro(SelectedComponent, int);
  /** Set/Get whether NaN voxels are background, with a warning (default: on). Off: an error. */
  volumicBooleanPropertyMacro(NaNIsBackground);
  ///@}

  ///@{
  /**
   * Set/Get the space in which edge lengths are uniform if voxels are not cubes (default: World).
   * World: world coordinates. Voxels: an affine space in which voxels are cubes, so that triangles
   * are stretched like the voxels.
   */
  volumicPropertyMacro(Metric, int);
  void SetMetricToVoxels() { this->SetMetric(Voxels); }
  void SetMetricToWorld() { this->SetMetric(World); }
  /**
   * Set/Get the mean edge length at the finest level in world units (default 0: from FinestLevel
   * and SamplingRatio). It is met within about 10 %. If it is set, FinestLevel and SamplingRatio
   * have no effect.
   */
  volumicPropertyMacro(EdgeLength, double);
  /**
   * Set/Get the largest distance from the isosurface that longer edges may cause, in world units
   * (default 0: uniform edges). It applies to the finest level. Faces may be farther where the
   * uniform surface is, too. `WithinTolerance` and `LargestDistance` report it. Requires EdgeLength
   * 0 and SnapToIsoValue.
   */
  volumicPropertyMacro(Tolerance, double);
  /**
   * Set/Get the maximum edge length with Tolerance in world units (default 0: 10 delta). It is
   * clamped to 2.5 to 12.5 delta.
   */
  volumicPropertyMacro(MaximumEdgeLength, double);
  /**
   * Set/Get the growth of the edge length per distance, in (0, 0.3] (default: 0.2). It applies with
   * Tolerance or ThinParts.
   */
  volumicPropertyMacro(Gradation, double);
  /**
   * Set/Get whether thin parts are refined at level -1 (default: off). With FinestLevel 0 or -1 the
   * run continues to level -1. It subdivides only where the object or a gap is thinner than 2.5
   * delta, or the surface is off the isosurface. Requires EdgeLength 0 and SnapToIsoValue.
   */
  volumicBooleanPropertyMacro(ThinParts);
  /** Set/Get delta / U of each level (equation 7), between sqrt(3)/2.5 and 1 (default: 0.85). */
  volumicPropertyMacro(SamplingRatio, double);
  ///@}

  ///@{
  /**
   * Set/Get the level at which the run starts (default -1: automatic). Automatic: the last level if
   * it has any voxel of the object, else the coarsest level at which a part of the object has
   * MinimumPartSize voxels. Without Recovery: the coarsest level at which a surface can represent a
   * part. It is an error if the object is too thin at the start at all seeds or, without Recovery,
   * at one of them.
   */
  volumicPropertyMacro(CoarsestLevel, int);
  /**
   * Set/Get the level at which the run ends, at most CoarsestLevel (default 0: the input). -1: one
   * more subdivision, with sqrt(3) times shorter edges, on the field of level 0.
   */
  volumicPropertyMacro(FinestLevel, int);
  /**
   * Set/Get the initial surface (default: EnclosingIcosahedron).
   * - EnclosingIcosahedron: a rounded box around the image
   * - Seeds: see AddSeedPosition(); without any seeds icosahedra on a grid
   * - IsoSurface: a closed surface around the object, half a voxel outside its isosurface at the
   *   coarsest level
   * - InputSurface: the polygons of port 1
   */
  volumicPropertyMacro(Initialization, int);
  void SetInitializationToEnclosingIcosahedron() { this->SetInitialization(EnclosingIcosahedron); }
  void SetInitializationToSeeds() { this->SetInitialization(Seeds); }
  void SetInitializationToIsoSurface() { this->SetInitialization(IsoSurface); }
  void SetInitializationToInputSurface() { this->SetInitialization(InputSurface); }
  /**
   * Set/Get the radius of growing seeds in world units (default 0: 1.2 delta of the coarsest
   * level). Limits: 0.96 delta, diagonal of the image.
   */
  volumicPropertyMacro(SeedRadius, double);
  ///@}

  ///@{
  /**
   * Add a seed in world coordinates, in addition to the points of port 1. Seeds outside the object
   * at level 0 are ignored. It is an error if all are outside the object, or if one is more than a
   * voxel outside the image. The run starts at the coarsest level (`StartLevel`) at which all other
   * seeds are inside the object.
   *
   * With Initialization Seeds all outputs have only the components that enclose a seed. If no
   * component does, they have those that pass a seed within 2.5 Delta. KeepComponents selects among
   * them. With Recovery, and if GradientWeight and EdgeAttractionWeight are 0, the surface starts
   * as with IsoSurface, and the result does not depend on the level. Otherwise icosahedra of
   * SeedRadius grow, as in the paper.
   */
  void AddSeedPosition(double x, double y, double z);
  /** Remove all seed positions. */
  void ClearSeedPositions();
  /** Return the number of seed positions. */
  int GetNumberOfSeedPositions();
  /** Return a seed position, or NaN if the index is out of range. */
  void GetSeedPosition(int index, double position[3]);
  ///@}

  ///@{
  /**
   * Set/Get the weight of the tension, the force to the barycenter of the neighbors (default: 0.2).
   */
  volumicPropertyMacro(TensionWeight, double);
  /** Set/Get the weight of the springs along the edges (default: 0.1). */
  volumicPropertyMacro(ElasticityWeight, double);
  /** Set/Get the weight of the force along the normal to the isosurface (default: 1). */
  volumicPropertyMacro(IsopotentialWeight, double);
  /**
   * Set/Get the weight of the force down the image gradient (default: 0). It is for images whose
   * valleys are the boundaries, such as the negative gradient magnitude.
   */
  volumicPropertyMacro(GradientWeight, double);
  /**
   * Set/Get the weight of the edge map, see Input (default: 0). The scale of the map has no effect.
   * With more than IsopotentialWeight edges stop the surface, with less they only shift it.
   */
  volumicPropertyMacro(EdgeAttractionWeight, double);
  /**
   * Set/Get the weight of the points that belong to the object (default: 1). These are the points
   * of port 2 and the attracting positions. The field is raised within the `Radius` of each point,
   * which is at least two units of the level.
   */
  volumicPropertyMacro(PointAttractionWeight, double);
  /**
   * Add a point that belongs to the object, in world coordinates, with weight 1 and automatic
   * radius. It is an error if the point is more than a voxel outside the image.
   */
  void AddAttractingPosition(double x, double y, double z);
  /** Remove all attracting positions. */
  void ClearAttractingPositions();
  /** Return the number of attracting positions. */
  int GetNumberOfAttractingPositions();
  /** Return an attracting position, or NaN if the index is out of range. */
  void GetAttractingPosition(int index, double position[3]);
  /**
   * Set/Get the friction per unit of simulated time, more than 0 (default: 3). Low friction causes
   * oscillation, high friction slow convergence.
   */
  volumicPropertyMacro(Friction, double);
  ///@}

  ///@{
  /**
   * Set/Get the field outside the image (default: Background). Background: surfaces close at the
   * border. Replicate: the value of the nearest voxel, up to two units of the level beyond the
   * outermost voxels, then background.
   */
  volumicPropertyMacro(BorderValue, int);
  void SetBorderValueToBackground() { this->SetBorderValue(Background); }
  void SetBorderValueToReplicate() { this->SetBorderValue(Replicate); }
  /**
   * Set/Get which features missed by coarser levels to recover (default: RecoverObjects).
   * - NoRecovery: none, as in the paper
   * - RecoverObjects: parts of the object outside the surface, with UpperValue also cavities
   * - RecoverObjectsAndCavities: also background that the object encloses
   *
   * `MissingParts` and `MissingBoundary` report what remains missing.
   */
  volumicPropertyMacro(Recovery, int);
  /** Set/Get the minimum size of a part to recover, in voxels of the level (default: 20). */
  volumicPropertyMacro(MinimumPartSize, int);
  /** Set/Get whether the surface may merge and be cut (default: on). Off: contacts only stop it. */
  volumicBooleanPropertyMacro(TopologyChanges);
  ///@}

  ///@{
  /** Set/Get the maximum number of iterations per level (default: 1000). */
  volumicPropertyMacro(MaximumNumberOfIterations, int);
  /**
   * Set/Get the relative volume change at which a level has converged (default: 0.0005). The change
   * is measured over 10 and over 20 iterations. A change of less than delta^3 suffices, too.
   */
  volumicPropertyMacro(ConvergenceTolerance, double);
  /** Set/Get whether to skip converged vertices until something near them changes (default: on). */
  volumicBooleanPropertyMacro(FreezeMotionlessVertices);
  /** Set/Get whether vertices are moved onto the isosurface at the end of a level (default: on). */
  volumicBooleanPropertyMacro(SnapToIsoValue);
  /**
   * Set/Get the maximum time in seconds from the start of RequestData() (default 0: none). Then the
   * run ends as a cancelled one, but with `StopReason` `time limit`.
   */
  volumicPropertyMacro(TimeLimit, double);
  ///@}

  ///@{
  /**
   * Set/Get the components in the outputs Surface and Levels, each with its cavities (default:
   * AllComponents).
   * - AllComponents
   * - LargestComponent: the component with the largest area
   * - ComponentsAtPoints: components that enclose, or pass within 2.5 Delta, a point of port 1 or
   *   2, a seed position or an attracting position; without points all
   * - LargeComponents: components that enclose at least MinimumComponentVolume
   * - ComponentsNotAtSeeds: all components except those at points of port 1 and seed positions
   */
  volumicPropertyMacro(KeepComponents, int);
  void SetKeepComponentsToAllComponents() { this->SetKeepComponents(AllComponents); }
  void SetKeepComponentsToLargestComponent() { this->SetKeepComponents(LargestComponent); }
  void SetKeepComponentsToComponentsAtPoints() { this->SetKeepComponents(ComponentsAtPoints); }
  void SetKeepComponentsToLargeComponents() { this->SetKeepComponents(LargeComponents); }
  void SetKeepComponentsToComponentsNotAtSeeds() { this->SetKeepComponents(ComponentsNotAtSeeds); }
  /** Set/Get the minimum volume of LargeComponents in world units cubed (default: 0). */
  volumicPropertyMacro(MinimumComponentVolume, double);
  /**
   * Set/Get whether to end at a coarse level (default: off). This is the finest level from
   * FinestLevel on with at most a million voxels, else the coarsest level. A finer level is used
   * while `MissingBoundary` is more than 0.05. Off resumes the run.
   */
  volumicBooleanPropertyMacro(Preview);
  /** Set/Get whether ParaView's window shows the surface of each converged level (default: off). */
  volumicBooleanPropertyMacro(ShowLevels);
  /** Set/Get the number of iterations between two Snapshots (default 0: none). */
  volumicPropertyMacro(SnapshotInterval, int);
  ///@}

  ///@{
  /**
   * Set/Get the number of threads, as in vtkImagePyramid (default 0: all). Results do not depend on
   * it.
   */
  volumicPropertyMacro(NumberOfThreads, int);
  /** Set/Get the directory for large arrays, see Memory (default empty: arrays are in memory). */
  volumicPropertyMacro(ScratchDirectory, const char*);
  /**
   * Deprecated, without effect (default: 0). Set ScratchDirectory, and limit memory by the cgroup.
   */
  volumicPropertyMacro(MemoryLimit, int);
  /** Deprecated, without effect (default: off). It will be removed in the next release. */
  volumicBooleanPropertyMacro(Resume);
  /** Deprecated, without effect (default: off). */
  volumicBooleanPropertyMacro(Profile);
  ///@}

  /**
   * Resume a stopped run at the last converged level at the next Update(), or restart if none is.
   */
  void GoOn();
  /** Release the kept run, see Resuming. */
  void ForgetRun();
  /**
   * Return whether the next Update() with ShowLevels computes a finer level. A program that calls
   * this method several times a second, as ParaView's window does, gets the levels one by one.
   */
  bool GetNeedsUpdate();

#ifndef __VTK_WRAP__ // Not a property.
  /**
   * Return the components of the last surface that KeepComponents removed, for ParaView's window.
   * Null with AllComponents, with ScratchDirectory, and without a call of GetNeedsUpdate() before
   * the run.
   */
  vtkSmartPointer<vtkPolyData> NewLeftOutComponents();
  /** Has no effect unless the filter is running. */
  void SetAbortExecute(vtkTypeBool abort) override;
#endif

  ///@{
  /** Set the connection of port 1: the initial surface or the seeds. */
  void SetInitialSurfaceConnection(vtkAlgorithmOutput* output);
  /** Set the data of port 1 without a connection. */
  void SetInitialSurfaceData(vtkDataObject* data);
  /** Set the connection of port 2: the points known to belong to the object. */
  void SetAttractingPointsConnection(vtkAlgorithmOutput* output);
  /** Set the data of port 2 without a connection. */
  void SetAttractingPointsData(vtkDataObject* data);
  ///@}

  ///@{
  /** Return output port 1, the surfaces of the levels. */
  vtkMultiBlockDataSet* GetLevels();
  /** Return output port 2, the history. */
  vtkTable* GetHistory();
  /** Return output port 3, the snapshots. */
  vtkMultiBlockDataSet* GetSnapshots();
  ///@}

protected:
  vtkDeformableSurface();
  ~vtkDeformableSurface() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

  class vtkInternals;
  std::unique_ptr<vtkInternals> Internals; ///< the properties and the kept run

private:
  vtkDeformableSurface(const vtkDeformableSurface&) = delete;
  void operator=(const vtkDeformableSurface&) = delete;
};

#endif
