// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelSurface_h
#define volumicLabelSurface_h

#include "Core/Common/IndexedSurface.h"
#include "Core/Evolution/EdgeLengthPlan.h"
#include "Core/Labels/LabelClaims.h"
#include "Core/Labels/LabelField.h"
#include "Host/HostThreads.h"
#include "Labels/LabelSettings.h"
#include "Settings/SegmentationSettings.h"

#include <vtkSmartPointer.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

class vtkImageData;
class vtkPolyData;

namespace volumic
{
/** The surface of one object, as vtkDeformableSurface gives it. */
struct LabelSurface
{
  vtkSmartPointer<vtkPolyData> Surface; ///< null: it was not begun
  double Seconds = 0.0;                 ///< that the work on it took, from its begin to its end
  vtkIdType WrongVoxels = 0;
  vtkIdType MissedVoxels = 0;  ///< those of them that are so by more than the tolerances
  double VolumeError = 0.0;    ///< by how much its volume is more than that of the voxels, in that
  vtkIdType TouchingFaces = 0; ///< with Gap: those where it meets neighbours all the same
  bool IsFiner = false;        ///< Level 0 has lost parts: it is one of level -1.
  bool IsFinished = false;     ///< It was not stopped on its way.

  /** Whether VolumeError is more than a label of so many voxels should have. */
  bool IsVolumeOff(vtkIdType voxels) const
  {
    return voxels >= 100 && std::abs(this->VolumeError) > 0.03;
  }
};

/** LabelSurface::VolumeError, of a surface in coordinates of voxels. */
double VolumeErrorOf(const IndexedSurface& inVoxels, std::int64_t voxels);

/**
 * A place in the map, of one in the box of a label. Differences of such places are the same bits
 * wherever the map begins, so that a label has the same surface in a crop of the map.
 */
Point InMap(const Point& inBox, const std::array<int, 3>& first);

/** Makes surfaces of objects of a label map; of several at a time, each on a thread of its own. */
class LabelSurfaceMaker
{
public:
  /** Told the share that is done, on the thread that does it; false asks to stop. */
  using Progress = std::function<bool(double share, const std::string& text)>;

  /**
   * @param image its geometry is the map's
   * All must outlive it.
   * @throws std::invalid_argument naming the lengths that are possible, if EdgeLength is none.
   */
  LabelSurfaceMaker(const LabelBricks& bricks, vtkImageData* image, const LabelSettings& settings);

  /** How the fields of objects are made. */
  static LabelFieldOptions FieldOptions(const LabelSettings& settings, const LabelMap& map);

  /**
   * @throws std::invalid_argument naming the lengths that are possible, if EdgeLength is none.
   */
  static EdgeLengthPlan PlanOf(const LabelSettings& settings, vtkImageData* image);

  /** Where objects meet by threes: first of all objects, before any surface is made. */
  bool HasClaims() const { return this->Bricks.HasContested(); }
  void AddClaim(int object, HostThreads& threads);

  /**
   * On any thread. What a surface does not hold, and a volume that is off, is tried without
   * VoxelTolerance, and then what that does not hold with the triangles of level -1.
   * @param numberOfThreads those of `threads`; 0: all
   */
  LabelSurface Make(
    int object, int numberOfThreads, HostThreads& threads, const Progress& progress) const;

