// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDeformableSurface
 * @brief   segment an image with a closed surface that descends a pyramid, from coarse to fine
 *
 * vtkDeformableSurface computes the boundary of an object in a 3D image: the isosurface of IsoValue
 * in the interpolated image. Forces move a closed triangulated surface, which merges with itself
 * and splits as the object requires. The run starts at the coarsest level of an image pyramid. For
 * each finer level the surface is subdivided. Every output surface is closed, oriented, manifold
 * and free of self-intersections, also if the run was stopped. At the end of a level edges are
 * between delta and 2.5 delta long, where delta is about one voxel of the level. Lengths are in
 * world units. Documentation/reference.md describes all properties and arrays in detail.
 *
 * @par Input:
 * - Port 0: a vtkMultiBlockDataSet from vtkImagePyramid, or a vtkImageData, for which the filter
 *   computes the pyramid with default settings. SetInputArrayToProcess() chooses the array (default:
 *   active point scalars): any numeric type, absolute values of at most 1e37, at least 8 voxels
 *   along each axis. Blanked voxels are background. Infinite voxels are an error.
 * - Port 1, optional: a vtkPolyData. With Initialization InputSurface its polygons are the initial
 *   surface: closed, oriented outward, manifold, not self-intersecting, at most five times as wide
 *   as the image, with cavities facing inward. With Initialization Seeds its points are seeds.
 * - Port 2, optional: a vtkPolyData with points known to belong to the object, see
 *   PointAttractionWeight. Optional point arrays: `Weight` (at least 0, default 1) and `Radius`
 *   (default 0: automatic).
 * - The points of ports 1 and 2 are those of vertex cells, or all points if there are no cells.
 *   Lines and polygons without vertices are an error.
 * - Edge map, optional, see EdgeAttractionWeight: a second point array of the image of port 0, chosen
 *   by SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name).
 *
 * @par Output:
 * World coordinates, as double. Triangles and normals are oriented outward.
 * - Port 0, `Surface`: vtkPolyData, the surface of the finest level that was reached
 * - Port 1, `Levels`: vtkMultiBlockDataSet, block h the converged surface of level h, named
 *   `Level h`, empty if the run did not reach it; with FinestLevel -1 one more block
 * - Port 2, `History`: vtkTable, a row per iteration
 * - Port 3, `Snapshots`: vtkMultiBlockDataSet, see SnapshotInterval, with blocks named
 *   `Level 3, iteration 20` (iteration of that level)
 *
 * Point arrays of each surface:
 * - `Normals` (float, 3, active)
 * - `Residual` (float): the field minus IsoValue at the vertex
 * - `Motionless` (unsigned char): 1 for converged vertices; with vtkAbstractArray::GUI_HIDE()
 * - `Contact` (unsigned char): 1 where walls or gaps are thinner than the triangles can represent
 * - `EdgeSize` (float): with Tolerance or ThinParts, the requested edge length
 * - `Thickness` (float): with ThinParts, of the object or of the gap outside, whichever is less
 *
 * Cell arrays:
 * - `Component` (int): 0 has the largest area
 * - `ComponentArea`, `ComponentVolume` (float), `ComponentGenus` (int): of the triangle's component
 *
 * Field data:
 * - `Level`, `StartLevel`, `Iterations` (int): the level, that of the start, iterations at the level
 * - `Delta`, `Unit` (double): smallest edge length, and U of the level
 * - `NumberOfComponents`, `EulerCharacteristic`, `Genus` (int), `Area`, `Volume` (double)
 * - `StopReason` (string): `converged`, `limit cycle` (also finished), `iteration limit`,
 *   `cancelled`, `time limit` or `vanished`
 * - `ContactVertices` (int): number of vertices with `Contact`
 * - `RemainingContacts` (int): pairs of vertices that are too close to each other
 * - `LargestDistance`, `WithinTolerance` (double): with Tolerance, the distance that remains
 * - `ResidualQuantile` (double): 98 % of the vertices have at most this absolute `Residual`
 * - `LostParts`, `RecoveredParts`, `LostCavities`, `RecoveredCavities`, `MissingParts` (int),
 *   `MissingBoundary` (double, 0 to 1): see Recovery
 * - `ComponentArea`, `ComponentVolume` (double), `ComponentGenus` (int): an entry per component
 * - `ComponentOwner` (int): the component itself; for a cavity the one around it (-1: none)
 * - `ComponentCentroid` (3), `ComponentInertia` (6, double): of the enclosed solid
 * - `Iteration` (int): of a snapshot instead of `StopReason`: the last row of the history by then
 *
 * Columns of the history, which add up the work of all blocks in an iteration:
 * - `Iteration` (from 1, over all levels), `Level`
 * - `Vertices`, `EulerCharacteristic`: after the iteration
 * - `Components`, `MeanEdgeLength`: at the end of its sweep of several iterations. In the last row of
 *   a level these four describe the final surface of the level.
 * - `KineticEnergy`: mean over the vertices, along the normals
 * - `TimeStep`: the longest of all blocks
 * - `ActiveVertices`: vertices that have not converged
 * - `Merges`, `Cuts`, `Splits`, `Collapses`, `Flips`: number of edits
 * - `Seconds`: since the row before; in the last row of a level, until the level is finished
 *
 * @par Errors:
 * On error the filter invokes `ErrorEvent` with a message that names the port, array or value and
 * how to fix it. The outputs are empty. GetErrorCode() returns vtkErrorCode::UserError for an invalid
 * input or property, vtkErrorCode::UnknownError if memory does not suffice, and 0 after a good or
 * cancelled run. The pipeline itself reports a missing input, and other types at ports 1 and 2, by
 * `ErrorEvent` of GetExecutive().
 * @par
 * The filter warns at the end of a run if no surface is left, if KeepComponents leaves none, and of
 * the number of NaN voxels. It warns of a `MissingBoundary` of more than 0.05 at the finest level,
 * with Recovery, without Preview, and unless KeepComponents or seeds select components.
 *
 * @par Cancelling:
 * The filter tests AbortExecute several times a second. It then outputs the surface as it is, with
 * `StopReason` `cancelled`, or an empty one if there is none yet. The output counts as up to date.
 * Call GoOn() to resume, or Modified() to restart.
 *
 * @par Resuming:
 * The filter keeps its last run. If only FinestLevel, Preview, ShowLevels, TimeLimit,
 * ScratchDirectory or NumberOfThreads change, it outputs a finished level at once, and resumes a run
 * that ended at level 1 or above. The result is bit-identical to that of a new run. ForgetRun(),
 * errors and the release of data free the kept run.
 *
 * @par Memory:
 * Voxels keep their type, and those of the input are not copied. With ScratchDirectory, large arrays
 * are mapped from unnamed files there, output arrays until they are freed. A full disk is an error.
 * Limit the memory of a process by its cgroup:
 * `systemd-run --user --scope -p MemoryMax=2G`.
 *
 * @par Processes:
 * In a parallel run, as in pvserver and pvbatch, the first process (piece 0) requests the whole of all
 * inputs and makes the whole surface. The other processes have the same levels without surfaces. Their
 * other outputs are empty, and ShowLevels has no effect.
 *
 * @par Thanks:
 * J.-O. Lachaud and A. Montanvert, "Volumic Segmentation using Hierarchical Representation and
 * Triangulated Surface", ECCV 1996. Documentation/differences.md lists the differences.
 * Results are bit-identical for any number of threads.
 *
 * @sa
 * vtkImagePyramid vtkFlyingEdges3D
 */
