// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDeformableSurface
 * @brief   segment an image with a closed surface that descends a pyramid, from coarse to fine
 *
 * vtkDeformableSurface searches the boundary of an object in a 3D image: the isopotential, the
 * surface of equal value IsoValue of the interpolated image. A closed triangulated surface is
 * moved and bent by forces, merges with itself and comes apart as the object demands, first at the
 * coarsest level of an image pyramid, then, each time divided, at the finer ones. At any moment it
 * is closed, oriented, manifold and free of self-intersections. At the end of a level its triangles
 * are well-shaped: edges are between delta and 2.5 delta long, where delta is about one voxel of
 * the level (in between, as when it is cancelled, the strip of a fresh merge may have longer ones).
 *
 * @par Input:
 * - Port 0: a vtkMultiBlockDataSet from vtkImagePyramid, or a vtkImageData, for which the pyramid
 *   is built here with default settings. Of each level the array chosen by SetInputArrayToProcess()
 *   is used, by default the active point scalars: any numeric type, values of at most 1e37 in size
 *   (the surface computes in single precision, after IsoValue was subtracted where that matters:
 *   10^9 to 10^9 + 50 are fine). Of several components of an image SelectedComponent chooses one;
 *   levels of a pyramid have one. NaN voxels are background, see NaNIsBackground, and so are
 *   blanked ones, as vtkImagePyramid says; infinite ones are refused. At least 8 voxels along each
 *   axis.
 * - Port 1, optional: a vtkPolyData. With Initialization InputSurface, its polygons are the initial
 *   surface (closed, oriented outward, manifold, not self-intersecting, any number of components,
 *   cavities among them facing inward, at most five times as wide as the image; polygons are
 *   triangulated). Triangles may be of any size and shape: where they are not yet well-shaped and
 *   of the level's size the surface gets another mesh first, which may lose what is thinner than
 *   about two edges. With Initialization Seeds, the centres of the seeds (see also SeedPositions).
 *   World coordinates.
 * - Port 2, optional: a vtkPolyData with points known to belong to the object, see
 *   PointAttractionWeight and AttractingPositions. Point arrays, optional: `Weight` (any numeric
 *   type, at least 0, default 1) and `Radius` (world units, default 0: automatic).
 * - Where points are meant, at both ports and for all purposes: the points of the vertices (vertex
 *   and polyvertex cells), each once; all points where there are no cells at all. Lines and
 *   polygons without vertices are refused, as nothing says that their points are meant.
 * - A map of edges, optional, see EdgeAttractionWeight: a second point array of the image of port
 *   0, chosen by SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name).
 *
 * @par Output:
 * All geometry is in world coordinates, through origin, spacing and direction of the input, and
 * oriented outward: normals point from inside, where the object is, to outside. Points are double,
 * so that the way to world coordinates makes no triangles intersect.
 * - Port 0, `Surface`: vtkPolyData, the surface of the finest level that was reached.
 * - Port 1, `Levels`: vtkMultiBlockDataSet, block h the surface that rested at level h, named
 *   `Level h`; blocks of levels that were not visited are empty. With FinestLevel -1 a block more.
 * - Port 2, `History`: vtkTable, a row per iteration.
 * - Port 3, `Snapshots`: vtkMultiBlockDataSet, with SnapshotInterval the surface on its way, a
 *   block per snapshot in the order in which they were taken, named `Level 3, iteration 20` (of
 *   that level).
 *
 * Arrays, field data and columns are listed here; Documentation/reference.md of the sources tells all
 * of them in full, and has what only Profile gives.
 *
 * Point arrays of each surface:
 * - `Normals` (float, 3, active)
 * - `Residual` (float): the field minus IsoValue at the vertex
 * - `Motionless` (unsigned char): 1 for vertices at rest
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
 * - `ComponentCentroid` (3), `ComponentInertia` (6, double): of the solid that a component encloses
 * - `Iteration` (int): of a snapshot, in the place of `StopReason`: the history's last row by then
 *
 * Columns of the history, of which a row adds up what all blocks did in the same iteration:
 * - `Iteration`: over all levels, from 1
 * - `Level`: that of the iteration
 * - `Vertices`, `EulerCharacteristic`: of the surface after it
 * - `Components`, `MeanEdgeLength`: of that at the end of the sweep of several iterations it is in
 * - `IterationVertices`, `IterationComponents`, `IterationEulerCharacteristic`,
 *   `IterationMeanEdgeLength`: the same, but in the last row of a level before its regularisation
 * - `RegularisationCuts`, `RegularisationDeletions`: what the regularisation changed of them
 * - `KineticEnergy`: the mean over the vertices, along the normals
 * - `TimeStep`: the longest of all blocks; `ActiveVertices`: those that are not at rest
 * - `Merges`, `Cuts`, `Splits`, `Collapses`, `Flips`: how many there were
 * - `Deletions`, `DeletedGenus`: components that were deleted, and the sum of their genera
 * - `RecoveredParts`: those that were found before this iteration
 * - `AddedEulerCharacteristic`: of what was added before it
 * - `Seconds`, `SecondsBefore`, `SecondsAfter`: they add up to the run
 *
 * @par Algorithm:
 * The paper's model (see Thanks) with rules that keep the mesh valid, found by experiment: wherever
 * triangles could intersect, operations are verified by tests of the triangles and displacements
 * that make them intersect are rolled back; merges need the image's consent.
 * Documentation/differences.md of the sources names all that differs from the paper. The lengths
 * that the constraints speak of are those of the workspace that Metric chooses. Results are the
 * same bits for any number of threads.
 *
 * @par Errors:
 * A message names the port, the array or the value, and the way out; the outputs are empty.
 * Warnings come at the end of a run: if nothing is left, if KeepComponents leaves nothing, if
 * `MissingBoundary` is more than 0.05 at the finest level, with Recovery, without Preview and where
 * KeepComponents leaves out none; and the number of voxels that are NaN, and where MemoryLimit or
 * checkpoints cannot be kept. All else is told by the field data only.
 * @par
 * Update() goes on after an error, so that whatever follows in the pipeline gets the empty outputs.
 * A program asks GetErrorCode() after Update(): 0 (vtkErrorCode::NoError) after a good run, also
 * one that was cancelled, vtkErrorCode::UserError where something given is wrong,
 * vtkErrorCode::UnknownError where the memory does not suffice. Each run sets it anew. The message
 * comes with ErrorEvent; without an observer VTK prints it. A missing input, and inputs of another
 * type at ports 1 and 2, are refused by the pipeline before a run: by ErrorEvent of GetExecutive()
 * only.
 *
 * @par Cancelling:
 * AbortExecute is looked at several times a second, with each progress event: the surface as it is
 * then is handed over, valid, with `StopReason` `cancelled`; an empty one if there is none yet. It
 * counts as up to date, so that what follows in the pipeline can show or write it: another Update()
 * gives it again. The request to stop is forgotten then, or filters behind this one would stop at
 * it, too. To go on call GoOn() first, to run anew Modified(), or change an input or a property.
 *
 * @par Going on:
 * After a run the filter keeps what a run that ends elsewhere can use: with another FinestLevel,
 * Preview, ShowLevels, TimeLimit, MemoryLimit, ScratchDirectory or NumberOfThreads, and nothing
 * else changed, neither in the filter nor in its inputs, a level at which the surface has rested is
 * shown at once, and a finer one is reached from the level at which the last run has ended
 * (FinestLevel 2, then 0). Where someone watches, as ParaView's window does (GetNeedsUpdate()), all
 * components stay, without MemoryLimit and ScratchDirectory: with another KeepComponents,
 * MinimumComponentVolume or, without Initialization Seeds, SeedPositions others are shown at once.
 * The outputs are the same bits as those of a run from the start, but for the seconds in History. To
 * go on it holds the surface and the levels of the pyramid that it has not left, and these only where
 * the run has ended at level 1 or above, so that no memory of level 0 is held; else no more than
 * the surfaces of the levels. A run that was cancelled or ran out of time goes on, by GoOn() or with
 * another TimeLimit, from the last level at which the surface rested: until then it holds what was
 * there (some 280 bytes for each of its vertices) and the levels from there on. ForgetRun() frees
 * all of it; nothing is kept after an error, where ReleaseDataFlag is on, or where an input's
 * data are released.
 *
 * @par Memory:
 * Voxels are read in the type that they have. Levels of the pyramid go as the surface leaves them;
 * those of a pyramid that is the input do where its data are released (ReleaseDataFlagOn() of
 * vtkImagePyramid), else they stay with their owner.
 * @par
 * With MemoryLimit, voxels and meshes live in files of ScratchDirectory, which have no name and
 * vanish with the process, however it ends; as much of them is in memory as the limit allows. The
 * limit is one of the process, as it is the process that is ended where memory is short: what other
 * filters, readers and windows hold counts too, but only what is in the files can leave memory. A
 * limit that cannot be kept is told. It lasts until the filter runs without one, or is
 * deleted; of several filters with limits the smallest counts.
 *
 * @par Checkpoints:
 * With MemoryLimit, a ScratchDirectory or Resume, each level leaves at its end what another process
 * can go on from: a folder `volumic-<16 digits>` in the scratch directory, one for each volume and
 * choice of settings, with the surfaces of the levels so far. It goes when the run is over; it
 * stays where the process is killed, or the run stopped or cut off by TimeLimit. With Resume a run
 * of the same volume and settings goes on from there; those of Going on may differ, but for the
 * choice of components, and Profile.
 * The outputs are the same bits as without interruption, but for the seconds in History; those of
 * the levels that were taken over are the other process's. Where there are only checkpoints of
 * another volume or other settings, it is an error, which names what differs.
 * @par
 * Two runs at a time never share a checkpoint: the second of the same volume and settings leaves
 * none, which is a warning. Where one cannot be written, as the disk is full, that is a warning,
 * too, and the run goes on; where the run itself ends as the disk is full, it takes its checkpoint
 * with it.
 *
 * @par Processes:
 * Where the controller has several processes, and each asks for the piece of its own number of as
 * many pieces, as ParaView's do, they make one surface together, the same bits, and each gets a
 * piece of it, of Levels and of Snapshots: each triangle is in one piece, points at a border are in
 * all that meet there. Points of pieces have `GlobalIds` (vtkIdType, the attribute): the index that
 * they have where there is one process. Ghost levels are given where they are asked for
 * (`vtkGhostType`). Field data is whole in every process, also in empty pieces; the first one has
 * the rows of History. An error of one process is reported by all; AbortExecute of any stops all,
 * after some tenths of a second. ShowLevels has no effect. Whoever asks for other pieces
 * works alone: process 0 of one piece gets the whole surface.
 *
 * @par Thanks:
 * J.-O. Lachaud and A. Montanvert, "Volumic Segmentation using Hierarchical Representation and
 * Triangulated Surface", ECCV 1996.
 *
 * @sa
 * vtkImagePyramid vtkFlyingEdges3D
 */
