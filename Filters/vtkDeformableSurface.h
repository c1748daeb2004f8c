// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDeformableSurface
 * @brief   segment an image with a closed surface that descends a pyramid, from coarse to fine
 *
 * vtkDeformableSurface searches the boundary of an object in a 3D image: the isopotential, the
 * surface of equal value IsoValue of the interpolated image. A closed triangulated surface is
 * moved and bent by forces, merges with itself and comes apart as the object demands, first at the
 * coarsest level of an image pyramid, then, each time divided, at the finer ones. Each surface of an
 * output is closed, oriented, manifold and free of self-intersections, also of a run that was
 * stopped, and is tested for that. At the end of a level edges are
 * between delta and 2.5 delta long, where delta is about one voxel of the level.
 *
 * Here is what goes in and comes out, with units and errors. Documentation/reference.md of the
 * sources has it at length.
 *
 * @par Input:
 * - Port 0: a vtkMultiBlockDataSet from vtkImagePyramid, or a vtkImageData, for which the pyramid
 *   is built here with default settings. The array is that of SetInputArrayToProcess(), by default
 *   the active point scalars: any numeric type, values of at most 1e37 in size, at least 8 voxels
 *   along each axis. Of several components see SelectedComponent; levels of a pyramid have one.
 *   Blanked voxels are background, NaN ones as NaNIsBackground says; infinite ones are refused.
 * - Port 1, optional: a vtkPolyData, in world coordinates. With Initialization InputSurface its
 *   polygons, of any size and shape, are the initial surface: closed, oriented outward, manifold,
 *   not self-intersecting, any number of components, cavities among them facing inward, at most
 *   five times as wide as the image. With Initialization Seeds its points are centres of seeds.
 * - Port 2, optional: a vtkPolyData with points known to belong to the object, see
 *   PointAttractionWeight. Point arrays, optional: `Weight` (any numeric type, at least 0, default
 *   1) and `Radius` (world units, default 0: automatic).
 * - Points, at both ports: those of the vertices (vertex and polyvertex cells), each once; all of
 *   them where there are no cells. Lines and polygons without vertices are refused.
 * - A map of edges, optional, see EdgeAttractionWeight: a second point array of the image of port
 *   0, chosen by SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name).
 *
 * @par Output:
 * World coordinates, as double; triangles, oriented outward: normals point from inside, where the
 * object is, to outside.
 * - Port 0, `Surface`: vtkPolyData, the surface of the finest level that was reached
 * - Port 1, `Levels`: vtkMultiBlockDataSet, block h the surface that rested at level h, named
 *   `Level h`; blocks of levels that were not visited are empty; with FinestLevel -1 a block more
 * - Port 2, `History`: vtkTable, a row per iteration
 * - Port 3, `Snapshots`: vtkMultiBlockDataSet, with SnapshotInterval the surface on its way, a
 *   block per snapshot, named `Level 3, iteration 20` (of that level)
 *
 * Point arrays of each surface:
 * - `Normals` (float, 3, active)
 * - `Residual` (float): the field minus IsoValue at the vertex
 * - `Motionless` (unsigned char): 1 for vertices at rest; with vtkAbstractArray::GUI_HIDE()
 * - `Contact` (unsigned char): 1 where walls or gaps are thinner than the triangles can hold
 * - `EdgeSize` (float): with Tolerance or ThinParts, the length of edges that is wanted there
 * - `Thickness` (float): with ThinParts, that of the object or of the air, whichever is thinner
 *
 * Cell arrays:
 * - `Component` (int): 0 has the largest area
 * - `ComponentArea`, `ComponentVolume` (float), `ComponentGenus` (int): of the triangle's component
 *
 * Field data:
 * - `Level`, `Iterations` (int): the level, and the iterations made there
 * - `StartLevel` (int): the level at which the run started
 * - `Delta`, `Unit` (double): the smallest length of an edge, and U of the level
 * - `NumberOfComponents`, `EulerCharacteristic`, `Genus` (int): of the whole surface
 * - `Area`, `Volume` (double): of the whole surface
 * - `StopReason` (string): `converged`; `limit cycle`, which is finished like one that rests;
 *   `iteration limit`; `cancelled`; `time limit`; `vanished`
 * - `ContactVertices` (int): those with `Contact`
 * - `RemainingContacts` (int): pairs of vertices that are too near to each other
 * - `LargestDistance`, `WithinTolerance` (double): with Tolerance, what is left of the distance
 * - `ResidualQuantile` (double): 98 % of the vertices have a `Residual` of at most this size
 * - `LostParts`, `RecoveredParts`, `LostCavities`, `RecoveredCavities` (int): see Recovery
 * - `MissingParts` (int), `MissingBoundary` (double, 0 to 1): what Recovery found and is not there
 * - `ComponentArea`, `ComponentVolume` (double), `ComponentGenus` (int): an entry per component
 * - `ComponentOwner` (int): the component itself; of a cavity the one that it is in, -1: none
 * - `ComponentCentroid` (3), `ComponentInertia` (6, double): of the solid that a component encloses
 * - `Iteration` (int): of a snapshot, in the place of `StopReason`: the history's last row by then
 *
 * Columns of the history, of which a row adds up what all blocks did in the same iteration:
 * - `Iteration`: over all levels, from 1
 * - `Level`: that of the iteration
 * - `Vertices`, `EulerCharacteristic`: of the surface after it
 * - `Components`, `MeanEdgeLength`: of that at the end of the sweep of several iterations it is in
 * - In the last row of a level these four describe the surface of the level.
 * - `KineticEnergy`: the mean over the vertices, along the normals
 * - `TimeStep`: the longest of all blocks; `ActiveVertices`: those that are not at rest
 * - `Merges`, `Cuts`, `Splits`, `Collapses`, `Flips`: how many there were
 * - `Seconds`: since the row before; in the last row of a level until the level is done
 *
 * @par Errors:
 * A message names the port, the array or the value, and the way out; the outputs are empty.
 * Update() goes on after an error; ask GetErrorCode() then: 0 (vtkErrorCode::NoError) after a good
 * run, also one that was cancelled, vtkErrorCode::UserError where something given is wrong,
 * vtkErrorCode::UnknownError where the memory does not suffice. The message comes with ErrorEvent;
 * without an observer VTK prints it. A missing input, and inputs of another type at ports 1 and 2,
 * are refused by the pipeline before a run: by ErrorEvent of GetExecutive() only.
 * @par
 * Warnings come at the end of a run: if nothing is left, or KeepComponents leaves nothing; if
 * `MissingBoundary` is more than 0.05 at the finest level, with Recovery, without Preview and where
 * neither KeepComponents nor seeds select components; the number of voxels that are NaN. All else is
 * told by the field data only.
 *
 * @par Cancelling:
 * AbortExecute is looked at several times a second, with each progress event: the surface as it is
 * then is handed over, valid, with `StopReason` `cancelled`; an empty one if there is none yet. It
 * counts as up to date, and the request is forgotten. To go on call GoOn() first; to run anew
 * Modified(), or change an input or a property.
 *
 * @par Going on:
 * After a run the filter keeps what a run that ends elsewhere can use: with another FinestLevel,
 * Preview, ShowLevels, TimeLimit, ScratchDirectory or NumberOfThreads, and nothing
 * else changed, a level at which the surface has rested is shown at once, and a finer one reached
 * from where the last run has ended, if that is level 1 or above; the bits are those of a run from
 * the start. ForgetRun() frees what is kept; so do errors and the release of data.
 *
 * @par Memory:
 * The filter reads voxels in the type that they have, and does not copy those of the input. With
 * ScratchDirectory, large arrays lie in files there without a name, mapped into memory, and the
 * kernel moves their pages between memory and disk. Output arrays stay there until they are freed.
 * To limit the memory of a process use its cgroup, for example
 * `systemd-run --user --scope -p MemoryMax=2G`. A full disk is an error.
 *
 * @par Processes:
 * In a parallel run, as in pvserver and pvbatch, the first process (piece 0) requests the whole of all
 * inputs and makes the whole surface. The other processes have the same levels without surfaces, all
 * other outputs of theirs are empty, and ShowLevels has no effect.
 *
 * @par Thanks:
 * J.-O. Lachaud and A. Montanvert, "Volumic Segmentation using Hierarchical Representation and
 * Triangulated Surface", ECCV 1996. What differs is in Documentation/differences.md of the sources.
 * Results are the same bits for any number of threads.
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

  /// What the surface starts from.
  enum InitializationType
  {
    EnclosingIcosahedron = 0,
    Seeds = 1,
    IsoSurface = 2,
    InputSurface = 3
  };
  /// Which lengths the constraints on edges and distances speak of.
  enum MetricType
  {
    Voxels = 0,
    World = 1
  };
  /// What the field is outside the image.
  enum BorderValueType
  {
    Background = 0,
    Replicate = 1
  };
  /// What is done about parts of the object that a coarser level has lost.
  enum RecoveryType
  {
    NoRecovery = 0,
    RecoverObjects = 1,
    RecoverObjectsAndCavities = 2
  };
  /// Which components of the surfaces the outputs hold.
  enum KeepComponentsType
  {
    AllComponents = 0,
    LargestComponent = 1,
    ComponentsAtPoints = 2,
    LargeComponents = 3,
    ComponentsNotAtSeeds = 4
  };

  ///@{
  /** Of several components the one that is taken, from 0; -1, the default: the magnitude of all. */
  virtual void SetSelectedComponent(int value);
  virtual int GetSelectedComponent();
  ///@}

  ///@{
  /** NaN voxels are background, with a warning of their number; off: refused. Default: on. */
  virtual void SetNaNIsBackground(bool value);
  virtual bool GetNaNIsBackground();
  vtkBooleanMacro(NaNIsBackground, bool);
  ///@}

  ///@{
  /**
   * Which lengths are even where voxels are not cubes: World (default): those of the world; Voxels:
   * those of an affine space in which voxels are cubes: triangles are stretched as the voxels
   * are.
   */
  virtual void SetMetric(int value);
  virtual int GetMetric();
  void SetMetricToVoxels() { this->SetMetric(Voxels); }
  void SetMetricToWorld() { this->SetMetric(World); }
  ///@}

  ///@{
  /**
   * The isopotential that is searched, in the units of the voxels. It must be set: NaN, the
   * default, is an error that tells the range.
   */
  virtual void SetIsoValue(double value);
  virtual double GetIsoValue();
  /**
   * The object is where the field is above IsoValue (off: below), or, with UpperValue, between the
   * two (off: not between them). Default: on.
   */
  virtual void SetObjectIsBright(bool value);
  virtual bool GetObjectIsBright();
  vtkBooleanMacro(ObjectIsBright, bool);
  ///@}

  ///@{
  /**
   * The object has values between IsoValue and this one: marrow in bone, one of two materials. All
   * is as for the image min(image, IsoValue + UpperValue - image): its isopotential IsoValue is
   * that of min(image - IsoValue, UpperValue - image) at 0. Of a pyramid level 0 is taken, and the
   * others are made anew. Infinite, the default: none.
   */
  virtual void SetUpperValue(double value);
  virtual double GetUpperValue();
  /** Off: as without UpperValue, for a panel, which has a number always. Default: on. */
  virtual void SetUseUpperValue(bool value);
  virtual bool GetUseUpperValue();
  vtkBooleanMacro(UseUpperValue, bool);
  ///@}

  ///@{
  /**
   * Which components the outputs Surface and Levels hold. AllComponents (default);
   * LargestComponent: that of the largest area; ComponentsAtPoints: those that enclose, or pass
   * within 2.5 Delta, a point of port 1 or 2 or one of the positions below; LargeComponents: those
   * that enclose at least MinimumComponentVolume; ComponentsNotAtSeeds: all but those at points of
   * port 1 and SeedPositions. Cavities go with the component about them. Without any points
   * ComponentsAtPoints and ComponentsNotAtSeeds hold all.
   */
  virtual void SetKeepComponents(int value);
  virtual int GetKeepComponents();
  void SetKeepComponentsToAllComponents() { this->SetKeepComponents(AllComponents); }
  void SetKeepComponentsToLargestComponent() { this->SetKeepComponents(LargestComponent); }
  void SetKeepComponentsToComponentsAtPoints() { this->SetKeepComponents(ComponentsAtPoints); }
  void SetKeepComponentsToLargeComponents() { this->SetKeepComponents(LargeComponents); }
  void SetKeepComponentsToComponentsNotAtSeeds() { this->SetKeepComponents(ComponentsNotAtSeeds); }
  /** For LargeComponents: world units cubed. Default: 0. */
  virtual void SetMinimumComponentVolume(double value);
  virtual double GetMinimumComponentVolume();
  ///@}

  ///@{
  /**
   * What the surface starts from. EnclosingIcosahedron (default): a rounded box about the image, in
   * the place of the paper's icosahedron. Seeds: see AddSeedPosition(); icosahedra on a grid if there
   * are none. IsoSurface: a closed surface with even triangles around all of the object, half a voxel
   * outside the isosurface of the coarsest level. InputSurface: the polygons of port 1.
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
   * Centres of seeds, in world coordinates, which add to the points of port 1. One that lies
   * outside the image by more than a voxel is an error. Seeds are tested at level 0: those outside
   * the object are ignored, and it is an error if all are. The run starts at the coarsest level
   * that has all the others inside the object (`StartLevel`).
   *
   * With Initialization Seeds all outputs have only the components at these seeds: those that
   * enclose a seed or, if none does, pass it within 2.5 Delta, with their cavities. KeepComponents
   * selects among them. With Recovery, and if GradientWeight and EdgeAttractionWeight are 0, the
   * surface starts from all of the object at that level, as with IsoSurface, and the components are
   * selected at the end of each level. So they depend neither on the level nor on the places that
   * seeds can grow through. Else icosahedra of SeedRadius grow, as in the paper.
   *
   * An index that is none gives NaN.
   */
  void AddSeedPosition(double x, double y, double z);
  void ClearSeedPositions();
  int GetNumberOfSeedPositions();
  void GetSeedPosition(int index, double position[3]);
  /**
   * Of all seeds that grow, world units, at least 0.96 delta; 0, the default: 1.2 delta of the
   * coarsest level.
   */
  virtual void SetSeedRadius(double value);
  virtual double GetSeedRadius();
  ///@}

  ///@{
  /**
   * The level to start at. It is an error if the object is too thin there at all seeds or, without
   * Recovery, at one. -1, the default: the last of the pyramid. Where that shows nothing of
   * the object: the last on which a part of it has MinimumPartSize voxels, and the surface starts
   * about these parts, as where it has lost them. Without Recovery: the last on which a surface
   * holds a part of it.
   */
  virtual void SetCoarsestLevel(int value);
  virtual int GetCoarsestLevel();
  /**
   * The level to end at; the same as CoarsestLevel: one level alone. 0, the default: the input; -1:
   * one level finer than the image, with triangles sqrt(3) times smaller on the field of level 0.
   * What belongs to it is called level -1, and is the last block of the output Levels.
   */
  void SetFinestLevel(int level);
  virtual int GetFinestLevel();
  ///@}

  ///@{
  /**
   * Mean length of the edges that is wanted at the finest level, in world units, met within about
   * 10 %; 0, the default: as FinestLevel and SamplingRatio give it, which are not looked at
   * otherwise. An error tells the lengths that are possible.
   */
  virtual void SetEdgeLength(double value);
  virtual double GetEdgeLength();
  ///@}

  ///@{
  /**
   * Graded triangles: how far a face of the finest level's surface may be from the isopotential for
   * the sake of longer edges, in world units; 0, the default: edges of one length, delta to 2.5
   * delta. `WithinTolerance` and `LargestDistance` tell what is further away, as the uniform
   * surface is. Not with EdgeLength, and not without SnapToIsoValue.
   */
  virtual void SetTolerance(double value);
  virtual double GetTolerance();
  /** World units, taken as at least 2.5 delta and at most 12.5; 0, the default: 10 delta. */
  virtual void SetMaximumEdgeLength(double value);
  virtual double GetMaximumEdgeLength();
  /** How much edges, in delta, grow per length walked; more than 0, at most 0.3. Default: 0.2. */
  virtual void SetGradation(double value);
  virtual double GetGradation();
  ///@}

  ///@{
  /**
   * With FinestLevel 0 or -1: go on to level -1, but divide the surface there only where the
   * object, or the air in it, is thinner than 2.5 delta, or the surface off the isopotential. Not
   * with EdgeLength, and not without SnapToIsoValue. Default: off.
   */
  virtual void SetThinParts(bool value);
  virtual bool GetThinParts();
  vtkBooleanMacro(ThinParts, bool);
  ///@}

  ///@{
  /** delta / U of the level (eq. 7), between sqrt(3)/2.5 and 1. Default: 0.85. */
  virtual void SetSamplingRatio(double value);
  virtual double GetSamplingRatio();
  ///@}

  ///@{
  /**
   * Weight of the force to the barycentre of the neighbours; at least 0, without unit, as all four.
   * Default: 0.2.
   */
  virtual void SetTensionWeight(double value);
  virtual double GetTensionWeight();
  /** Weight of the springs along the edges. Default: 0.1. */
  virtual void SetElasticityWeight(double value);
  virtual double GetElasticityWeight();
  /** Weight of the force along the normal to the iso-value. Default: 1. */
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
   * How much points known to belong to the object attract the surface, those of port 2 and the
   * AttractingPositions (world coordinates, weight 1, automatic radius), times the point's own
   * `Weight`: around them the field is raised to the object's side, within their `Radius`, which is
   * at least two units of the level. 0: not at all; default: 1. A position that lies outside the
   * image by more than a voxel is an error. An index that is none gives NaN.
   */
  virtual void SetPointAttractionWeight(double value);
  virtual double GetPointAttractionWeight();
  void AddAttractingPosition(double x, double y, double z);
  void ClearAttractingPositions();
  int GetNumberOfAttractingPositions();
  void GetAttractingPosition(int index, double position[3]);
  ///@}

  ///@{
  /**
   * How much edges detected beforehand attract the surface: the map, large on edges, is a second
   * point array, see Input; its scale does not matter. With more than IsopotentialWeight edges stop
   * the surface, with less they only shift it. 0, the default: not at all.
   */
  virtual void SetEdgeAttractionWeight(double value);
  virtual double GetEdgeAttractionWeight();
  ///@}

  ///@{
  /** Per unit of the simulated time, more than 0: little oscillates, much is slow. Default: 3. */
  virtual void SetFriction(double value);
  virtual double GetFriction();
  ///@}

  ///@{
  /**
   * What the field is outside the image. Background (default): away from the object, so that
   * surfaces close at the border. Replicate: the nearest voxel, as far as two units of the level
   * beyond the outermost voxels, and background from there on.
   */
  virtual void SetBorderValue(int value);
  virtual int GetBorderValue();
  void SetBorderValueToBackground() { this->SetBorderValue(Background); }
  void SetBorderValueToReplicate() { this->SetBorderValue(Replicate); }
  ///@}

  ///@{
  /**
   * What is done about parts of the object that lie outside the surface when it comes to a level.
   * RecoverObjects (default): each gets a component of its own; RecoverObjectsAndCavities, or an
   * UpperValue: also background that the object encloses; NoRecovery: nothing, as in the paper.
   * `MissingParts` and `MissingBoundary` tell what is missing in the end.
   */
  virtual void SetRecovery(int value);
  virtual int GetRecovery();
  /** Voxels of a level that such a part must have there. Default: 20. */
  virtual void SetMinimumPartSize(int value);
  virtual int GetMinimumPartSize();
  ///@}

  ///@{
  /** Merges and cuts; off: contacts only stop the surface. Default: on. */
  virtual void SetTopologyChanges(bool value);
  virtual bool GetTopologyChanges();
  vtkBooleanMacro(TopologyChanges, bool);
  ///@}

  ///@{
  /** Iterations per level at most. Default: 1000. */
  virtual void SetMaximumNumberOfIterations(int value);
  virtual int GetMaximumNumberOfIterations();
  /**
   * A level rests when the enclosed volume changes by less than this share of it, or than delta^3,
   * over 10 and over 20 iterations. Default: 0.0005.
   */
  virtual void SetConvergenceTolerance(double value);
  virtual double GetConvergenceTolerance();
  ///@}

  ///@{
  /** Vertices at rest are skipped until something near them changes. Default: on. */
  virtual void SetFreezeMotionlessVertices(bool value);
  virtual bool GetFreezeMotionlessVertices();
  vtkBooleanMacro(FreezeMotionlessVertices, bool);
  /** At a level's end vertices go onto the isopotential as far as they may. Default: on. */
  virtual void SetSnapToIsoValue(bool value);
  virtual bool GetSnapToIsoValue();
  vtkBooleanMacro(SnapToIsoValue, bool);
  ///@}

  ///@{
  /** As vtkImagePyramid: 0, the default: all. Results do not depend on it. */
  void SetNumberOfThreads(int number);
  virtual int GetNumberOfThreads();
  ///@}

  ///@{
  /**
   * Deprecated: has no effect. Set ScratchDirectory, and limit the memory of the process by its
   * cgroup.
   */
  void SetMemoryLimit(int mebibytes);
  virtual int GetMemoryLimit();
  ///@}

  ///@{
  /**
   * Folder on a disk for large arrays, see Memory; empty (the default): arrays lie in memory.
   * Results do not depend on it.
   */
  void SetScratchDirectory(const char* directory);
  virtual const char* GetScratchDirectory();
  ///@}

  ///@{
  /** Deprecated, has no effect: on is a warning. It leaves with the next release. Default: off. */
  void SetResume(bool resume);
  virtual bool GetResume();
  vtkBooleanMacro(Resume, bool);
  ///@}

  ///@{
  /**
   * Seconds, from the start of RequestData(), after which a run ends with the surface as it is
   * then, `StopReason` `time limit`, an empty one if it has none yet; 0, the default: none.
   */
  void SetTimeLimit(double seconds);
  virtual double GetTimeLimit();
  ///@}

  ///@{
  /**
   * End at a coarse level: the finest from FinestLevel on that has at most a million voxels, the
   * coarsest of the run if none has, or a finer one where `MissingBoundary` is more than 0.05
   * there. Switched off, the run goes on from there. Default: off.
   */
  void SetPreview(bool preview);
  virtual bool GetPreview();
  vtkBooleanMacro(Preview, bool);
  ///@}

  ///@{
  /** In ParaView's window: show the surface of each level as soon as it rests. Default: off. */
  void SetShowLevels(bool show);
  virtual bool GetShowLevels();
  vtkBooleanMacro(ShowLevels, bool);
  ///@}

  /**
   * With ShowLevels: whether a finer level is still to come, at the next Update(). Who asks it, as
   * ParaView's window does several times a second, gets the levels one by one.
   */
  bool GetNeedsUpdate();

  /**
   * After a run that was stopped: the next Update() goes on from the last level at which the
   * surface rested, or begins anew where there is none. Of a run that was not it gives the same
   * again.
   */
  void GoOn();