#ifndef vtkDeformableSurface_h
#define vtkDeformableSurface_h

#include "vtkFiltersVolumicModule.h" // For export macro
#include "vtkPolyDataAlgorithm.h"

#include <vtkSmartPointer.h> // For NewLeftOutComponents()

#include <memory> // For what is hidden

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
  /// Lengths that are uniform.
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
  /** Component of the voxels, from 0; -1 (default): the magnitude of all components. */
  virtual void SetSelectedComponent(int value);
  virtual int GetSelectedComponent();
  /** Take NaN voxels as background, with a warning; off: report an error. Default: on. */
  virtual void SetNaNIsBackground(bool value);
  virtual bool GetNaNIsBackground();
  vtkBooleanMacro(NaNIsBackground, bool);
  ///@}

  ///@{
  /**
   * Which lengths are uniform if voxels are not cubes. World (default): world lengths. Voxels:
   * lengths in an affine space in which voxels are cubes, so that triangles are stretched like them.
   */
  virtual void SetMetric(int value);
  virtual int GetMetric();
  void SetMetricToVoxels() { this->SetMetric(Voxels); }
  void SetMetricToWorld() { this->SetMetric(World); }
  ///@}

  ///@{
  /** Value of the isosurface, in the units of the voxels. It must be set. Default: NaN. */
  virtual void SetIsoValue(double value);
  virtual double GetIsoValue();
  /**
   * The object is above IsoValue (off: below), or with UpperValue between the two (off: not between
   * them). Default: on.
   */
  virtual void SetObjectIsBright(bool value);
  virtual bool GetObjectIsBright();
  vtkBooleanMacro(ObjectIsBright, bool);
  /**
   * Upper end of the object's values, as for marrow in bone; infinite (default): none. The filter
   * then segments min(image, IsoValue + UpperValue - image). Of a pyramid it reads level 0, and
   * recomputes the others.
   */
  virtual void SetUpperValue(double value);
  virtual double GetUpperValue();
  /** Use UpperValue. Default: on. */
  virtual void SetUseUpperValue(bool value);
  virtual bool GetUseUpperValue();
  vtkBooleanMacro(UseUpperValue, bool);
  ///@}

  ///@{
  /**
   * Components in the outputs Surface and Levels, each with its cavities. Without any points,
   * ComponentsAtPoints and ComponentsNotAtSeeds select all.
   * - AllComponents (default)
   * - LargestComponent: the one with the largest area
   * - ComponentsAtPoints: those that enclose, or pass within 2.5 Delta, a point of port 1 or 2, a
   *   seed position or an attracting position
   * - LargeComponents: those that enclose at least MinimumComponentVolume
   * - ComponentsNotAtSeeds: all but those at points of port 1 and seed positions
   */
  virtual void SetKeepComponents(int value);
  virtual int GetKeepComponents();
  void SetKeepComponentsToAllComponents() { this->SetKeepComponents(AllComponents); }
  void SetKeepComponentsToLargestComponent() { this->SetKeepComponents(LargestComponent); }
  void SetKeepComponentsToComponentsAtPoints() { this->SetKeepComponents(ComponentsAtPoints); }
  void SetKeepComponentsToLargeComponents() { this->SetKeepComponents(LargeComponents); }
  void SetKeepComponentsToComponentsNotAtSeeds() { this->SetKeepComponents(ComponentsNotAtSeeds); }
  /** For LargeComponents, in world units cubed. Default: 0. */
  virtual void SetMinimumComponentVolume(double value);
  virtual double GetMinimumComponentVolume();
  ///@}

  ///@{
  /**
   * Initial surface:
   * - EnclosingIcosahedron (default): a rounded box around the image
   * - Seeds: see AddSeedPosition(); without any seeds icosahedra on a grid
   * - IsoSurface: a closed surface around the object, half a voxel outside its isosurface at the
   *   coarsest level
   * - InputSurface: the polygons of port 1
   */
  virtual void SetInitialization(int value);
  virtual int GetInitialization();
  void SetInitializationToEnclosingIcosahedron() { this->SetInitialization(EnclosingIcosahedron); }
  void SetInitializationToSeeds() { this->SetInitialization(Seeds); }
  void SetInitializationToIsoSurface() { this->SetInitialization(IsoSurface); }
  void SetInitializationToInputSurface() { this->SetInitialization(InputSurface); }
  ///@}

  ///@{
  /**
   * Seeds in world coordinates, in addition to the points of port 1. Seeds outside the object at
   * level 0 are ignored. It is an error if all are, or if one is more than a voxel outside the image.
   * The run starts at the coarsest level that has the others inside the object (`StartLevel`).
   *
   * With Initialization Seeds all outputs have only the components that enclose a seed or, if none
   * does, pass it within 2.5 Delta. KeepComponents selects among them. With Recovery, and if
   * GradientWeight and EdgeAttractionWeight are 0, the surface starts as with IsoSurface, so the
   * result does not depend on the level. Else icosahedra of SeedRadius grow, as in the paper.
   *
   * GetSeedPosition() returns NaN if the index is out of range.
   */
  void AddSeedPosition(double x, double y, double z);
  void ClearSeedPositions();
  int GetNumberOfSeedPositions();
  void GetSeedPosition(int index, double position[3]);
  /** Radius of growing seeds, at least 0.96 delta; 0 (default): 1.2 delta of the coarsest level. */
  virtual void SetSeedRadius(double value);
  virtual double GetSeedRadius();
  ///@}

  ///@{
  /**
   * Level at which the run starts. -1 (default): the last of the pyramid, or the last that has a
   * part of the object with MinimumPartSize voxels (without Recovery: that a surface can hold). It is
   * an error if the object is too thin there at all seeds or, without Recovery, at one.
   */
  virtual void SetCoarsestLevel(int value);
  virtual int GetCoarsestLevel();
  /**
   * Level at which the run ends, at most CoarsestLevel. 0 (default): the input. -1: one subdivision
   * more, with sqrt(3) times smaller triangles on the field of level 0. It is the last block of the
   * output Levels.
   */
  void SetFinestLevel(int level);
  virtual int GetFinestLevel();
  /**
   * Mean edge length at the finest level, met within about 10 %. 0 (default): FinestLevel and
   * SamplingRatio, which have no effect otherwise, determine it.
   */
  virtual void SetEdgeLength(double value);
  virtual double GetEdgeLength();
  ///@}

  ///@{
  /**
   * Largest distance of a face from the isosurface that longer edges may cause, at the finest level.
   * 0 (default): edges of one length. `WithinTolerance` and `LargestDistance` report what is farther,
   * as on the uniform surface. Requires EdgeLength 0 and SnapToIsoValue.
   */
  virtual void SetTolerance(double value);
  virtual double GetTolerance();
  /** For Tolerance, clamped to 2.5 to 12.5 delta; 0 (default): 10 delta. */
  virtual void SetMaximumEdgeLength(double value);
  virtual double GetMaximumEdgeLength();
  /** Growth of the edge length, in delta, per length; more than 0, at most 0.3. Default: 0.2. */
  virtual void SetGradation(double value);
  virtual double GetGradation();
  /**
   * With FinestLevel 0 or -1, continue to level -1, but subdivide only where object or gap is thinner
   * than 2.5 delta, or the surface off the isosurface. Requires EdgeLength 0 and SnapToIsoValue.
   * Default: off.
   */
  virtual void SetThinParts(bool value);
  virtual bool GetThinParts();
  vtkBooleanMacro(ThinParts, bool);
  /** delta / U of the level (eq. 7), between sqrt(3)/2.5 and 1. Default: 0.85. */
  virtual void SetSamplingRatio(double value);
  virtual double GetSamplingRatio();
  ///@}

  ///@{
  /** Weight of the force to the barycentre of the neighbours. At least 0, default: 0.2. */
  virtual void SetTensionWeight(double value);
  virtual double GetTensionWeight();
  /** Weight of the springs along the edges. Default: 0.1. */
  virtual void SetElasticityWeight(double value);
  virtual double GetElasticityWeight();
  /** Weight of the force along the normal to the isosurface. Default: 1. */
  virtual void SetIsopotentialWeight(double value);
  virtual double GetIsopotentialWeight();
  /**
   * Weight of the descent along the gradient, for images whose valleys are the boundaries, such as
   * the negative gradient magnitude. Default: 0.
   */
  virtual void SetGradientWeight(double value);
  virtual double GetGradientWeight();
  ///@}

  ///@{
  /**
   * Weight of points known to belong to the object: those of port 2, and attracting positions (world
   * coordinates, weight 1, automatic radius). The field is raised within the `Radius` of each, which
   * is at least two units of the level. Default: 1. A position more than a voxel outside the image is
   * an error. GetAttractingPosition() returns NaN if the index is out of range.
   */
  virtual void SetPointAttractionWeight(double value);
  virtual double GetPointAttractionWeight();
  void AddAttractingPosition(double x, double y, double z);
  void ClearAttractingPositions();
  int GetNumberOfAttractingPositions();
  void GetAttractingPosition(int index, double position[3]);
  /**
   * Weight of the edge map (see Input), which is large on edges, at any scale. With more than
   * IsopotentialWeight edges stop the surface, with less they only shift it. Default: 0.
   */
  virtual void SetEdgeAttractionWeight(double value);
  virtual double GetEdgeAttractionWeight();
  /** Friction per unit of simulated time, more than 0. Less oscillates, more is slow. Default: 3. */
  virtual void SetFriction(double value);
  virtual double GetFriction();
  ///@}

  ///@{
  /**
   * Field outside the image. Background (default): surfaces close at the border. Replicate: the
   * nearest voxel, up to two units of the level beyond the outermost voxels, then background.
   */
  virtual void SetBorderValue(int value);
  virtual int GetBorderValue();
  void SetBorderValueToBackground() { this->SetBorderValue(Background); }
  void SetBorderValueToReplicate() { this->SetBorderValue(Replicate); }
  ///@}

  ///@{
  /**
   * Which features missed by coarser levels to recover. RecoverObjects (default): each part outside
   * the surface gets a component. RecoverObjectsAndCavities, or an UpperValue: enclosed background,
   * too. NoRecovery: none, as in the paper. `MissingParts` and `MissingBoundary` report what remains.
   */
  virtual void SetRecovery(int value);
  virtual int GetRecovery();
  /** Smallest number of voxels of such a part at the level. Default: 20. */
  virtual void SetMinimumPartSize(int value);
  virtual int GetMinimumPartSize();
  /** Allow merges and cuts; off: contacts only stop the surface. Default: on. */
  virtual void SetTopologyChanges(bool value);
  virtual bool GetTopologyChanges();
  vtkBooleanMacro(TopologyChanges, bool);
  ///@}

  ///@{
  /** Maximum number of iterations per level. Default: 1000. */
  virtual void SetMaximumNumberOfIterations(int value);
  virtual int GetMaximumNumberOfIterations();
  /**
   * A level has converged when its volume changes by less than this share, or by less than delta^3,
   * over 10 and over 20 iterations. Default: 0.0005.
   */
  virtual void SetConvergenceTolerance(double value);
  virtual double GetConvergenceTolerance();
  /** Skip converged vertices until something near them changes. Default: on. */
  virtual void SetFreezeMotionlessVertices(bool value);
  virtual bool GetFreezeMotionlessVertices();
  vtkBooleanMacro(FreezeMotionlessVertices, bool);
  /** At the end of a level, move vertices onto the isosurface as far as possible. Default: on. */
  virtual void SetSnapToIsoValue(bool value);
  virtual bool GetSnapToIsoValue();
  vtkBooleanMacro(SnapToIsoValue, bool);
  ///@}

  ///@{
  /** Number of threads, as in vtkImagePyramid; 0 (default): all. Results do not depend on it. */
  void SetNumberOfThreads(int number);
  virtual int GetNumberOfThreads();
  /** Folder on a disk for large arrays, see Memory; empty (default): arrays lie in memory. */
  void SetScratchDirectory(const char* directory);
  virtual const char* GetScratchDirectory();
  /** Deprecated, no effect. Set ScratchDirectory, and limit memory by the cgroup. */
  void SetMemoryLimit(int mebibytes);
  virtual int GetMemoryLimit();
  /** Deprecated, no effect; on is a warning. It leaves with the next release. Default: off. */
  void SetResume(bool resume);
  virtual bool GetResume();
  vtkBooleanMacro(Resume, bool);
  /** Deprecated, no effect. Default: off. */
  virtual void SetProfile(bool value);
  virtual bool GetProfile();
  vtkBooleanMacro(Profile, bool);
  ///@}

  ///@{
  /**
   * Seconds after the start of RequestData() at which a run ends as a cancelled one does, but with
   * `StopReason` `time limit`; 0 (default): none.
   */
  void SetTimeLimit(double seconds);
  virtual double GetTimeLimit();
  /**
   * End at a coarse level: the finest from FinestLevel on with at most a million voxels, else the
   * coarsest, or a finer one if `MissingBoundary` is more than 0.05 there. Off resumes the run.
   * Default: off.
   */
  void SetPreview(bool preview);
  virtual bool GetPreview();
  vtkBooleanMacro(Preview, bool);
  /** In ParaView's window: show the surface of each level once it has converged. Default: off. */
  void SetShowLevels(bool show);
  virtual bool GetShowLevels();
  vtkBooleanMacro(ShowLevels, bool);
  /** Iterations between two Snapshots; 0 (default): none. */
  virtual void SetSnapshotInterval(int value);
  virtual int GetSnapshotInterval();
  ///@}

  /**
   * Return whether a finer level follows at the next Update() with ShowLevels. A program that calls
   * this method several times a second, as ParaView's window does, gets the levels one by one.
   */
  bool GetNeedsUpdate();

  /**
   * Let the next Update() resume a stopped run at the last converged level. It restarts if there is
   * none. After a complete run the output remains the same.
   */
  void GoOn();