#ifndef vtkDeformableSurface_h
#define vtkDeformableSurface_h

#include "vtkFiltersVolumicModule.h" // For export macro
#include "vtkPolyDataAlgorithm.h"

#include <vtkSmartPointer.h>

#include <memory> // For what is hidden
#include <string>

class vtkAlgorithmOutput;
class vtkDataObject;
class vtkImageData;
class vtkInformation;
class vtkMultiBlockDataSet;
class vtkMultiProcessController;
class vtkTable;
namespace volumic
{
class Communicator;
struct PyramidOptions;
struct SegmentationRequest;
struct SegmentationVolume;
class SurfaceSegmentation;
}

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
  /**
   * Which component of an array of several is taken, of an image: 0 for the first one; -1, the
   * default: the magnitude. An array of one component is taken as it is with either.
   */
  virtual void SetSelectedComponent(int value);
  virtual int GetSelectedComponent();
  ///@}

  ///@{
  /**
   * Voxels that are NaN are background, whatever is around them, and a warning tells how many there
   * are (for a pyramid, vtkImagePyramid's). Off: they are refused. Default: on.
   */
  virtual void SetNaNIsBackground(bool value);
  virtual bool GetNaNIsBackground();
  vtkBooleanMacro(NaNIsBackground, bool);
  ///@}

  ///@{
  /**
   * Which lengths are even where voxels are not cubes, the two ways of section 5.2 of the paper:
   * World (default): world lengths, so that triangles are well-shaped in millimetres, whatever the
   * slices' distance; Voxels: those of an affine space in which voxels are cubes, so that triangles
   * are stretched as the voxels are, and fewer. No difference where voxels are cubes.
   */
  virtual void SetMetric(int value);
  virtual int GetMetric();
  void SetMetricToVoxels() { this->SetMetric(Voxels); }
  void SetMetricToWorld() { this->SetMetric(World); }
  ///@}

  ///@{
  /**
   * The isopotential that is searched, in the units of the voxels. Must be set (NaN, the default,
   * is an error that tells the range).
   */
  virtual void SetIsoValue(double value);
  virtual double GetIsoValue();
  ///@}

  ///@{
  /**
   * The object is where the field is above IsoValue (off: below). Default: on.
   */
  virtual void SetObjectIsBright(bool value);
  virtual bool GetObjectIsBright();
  vtkBooleanMacro(ObjectIsBright, bool);
  ///@}

  ///@{
  /**
   * Which components the outputs Surface and Levels hold, with their arrays and field data; the
   * evolution is the same. AllComponents (default); LargestComponent: that of the largest area;
   * ComponentsAtPoints: those that enclose a seed of port 1, a point of port 2, or one of the
   * SeedPositions or AttractingPositions, or pass it within the length of an edge (2.5 Delta);
   * LargeComponents: those that enclose at least MinimumComponentVolume (world units cubed, default
   * 0); ComponentsNotAtSeeds: all but those that ComponentsAtPoints finds at a seed of port 1 or at
   * one of the SeedPositions. Cavities go with the component about them: they are kept if it is.
   */
  virtual void SetKeepComponents(int value);
  virtual int GetKeepComponents();
  void SetKeepComponentsToAllComponents() { this->SetKeepComponents(AllComponents); }
  void SetKeepComponentsToLargestComponent() { this->SetKeepComponents(LargestComponent); }
  void SetKeepComponentsToComponentsAtPoints() { this->SetKeepComponents(ComponentsAtPoints); }
  void SetKeepComponentsToLargeComponents() { this->SetKeepComponents(LargeComponents); }
  void SetKeepComponentsToComponentsNotAtSeeds() { this->SetKeepComponents(ComponentsNotAtSeeds); }
  ///@}

  ///@{
  /**
   * Enclosed volume, world units cubed, that KeepComponents LargeComponents asks for. Default: 0.
   */
  virtual void SetMinimumComponentVolume(double value);
  virtual double GetMinimumComponentVolume();
  ///@}

  ///@{
  /**
   * What the surface starts from. EnclosingIcosahedron (default): a rounded box about the image, in
   * the place of the paper's icosahedron. Seeds: icosahedra of SeedRadius that grow inside the
   * object, at the SeedPositions and the points of port 1, or on a grid if there are neither.
   * IsoSurface: the closed iso-surface of the coarsest level. InputSurface: the polygons of port 1.
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
   * SeedPositions: centres of seeds, see Initialization, in world coordinates; none by default.
   * They add to the points of port 1, and spare a source for them. One that lies outside the image
   * by more than a voxel is an error; of those in the image the ones outside the object, or too
   * near to another, are left out. An index that is none gives NaN.
   */
  void AddSeedPosition(double x, double y, double z);
  void ClearSeedPositions();
  int GetNumberOfSeedPositions();
  void GetSeedPosition(int index, double position[3]);
  ///@}

  ///@{
  /**
   * Radius of the seeds in world units; 0, the default: 1.2 delta of the coarsest level. Less than
   * 0.96 delta is taken as that, below which the edges of an icosahedron are too short. With
   * Metric Voxels lengths are those of the workspace, right along the smallest voxel distance.
   */
  virtual void SetSeedRadius(double value);
  virtual double GetSeedRadius();
  ///@}

  ///@{
  /**
   * The level to start at; -1, the default: the last of the pyramid on which anything of the object
   * is left; without Recovery, on which a part of it is left that a surface holds: 36 voxels, and
   * nowhere thinner than two.
   */
  virtual void SetCoarsestLevel(int value);
  virtual int GetCoarsestLevel();
  ///@}

  ///@{
  /**
   * The level to end at; 0, the default: the input. The same as CoarsestLevel: one level alone.
   * FinestLevel -1 goes one level finer than the image: the surface is divided once more, so that
   * delta is that of level 0 over sqrt(3), and evolves on the field of level 0. That leaves eq. 7,
   * which holds at all other levels: the image is sampled more finely than it is. It resolves walls
   * and gaps that are thinner than the triangles of level 0, at about three times their number.
   * What belongs to this level is called level -1: in the field data, in the history, and as
   * `Level -1`, the last block of the output Levels, after those of the pyramid.
   */
  void SetFinestLevel(int level);
  virtual int GetFinestLevel();
  ///@}

  ///@{
  /**
   * Mean length of the edges that is wanted at the finest level, in world units; 0, the default:
   * what FinestLevel and SamplingRatio give, which are not looked at otherwise. Where port 0 has an
   * image, the finest level, the pyramid's reduction factor and the sampling ratio are chosen to
   * fit, the latter two as near as possible to sqrt(3) (vtkVolumeToSurface: its ReductionFactor)
   * and SamplingRatio; where it has a pyramid, the level and the ratio. An error tells the lengths
   * that are possible. The mean of a surface at rest lies between 1.3 and 1.8 delta, as the object
   * is smooth or not; so before the final regularisation delta is changed by small steps, as far as
   * eq. 7 allows, until the mean is right within some percent. With Metric Voxels it is that of the
   * workspace, as Delta is.
   */
  virtual void SetEdgeLength(double value);
  virtual double GetEdgeLength();
  ///@}

  ///@{
  /**
   * Graded triangles: how far a face of the finest level's surface may be from the isopotential, in
   * world units; 0, the default: edges of one length, delta to 2.5 delta, everywhere. The surface is
   * divided for that level only where it asks for it, and where it has come to rest, edges become
   * longer wherever the faces stay within the tolerance, up to MaximumEdgeLength, by the same
   * verified steps: it stays closed, manifold and free of self-intersections. Without ThinParts no
   * edge becomes shorter than without a tolerance, so where the uniform surface is further away (it
   * is too coarse there, or held by a contact) so is this one: the field data `WithinTolerance` and
   * `LargestDistance` tell. About a fifth of a voxel halves the number of vertices of a thick object.
   * Not with EdgeLength, and not without SnapToIsoValue. Coarser levels are not graded; on several
   * ranks the finest level is rank 0's.
   *
   * The peers take the curvature (CGAL's adaptive remeshing, MMG's hausd); here distances are
   * measured, see Documentation/differences.md. No part of the paper.
   */
  virtual void SetTolerance(double value);
  virtual double GetTolerance();
  ///@}

  ///@{
  /**
   * With Tolerance: the longest edge that there is to be, in world units; 0, the default: automatic,
   * 10 delta, which is about six times the mean without Tolerance. Less than 2.5 delta, which edges
   * may be anywhere, is as 2.5 delta, more than 12.5 delta as 12.5 delta.
   */
  virtual void SetMaximumEdgeLength(double value);
  virtual double GetMaximumEdgeLength();
  ///@}

  ///@{
  /**
   * With Tolerance or ThinParts: by how much the wanted length of edges, in delta, grows for each
   * length that is walked, along the surface or across a wall; more than 0, at most 0.3. Little makes
   * triangles even, much makes few of them. Default: 0.2.
   */
  virtual void SetGradation(double value);
  virtual double GetGradation();
  ///@}

  ///@{
  /**
   * Where FinestLevel is 0 (or -1): beyond level 0 the surface goes to level -1, but is divided
   * there only where it is off the isopotential, or the object, or the air in it, is thinner than
   * 2.5 delta, so that triangles of level 0 do not hold it: a wall of a voxel, a narrow gap, a thin
   * vessel. All else keeps its triangles. What Recovery finds there comes with the short edges. The
   * outcome is that of level -1, with the point arrays `EdgeSize` and `Thickness`; level 0 is what
   * it is without ThinParts and Tolerance. It does nothing where the run ends at a coarser level.
   * With Tolerance, edges may become as short where the tolerance asks for it, too. Not with
   * EdgeLength, and not without SnapToIsoValue; on several ranks all voxels are rank 0's. Default:
   * off.
   *
   * No part of the paper.
   */
  virtual void SetThinParts(bool value);
  virtual bool GetThinParts();
  vtkBooleanMacro(ThinParts, bool);
  ///@}

  ///@{
  /**
   * delta_h / U_h (eq. 7): the smallest edge of the surface in units of the level, between
   * sqrt(3)/2.5 = 0.693 and 1. Level -1 has its share of it, see FinestLevel. Default: 0.85.
   */
  virtual void SetSamplingRatio(double value);
  virtual double GetSamplingRatio();
  ///@}

  ///@{
  /**
   * Weight of the force that pulls a vertex to the barycentre of its neighbours, at least 0,
   * without unit as all four. Default: 0.2.
   */
  virtual void SetTensionWeight(double value);
  virtual double GetTensionWeight();
  ///@}

  ///@{
  /**
   * Weight of the springs along the edges, at least 0. Default: 0.1. Springs and tension so strong,
   * against the other forces, that the time steps cannot follow act as strongly as these can.
   */
  virtual void SetElasticityWeight(double value);
  virtual double GetElasticityWeight();
  ///@}

  ///@{
  /**
   * Weight of the force that moves a vertex along its normal to the iso-value, at least 0.
   * Default: 1.
   */
  virtual void SetIsopotentialWeight(double value);
  virtual double GetIsopotentialWeight();
  ///@}

  ///@{
  /**
   * Weight of the descent along the gradient of the image, at least 0. Default: 0. To use it, give
   * an image whose valleys are the boundaries, such as the negative gradient magnitude.
   */
  virtual void SetGradientWeight(double value);
  virtual double GetGradientWeight();
  ///@}

  ///@{
  /**
   * How much the points of port 2 and the AttractingPositions, known to belong to the object,
   * attract the surface (1 by default; 0: not at all); times the point's own `Weight`. Around a
   * point the field is raised to the object's side, the nearer the more, so that a point of weight
   * 1 makes a ball of its `Radius` part of the object even where the image is all background, and a
   * surface that passes nearer than that comes out to the point. Points near each other join: a few
   * close a gap through which the isopotential alone would leak, and points along a vessel keep it
   * at the coarse levels. Under a weight of about 0.3 a point only tips places near IsoValue. A
   * radius is at least two units of the level, so without an array `Radius` the balls shrink with
   * the levels. Merges, Recovery, SnapToIsoValue and `Residual` all see the raised field.
   */
  virtual void SetPointAttractionWeight(double value);
  virtual double GetPointAttractionWeight();
  ///@}

  ///@{
  /**
   * AttractingPositions: points known to belong to the object, in world coordinates, of weight 1
   * and automatic radius; none by default. They add to the points of port 2, see
   * PointAttractionWeight. One that lies outside the image by more than a voxel is an error. An
   * index that is none gives NaN.
   */
  void AddAttractingPosition(double x, double y, double z);
  void ClearAttractingPositions();
  int GetNumberOfAttractingPositions();
  void GetAttractingPosition(int index, double position[3]);
  ///@}

  ///@{
  /**
   * How much edges detected beforehand attract the surface (0, the default: not at all). The map
   * of edges, large on edges, such as the gradient magnitude of the image or Canny's edges, is a
   * second point array of the image of port 0, see Input; its scale does not matter. Where port 0
   * has a pyramid whose blocks don't all carry the array, the map's pyramid is made of block 0's.
   * The force is bounded by this weight, that of the isopotential by IsopotentialWeight: with more
   * than it edges stop the surface, with less they only shift it. For edges that no IsoValue gives
   * choose a value that drives the surface over the flat parts, and 2 here. At the end of a level
   * SnapToIsoValue then leads vertices onto the edges near them, instead of the isopotential.
   */
  virtual void SetEdgeAttractionWeight(double value);
  virtual double GetEdgeAttractionWeight();
  ///@}

  ///@{
  /**
   * Friction per unit of the simulated time, more than 0: little oscillates, much is slow. Where
   * the weights of isopotential, gradient and edges add up to more than 1 it acts times the square
   * root of their sum, so that strong forces oscillate no more than weak ones.
   * Default: 3.
   */
  virtual void SetFriction(double value);
  virtual double GetFriction();
  ///@}

  ///@{
  /**
   * What the field is outside the image. Background (default): away from the object, so that
   * surfaces close at the border, within a voxel of it. Replicate: the nearest voxel as far as two
   * units of the level beyond the outermost voxels (a voxel along axes where that is longer), and
   * background from there on, so that surfaces close at most half a unit further out. With any
   * setting, also of forces that know of no background, no vertex goes further out than three units
   * (a voxel and one unit); what an initial surface has further out only comes nearer.
   */
  virtual void SetBorderValue(int value);
  virtual int GetBorderValue();
  void SetBorderValueToBackground() { this->SetBorderValue(Background); }
  void SetBorderValueToReplicate() { this->SetBorderValue(Replicate); }
  ///@}

  ///@{
  /**
   * Parts of the object that a coarser level could not resolve lie outside the surface when it
   * comes to a level. RecoverObjects (default) encloses each part of at least MinimumPartSize
   * voxels of that level with a new component, which shrinks onto it and merges with the rest where
   * they touch; RecoverObjectsAndCavities does the same for background that the object encloses,
   * with cavities, which a surface that comes from outside cannot reach otherwise (seeds in the
   * object and the start from the iso-surface can); NoRecovery is the paper's behaviour, where only
   * what is connected to the surface is found again. Field data and History tell how many parts
   * were found, `MissingParts` and `MissingBoundary` what of them the surface has not got in the
   * end.
   */
  virtual void SetRecovery(int value);
  virtual int GetRecovery();
  ///@}

  ///@{
  /**
   * Voxels of a level that a lost part must have there to be recovered. Default: 20.
   */
  virtual void SetMinimumPartSize(int value);
  virtual int GetMinimumPartSize();
  ///@}

  ///@{
  /**
   * Merges and cuts (default: on). Off: contacts only stop the surface, its topology stays.
   */
  virtual void SetTopologyChanges(bool value);
  virtual bool GetTopologyChanges();
  vtkBooleanMacro(TopologyChanges, bool);
  ///@}

  ///@{
  /**
   * Iterations per level at most. Default: 1000.
   */
  virtual void SetMaximumNumberOfIterations(int value);
  virtual int GetMaximumNumberOfIterations();
  ///@}

  ///@{
  /**
   * A level rests when the enclosed volume changes by less than this share of it, or than delta^3,
   * over 10 and over 20 iterations. The paper lets each level converge completely, and shows the
   * kinetic energy: but that is small while tips still grow, and some vertices always stir.
   * Default: 0.0005.
   */
  virtual void SetConvergenceTolerance(double value);
  virtual double GetConvergenceTolerance();
  ///@}

  ///@{
  /**
   * Vertices at rest are skipped until something near them changes (the paper's heuristic).
   * Default: on.
   */
  virtual void SetFreezeMotionlessVertices(bool value);
  virtual bool GetFreezeMotionlessVertices();
  vtkBooleanMacro(FreezeMotionlessVertices, bool);
  ///@}

  ///@{
  /**
   * At the end of a level, move vertices onto the isopotential as far as the constraints allow.
   * Default: on.
   */
  virtual void SetSnapToIsoValue(bool value);
  virtual bool GetSnapToIsoValue();
  vtkBooleanMacro(SnapToIsoValue, bool);
  ///@}

  ///@{
  /**
   * Number of threads; 0, the default: all that vtkSMPTools has, and where its backend is sequential
   * by default, as in Debian's ParaView, one per processor. Results do not depend on it.
   */
  void SetNumberOfThreads(int number);
  virtual int GetNumberOfThreads();
  ///@}

  ///@{
  /**
   * Resident memory that the process may have, MiB (2^20 bytes); 0, the default: no limit. See
   * Memory. Results do not depend on it.
   */
  void SetMemoryLimit(int mebibytes);
  virtual int GetMemoryLimit();
  ///@}

  ///@{
  /**
   * With MemoryLimit: the folder for what does not fit, on a disk with room for all of it. Empty,
   * the default: TMPDIR of the environment, or /var/tmp.
   */
  void SetScratchDirectory(const char* directory);
  virtual const char* GetScratchDirectory();
  ///@}

  ///@{
  /**
   * Go on from the checkpoint that a run of the same volume and settings has left, which did not
   * come to its end: it was killed, or stopped. Where there is none the run begins anew. See
   * Checkpoints. Default: off.
   */
  void SetResume(bool resume);
  virtual bool GetResume();
  vtkBooleanMacro(Resume, bool);
  ///@}

  /**
   * For programs that write the surface: the checkpoints of the runs to come stay when these are
   * over, that of the last level included, until RemoveCheckpoint(). Where the surface cannot be
   * written, another process has it again at once.
   */
  void LeaveCheckpoints();

  /** Removes the checkpoint of the last run. */
  void RemoveCheckpoint();

  /** The folder of the checkpoint that the last run has left; empty: none. */
  std::string GetCheckpointFolder();

  /** The level that the last run has gone on from by Resume; -2: it has begun anew. */
  int GetResumedLevel();

  ///@{
  /**
   * Seconds after which a run ends with the surface as it is then, `StopReason` `time limit`; 0,
   * the default: none. They count from the start of RequestData(), the pyramid that is built there
   * included, and are looked at as often as AbortExecute, so that a run may be some tenths longer.
   * Levels at rest before stay in Levels; a run that has no surface yet gives an empty one.
   */
  void SetTimeLimit(double seconds);
  virtual double GetTimeLimit();
  ///@}

  ///@{
  /**
   * End at a coarse level, fine enough to judge an IsoValue: the finest from FinestLevel on that
   * has at most a million voxels, or the coarsest of the run if none has; with Recovery a finer one,
   * if that is known to miss more than 5 % of the object's boundary (MissingBoundary). Switched off,
   * the run goes on from there (see Going on). Default: off.
   */
  void SetPreview(bool preview);
  virtual bool GetPreview();
  vtkBooleanMacro(Preview, bool);
  ///@}

  ///@{
  /**
   * In ParaView's window: show the surface of each level as soon as it rests, from the one of
   * Preview on, while finer ones go on. Each is a run of its own that goes on from the last one,
   * also for TimeLimit; with EdgeLength or Tolerance there are two. Elsewhere it has no effect: a run goes to
   * its end at once. Default: off.
   */
  void SetShowLevels(bool show);
  virtual bool GetShowLevels();
  vtkBooleanMacro(ShowLevels, bool);
  ///@}

  /**
   * With ShowLevels: whether a finer level is still to come; it is then computed at the next
   * Update(). ParaView's window asks it of its live sources several times a second. Who asks it
   * gets the levels one by one.
   */
  bool GetNeedsUpdate();

  /**
   * After a run that was stopped: the next Update() goes on from the last level at which the surface
   * rested, or begins anew where there is none. Of a run that was not it gives the same again.
   */
  void GoOn();