#ifndef __VTK_WRAP__ // It is no property of ours.
  /**
   * In ParaView's window: return the components that KeepComponents has left out of the last
   * surface. Null with AllComponents, and where they are not kept: without a call of
   * GetNeedsUpdate() before the run, or with ScratchDirectory.
   */
  vtkSmartPointer<vtkPolyData> NewLeftOutComponents();
  /** As of all algorithms; while no run is under way it asks for nothing, and changes nothing. */
  void SetAbortExecute(vtkTypeBool abort) override;
#endif

  /** Frees what is kept of the last run, see Going on. */
  void ForgetRun();

  ///@{
  /** Has no effect; deprecated. Default: off. */
  virtual void SetProfile(bool value);
  virtual bool GetProfile();
  vtkBooleanMacro(Profile, bool);
  /** Iterations from one of the Snapshots to the next; 0, the default: none. */
  virtual void SetSnapshotInterval(int value);
  virtual int GetSnapshotInterval();
  ///@}

  ///@{
  /** Port 1: the initial surface or the centres of the seeds. */
  void SetInitialSurfaceConnection(vtkAlgorithmOutput* output);
  /** The same as data that is no filter's output. */
  void SetInitialSurfaceData(vtkDataObject* data);
  ///@}

  ///@{
  /** Port 2: the points known to belong to the object. */
  void SetAttractingPointsConnection(vtkAlgorithmOutput* output);
  /** The same as data that is no filter's output. */
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