  /** With Gap: whether surfaces of neighbours must stay apart. */
  bool KeepsApart() const { return this->Settings.Gap > 0.0; }
  /** Voxels of each object, from 1 on. */
  using VoxelsOfObjects = std::vector<std::vector<std::array<int, 3>>>;
  /** Where surfaces touch each other, or lie within each other; sets TouchingFaces. */
  VoxelsOfObjects FindTouchingVoxels(
    std::vector<LabelSurface>& surfaces, HostThreads& threads) const;
  /**
   * Has the next surfaces stay further inside there, and begin with the triangles of level -1
   * where these are due.
   */
  void Lower(const VoxelsOfObjects& voxels, const std::vector<std::uint8_t>& areFiner);

private:
  /** A field and the image that shows its values. */
  struct FieldImage
  {
    LabelFieldOptions Options;
    LabelField Field;
    vtkSmartPointer<vtkImageData> Image;
  };
  /** How many times as large the unit of a level is as that of the level below. */
  double LevelFactor() const
  {
    return this->Settings.EdgeLength != 0.0 ? this->Plan.ReductionFactor : std::sqrt(3.0);
  }
  /** The finest level, as planned with EdgeLength. */
  int FinestLevel() const
  {
    return this->Settings.EdgeLength != 0.0 ? this->Plan.FinestLevel : this->Settings.FinestLevel;
  }
  /** Half of the gap, in smallest distances of voxels. */
  double HalfGap() const;
  /** What a surface is made with. */
  struct Place
  {
    int Level = 0;
    bool IsForThinParts = false; ///< alone, level 0 for all else
    bool IsStrict = false;       ///< without VoxelTolerance
    double Smoothing = 1.0;      ///< a share of Sigma
  };
  /** In their order, until nothing is lost, and no tolerance costs volume. */
  std::vector<Place> PlacesToTry(int object) const;
  /** MakeAt(), and with less smoothing as long as the volume is not that of the voxels. */
  LabelSurface MakeWithVolume(const Place& place, int object, int numberOfThreads,
    HostThreads& threads, const Progress& progress) const;
  LabelSurface MakeAt(const Place& place, int object, int numberOfThreads, HostThreads& threads,
    const Progress& progress) const;
  /** Whether its volume is not that of the voxels, though nothing asks for another one. */
  bool HasVolumeOff(int object, const LabelSurface& made) const;
  /** Whether a level finer than the image may hold what this surface leaves out. */
  bool LosesParts(int object, const LabelSurface& made) const;
  FieldImage MakeField(const Place& place, int object, HostThreads& threads) const;
  /** A run of the surface of a field, but for Revise; without levels where it was stopped. */
  SegmentationRequest MakeRequest(
    const Place& place, vtkImageData* field, int numberOfThreads, const Progress& progress) const;
  /** Smallest distances of voxels from a surface within which a wrong centre is no fault of it. */
  double AllowedDistance() const;
  /** The wrong voxels that are further from the surface than that. */
  std::vector<std::int64_t> FindMissed(int object, const IndexedSurface& surface) const;
  /** In coordinates in which voxel (i, j, k) of the map is at (i, j, k). */
  IndexedSurface InVoxels(int object, vtkPolyData* surface) const;
  /** How often a field has been changed, and the last time for its volume, by what. */
  struct Revision
  {
    int Round = 0;
    int Shifts = 0;
    double LastShift = 0.0;      ///< smallest distances of voxels
    double LastError = 0.0;      ///< voxels
    std::size_t LastOutside = 0; ///< triangles, the last time that it was drawn back for a gap
  };
  /**
   * Changes the field where the surface that follows it should be elsewhere: where voxels are cut
   * off, then where its volume is not that of the voxels.
   * @param surface in coordinates of the voxels of the map
   * @return whether it has
   */
  bool ReviseField(int object, Revision& revision, const IndexedSurface& surface,
    const LabelField& original, FieldImage& made) const;
  bool CorrectVolume(
    int object, Revision& revision, const IndexedSurface& surface, FieldImage& made) const;

  const LabelBricks& Bricks;
  vtkImageData* Image;
  const LabelSettings& Settings;
  LabelFieldOptions Options;
  EdgeLengthPlan Plan; ///< with EdgeLength
  LabelClaims Claims;
  /** How an object is kept apart from others that its surfaces have met. */
  struct Lowering
  {
    int Times = 0; ///< that its surface has met others
    /** At which its field is lowered, once for each time that they are named. */
    std::vector<std::array<int, 3>> Voxels;
    bool IsFiner = false; ///< its last surface
  };
  std::vector<Lowering> Lowered; ///< by object
};
}

#endif
