// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSegmentationSettings_h
#define volumicSegmentationSettings_h

#include "Core/Common/Grading.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Common/ThrowInvalidArgument.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "Core/Image/PyramidGeometry.h"
#include "Input/ComputationalSpace.h"
#include "Input/ImageVoxels.h"

#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <limits>
#include <string>
#include <vector>

namespace volumic
{
/** @throws InvalidArgument naming the property unless the value is in 0 to `last` */
template <typename Enumeration>
void CheckEnumeration(const char* name, Enumeration value, Enumeration last)
{
  const int number = static_cast<int>(value);
  if (number < 0 || value > last)
  {
    ThrowInvalidArgument(name, " is ", number, ". Set it to 0 to ", static_cast<int>(last), ".");
  }
}

/** @throws InvalidArgument naming the property that is out of range */
void CheckGrading(const Grading& grading, double edgeLength);

enum class InitializationType
{
  EnclosingIcosahedron = 0,
  Seeds = 1,
  IsoSurface = 2,
  InputSurface = 3
};

enum class RecoveryType
{
  NoRecovery = 0,
  RecoverObjects = 1,
  RecoverObjectsAndCavities = 2
};

enum class KeepComponentsType
{
  AllComponents = 0,
  LargestComponent = 1,
  ComponentsAtPoints = 2,
  LargeComponents = 3,
  ComponentsNotAtSeeds = 4
};

/**
 * The settings of a run that do not affect its converged levels. A run with other values of these
 * settings resumes the kept run. SeedPositions affect the levels if the run starts from seeds.
 */
struct SegmentationEnd
{
  int FinestLevel = 0;
  KeepComponentsType KeepComponents = KeepComponentsType::AllComponents;
  double MinimumComponentVolume = 0.0; ///< world units cubed
  std::vector<Point> SeedPositions;    ///< world coordinates, in addition to input port 1
  double TimeLimit = 0.0;              ///< seconds; 0: none
  bool Preview = false;                ///< end at a level with few voxels
  bool ShowLevels = false;
  unsigned NumberOfThreads = 0; ///< 0: all
  std::string ScratchDirectory; ///< for large arrays; empty: they are in memory
};

/**
 * The properties of vtkDeformableSurface with their defaults. Values may be out of range until
 * SegmentationRun has checked them.
 */
struct SegmentationSettings
{
  SegmentationSettings() { this->Options.IsoValue = std::numeric_limits<double>::quiet_NaN(); }

  /** SeedRadius is in world units. Recovery sets RecoverMissedParts and RecoverCavities. */
  SurfaceOptions Options;
  SegmentationEnd End;

  PyramidOptions Pyramid; ///< for input images
  bool OfImages = false;  ///< Accept cell data, and compute IsoValue if it is not set.
  int SelectedComponent = -1;
  bool NaNIsBackground = true;
  double UpperValue = std::numeric_limits<double>::infinity();
  bool UseUpperValue = true;
  volumic::Metric Metric = volumic::Metric::World;
  volumic::Grading Grading; ///< at the finest level, world units
  double EdgeLength = 0.0;  ///< mean at the finest level, world units; 0: from FinestLevel
  InitializationType Initialization = InitializationType::EnclosingIcosahedron;
  int CoarsestLevel = -1;                 ///< -1: automatic
  std::vector<Point> AttractingPositions; ///< world coordinates, in addition to input port 2
  RecoveryType Recovery = RecoveryType::RecoverObjects;
  int SnapshotInterval = 0; ///< iterations; 0: no snapshots

  /** Return the range of the object's values. @throws InvalidArgument if it is invalid */
  ValueRange Range() const
  {
    ValueRange range;
    range.Lower = this->Options.IsoValue;
    range.Upper = this->UseUpperValue ? this->UpperValue : range.Upper;
    range.Check();
    return range;
  }
  /** @throws InvalidArgument naming a property that is out of range or does not match others */
  void Check() const;
  /** Return the level at which a run ends. ThinParts continues to level -1. */
  int LastLevel() const
  {
    return this->Grading.ThinParts && this->End.FinestLevel == 0 ? -1 : this->End.FinestLevel;
  }
  /** Return whether to warn of missing parts. A selection of components might not keep them. */
  bool WarnsOfMissingParts() const
  {
    return this->Recovery != RecoveryType::NoRecovery && !this->End.Preview &&
      this->End.KeepComponents == KeepComponentsType::AllComponents;
  }
};

/** The settings and inputs of a run. */
struct SegmentationRequest
{
  /** The properties with resolved automatic values, and with the finest level of this step. */
  SegmentationSettings Settings;

  vtkSmartPointer<vtkDataObject> Volume;         ///< input port 0
  vtkSmartPointer<vtkPolyData> InitialSurface;   ///< input port 1, may be missing
  vtkSmartPointer<vtkPolyData> AttractingPoints; ///< input port 2, may be missing
  vtkSmartPointer<vtkInformation> Selection;     ///< of the voxels, from GetInputArrayInformation()
  vtkInformation* EdgeSelection = nullptr;       ///< of the edge map; ignored at weight 0

  bool IsStep = false;    ///< A finer level follows. Do not warn about the surface yet.
  bool MayResume = false; ///< Keep the converged surface while a finer level evolves.
  bool KeepsAll = false;  ///< Keep all components for another selection.
};
}

#endif