#ifndef __VTK_WRAP__ // It is no property of ours.
  /** As of all algorithms, but while no run is under way it asks for nothing, and changes nothing. */
  void SetAbortExecute(vtkTypeBool abort) override;
#endif

  /** Frees what is kept of the last run, see Going on. */
  void ForgetRun();

  ///@{
  /**
   * Whether the history also tells where the time goes, by the columns ForcesSeconds and so on.
   * Default: off.
   */
  virtual void SetProfile(bool value);
  virtual bool GetProfile();
  vtkBooleanMacro(Profile, bool);
  ///@}

  ///@{
  /**
   * Keep the surface at the start of each level and after every so many iterations, at the end of
   * the sweep of five in which one is due, in output 3, to see it evolve; 0, the default: off. Each
   * costs the memory of a whole surface.
   */
  virtual void SetSnapshotInterval(int value);
  virtual int GetSnapshotInterval();
  ///@}

  ///@{
  /**
   * The processes that make a surface together, see Processes. Default: the global controller of
   * the program, null where it has none.
   */
  virtual void SetController(vtkMultiProcessController* controller);
  virtual vtkMultiProcessController* GetController();
  ///@}

  /** The initial surface or the centres of the seeds: port 1. */
  void SetInitialSurfaceConnection(vtkAlgorithmOutput* output);

  /** The same as data that is no filter's output. */
  void SetInitialSurfaceData(vtkDataObject* data);

  /** The points known to belong to the object: port 2. */
  void SetAttractingPointsConnection(vtkAlgorithmOutput* output);

  /** The same as data that is no filter's output. */
  void SetAttractingPointsData(vtkDataObject* data);

  /** Output 1: the surface of each level. */
  vtkMultiBlockDataSet* GetLevels();

  /** Output 2: a row per iteration. */
  vtkTable* GetHistory();

  /** Output 3: the surface on its way; see SnapshotInterval. */
  vtkMultiBlockDataSet* GetSnapshots();

