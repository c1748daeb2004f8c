// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSegmentationSettings_h
#define volumicSegmentationSettings_h

#include "Core/Common/Grading.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Common/Refuse.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "Core/Image/PyramidGeometry.h"
#include "Input/ImageVoxels.h"
#include "Input/Workspace.h"

#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <limits>
#include <string>
#include <vector>

namespace volumic
{
/**
 * Properties of VTK classes give enumerations as any int: this refuses what is none of them.
 * @param name of the property, for the message
 * @param last the largest of the enumeration, which begins at 0 and leaves none out
 */
template <typename Enumeration>
void CheckEnumeration(const char* name, Enumeration value, Enumeration last)
{
  const int number = static_cast<int>(value);
  if (number < 0 || value > last)
  {
    Refuse(name, " is ", number, "; it must be 0 to ", static_cast<int>(last), ".");
  }
}

/** @throws std::invalid_argument naming the property that is out of range. */
void CheckGrading(const Grading& grading, double edgeLength);

/** What the surface starts from. */
enum class InitializationType
{
  EnclosingIcosahedron = 0,
  Seeds = 1,
  IsoSurface = 2,
  InputSurface = 3
};

/** What is done about parts of the object that a coarser level has lost. */
enum class RecoveryType
{
  NoRecovery = 0,
  RecoverObjects = 1,
  RecoverObjectsAndCavities = 2
};

/** Which components of the surfaces the outputs hold. */
enum class KeepComponentsType
{
  AllComponents = 0,
  LargestComponent = 1,
  ComponentsAtPoints = 2,
  LargeComponents = 3,
  ComponentsNotAtSeeds = 4
};

/**
 * Where a run ends, what of its surfaces is put out, and how much time and how many threads it
 * has. A run can go on from where one has ended that differs from it by these only (by seeds, if
 * it does not start from them).
 */
struct SegmentationEnd
{
  int FinestLevel = 0;
  KeepComponentsType KeepComponents = KeepComponentsType::AllComponents;
  double MinimumComponentVolume = 0.0; ///< world units cubed
  std::vector<Point> SeedPositions;    ///< world, beside those of input port 1
  double TimeLimit = 0.0;              ///< seconds; 0: none
  bool Preview = false;                ///< End at a level of few voxels.
  bool ShowLevels = false;
  int NumberOfThreads = 0;      ///< 0: all
  std::string ScratchDirectory; ///< for large arrays; empty: they are in memory
};

/**
 * The properties of vtkDeformableSurface, which documents them, with their only defaults: it writes
 * them here, and hands them to a run as they are. Numbers, also those of enumerations, may be out
 * of range: SegmentationRun checks them.
 */
struct SegmentationSettings
{
  SegmentationSettings() { this->Options.IsoValue = std::numeric_limits<double>::quiet_NaN(); }

  /** SeedRadius in world units; Recovery decides on RecoverLostParts and RecoverCavities. */
  SurfaceOptions Options;
  SegmentationEnd End;

  PyramidOptions Pyramid; ///< of an image
  bool OfImages = false;  ///< Cells count as points, and an iso-value that is not set is found.
  int SelectedComponent = -1;
  bool NaNIsBackground = true;
  double UpperValue = std::numeric_limits<double>::infinity();
  bool UseUpperValue = true;
  volumic::Metric Metric = volumic::Metric::World;
  volumic::Grading Grading; ///< at the finest level, world units
  double EdgeLength = 0.0;  ///< mean at the finest level, world units; 0: as FinestLevel has it
  InitializationType Initialization = InitializationType::EnclosingIcosahedron;
  int CoarsestLevel = -1; ///< -1: the last that serves
  std::vector<Point> AttractingPositions; ///< world, beside those of input port 2
  RecoveryType Recovery = RecoveryType::RecoverObjects;
  int SnapshotInterval = 0; ///< iterations; 0: no snapshots

  /** The values of the object, where they have an upper end, too. @throws as Check() of it */
  ValueRange Range() const
  {
    ValueRange range;
    range.Lower = this->Options.IsoValue;
    range.Upper = this->UseUpperValue ? this->UpperValue : range.Upper;
    range.Check();
    return range;
  }
  /**
   * @throws std::invalid_argument naming the first property of those that the levels don't look at
   *         which is out of range, or does not go with others.
   */
  void Check() const;
  /** The level that a run ends at: -1 where thin parts are followed beyond level 0. */
  int LastLevel() const
  {
    return this->Grading.ThinParts && this->End.FinestLevel == 0 ? -1 : this->End.FinestLevel;
  }
  /**
   * Whether parts of the object that no surface has are worth a warning. Of parts that are not
   * there nobody can say whether they would have been kept.
   */
  bool WantsAllParts() const
  {
    return this->Recovery != RecoveryType::NoRecovery && !this->End.Preview &&
      this->End.KeepComponents == KeepComponentsType::AllComponents;
  }
};

/** The settings and inputs of a run. */
struct SegmentationRequest
{
  /** The properties with automatic values resolved, and with the finest level of a step. */
  SegmentationSettings Settings;

  vtkSmartPointer<vtkDataObject> Volume;         ///< input port 0
  vtkSmartPointer<vtkPolyData> InitialSurface;   ///< input port 1, may be missing
  vtkSmartPointer<vtkPolyData> AttractingPoints; ///< input port 2, may be missing
  vtkSmartPointer<vtkInformation> Selection; ///< of the voxels, as GetInputArrayInformation()
  vtkInformation* EdgeSelection = nullptr;   ///< of the edge map; ignored at weight 0

  bool IsStep = false;   ///< A finer level follows, so warnings about the surface would be early.
  bool MayGoOn = false;  ///< Keep the converged surface while a finer level evolves.
  bool KeepsAll = false; ///< Keep all components for another selection.
};
}

#endif