#ifndef __VTK_WRAP__ // It is no property of ours.
  /**
   * In ParaView's window: return the components that KeepComponents has left out of the last
   * surface. Null with AllComponents, and if they are not kept: without a call of GetNeedsUpdate()
   * before the run, or with ScratchDirectory.
   */
  vtkSmartPointer<vtkPolyData> NewLeftOutComponents();
  /** As of all algorithms, but without effect unless the filter is running. */
  void SetAbortExecute(vtkTypeBool abort) override;
#endif

  /** Free what is kept of the last run, see Resuming. */
  void ForgetRun();

  ///@{
  /** Set port 1: the initial surface or the seeds. */
  void SetInitialSurfaceConnection(vtkAlgorithmOutput* output);
  /** Set the data of port 1 without a connection. */
  void SetInitialSurfaceData(vtkDataObject* data);
  ///@}

  ///@{
  /** Set port 2: the points known to belong to the object. */
  void SetAttractingPointsConnection(vtkAlgorithmOutput* output);
  /** Set the data of port 2 without a connection. */
  void SetAttractingPointsData(vtkDataObject* data);
  ///@}

  ///@{
  /** Outputs 1, 2 and 3. */
  vtkMultiBlockDataSet* GetLevels();
  vtkTable* GetHistory();
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
  std::unique_ptr<vtkInternals> Internals; ///< the properties, the run, and what is kept of it

private:
  vtkDeformableSurface(const vtkDeformableSurface&) = delete;
  void operator=(const vtkDeformableSurface&) = delete;
};

#endif