protected:
  vtkDeformableSurface();
  ~vtkDeformableSurface() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

  /// Without levels, the rest as the properties have it.
  volumic::SegmentationVolume VolumeAsSet();
  /// Makes the pyramid of an image, for EdgeLength if there is one.
  void MakeLevels(const volumic::PyramidOptions& pyramid, vtkImageData* image,
    volumic::SegmentationVolume& volume);
  /// What the surface is searched in, of the data of input port 0; its levels are null where
  /// ShowPyramidProgress() said stop. Errors are thrown as std::invalid_argument.
  virtual volumic::SegmentationVolume PrepareVolume(vtkDataObject* input);
  /// Those that work on the run that is under way.
  volumic::Communicator& Ranks();
  /// The data of input port 0, which come in slabs where the memory is limited and the source can;
  /// then what `volume` tells of the voxels is changed to fit. Null after a stop.
  vtkSmartPointer<vtkDataObject> ReadInput(
    vtkDataObject* input, bool takesCells, volumic::SegmentationVolume& volume);
  /// Told at the end of the run, once: ParaView's message box would cover the progress bar.
  void Warn(const std::string& text);
  /// For the share of a pyramid that PrepareVolume() builds; false asks to stop.
  bool ShowPyramidProgress(double share, const char* text = "Building the pyramid");

private:
  class vtkInternals;
  /// What a run is asked for by the properties and the inputs.
  volumic::SegmentationRequest RequestAsSet(vtkInformationVector** input);
  /// Makes it a request for the next level to be shown, if it is not the last one.
  void ChooseStep(volumic::SegmentationRequest& request, bool isKept);
  /// Fills the outputs with what is kept. @return whether it is all that is asked for.
  bool ShowKept(const volumic::SegmentationRequest& request, vtkInformationVector* output);
  /// By all ranks: a run from the start, at rank 0; null where the making of its levels was
  /// stopped.
  std::unique_ptr<volumic::SurfaceSegmentation> NewRun(
    const volumic::SegmentationRequest& request, vtkDataObject* input);
  enum class Course
  {
    IsShown, ///< It was kept.
    GoesOn,
    BeginsAnew
  };
  /// At rank 0. @param run gets the one that goes on, if there is one
  Course ChooseCourse(bool isKept, volumic::SegmentationRequest& request,
    std::unique_ptr<volumic::SurfaceSegmentation>& run, vtkInformationVector* output);
  /// On all ranks; the outputs are filled at rank 0.
  void RunOrGoOn(vtkInformationVector** input, vtkInformationVector* output);
  void ShowRun(const volumic::SurfaceSegmentation& run,
    const volumic::SegmentationRequest& request, vtkInformationVector* output);
  /// Whether this rank or another one was asked to stop.
  bool IsStopped();
  /// Of all that Warn() was given, unless another run is still to come.
  void TellWarnings();
  std::unique_ptr<vtkInternals> Internals; ///< the properties, and what is kept of the last run

  vtkDeformableSurface(const vtkDeformableSurface&) = delete;
  void operator=(const vtkDeformableSurface&) = delete;
};

#endif
