// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceOptions_h
#define volumicSurfaceOptions_h

#include "Core/Image/FieldOptions.h"

#include <cstdint>

namespace volumic
{
/** Consequences of the forces that act, see SurfaceOptions::Drive(). */
struct SurfaceDrive
{
  enum class Goal
  {
    None,
    IsoValue,
    Edges ///< ridges of LevelImage::Edges
  };

  /** Voxel values define the object: parts can be missed, and merges can be tested. */
  bool HasObject = false;
  /** Only the isopotential force determines the final position. */
  bool IsFieldAlone = false;
  /** The final position is known before a level starts: the surface may descend the field first. */
  bool IsPredictable = false;
  /** The final surface lies at the iso-value, which tolerance and thickness require. */
  bool LiesAtIsoValue = false;
  /** Target of vertices at the end of a level. */
  Goal SnapsTo = Goal::None;
};

/**
 * Properties of the deformable surface, with their defaults. Weights are relative to a mass of 1
 * per vertex. Forces are in delta, so the same weights suit all levels.
 */
struct SurfaceOptions : FieldOptions
{
  double SeedRadius = 0.;      ///< in the computational space; 0: 1.2 delta
  double SamplingRatio = 0.85; ///< delta_h / U_h, in [sqrt(3)/2.5, 1] (eq. 7)

  double TensionWeight = 0.2;        ///< F_c, to the barycentre of the neighbours
  double ElasticityWeight = 0.1;     ///< F_e, springs along edges, rest length 1.6 delta
  double IsopotentialWeight = 1.;    ///< F_i, along the normal, bounded by 1
  double GradientWeight = 0.;        ///< F_di, descent along the discrete gradient, see Dynamics
  double PointAttractionWeight = 1.; ///< see PointAttraction
  /** See EdgeAttraction. Edges stop the surface if this exceeds IsopotentialWeight. */
  double EdgeAttractionWeight = 0.;
  double Friction = 3.; ///< per unit of time, see Dynamics

  bool TopologyChanges = true; ///< off: contacts only stop the surface

  int MaximumNumberOfIterations = 1000; ///< per level
  /**
   * A level has converged when its volume changes by less than max(delta^3, this fraction of it)
   * over the last 10 and over the last 20 iterations. See also CycleCriterion.
   */
  double ConvergenceTolerance = 5e-4;
  bool FreezeMotionlessVertices = true; ///< Skip converged vertices until something near changes.
  /**
   * At the end of a level, move vertices onto the isosurface, or with an EdgeAttractionWeight, onto
   * nearby edges.
   */
  bool SnapToIsoValue = true;

  /**
   * After a division, recover the parts of the object that the coarser level has missed
   * (Documentation/differences.md).
   */
  bool RecoverMissedParts = true;
  bool RecoverCavities = false; ///< Recover enclosed background, too.
  int MinimumPartSize = 20;     ///< smallest number of voxels of a recovered part

  double MaximumStep = 0.5; ///< largest displacement per iteration, in delta; at most 0.5
  /**
   * Edge length of blocks in delta; 0: SurfaceBlocks::SideInDelta, the smallest that allows
   * parallel passes. For tests only.
   */
  double BlockSide = 0.;

  /** Derive the SurfaceDrive from the weights. */
  SurfaceDrive Drive() const
  {
    using Goal = SurfaceDrive::Goal;
    const bool hasEdges = this->EdgeAttractionWeight > 0.;
    SurfaceDrive drive;
    drive.HasObject = this->IsopotentialWeight > 0.;
    drive.IsFieldAlone = drive.HasObject && !hasEdges && !(this->GradientWeight > 0.);
    drive.IsPredictable =
      drive.IsFieldAlone && this->SnapToIsoValue && this->FreezeMotionlessVertices;
    drive.LiesAtIsoValue =
      this->SnapToIsoValue && this->IsopotentialWeight > this->EdgeAttractionWeight;
    drive.SnapsTo = !this->SnapToIsoValue ? Goal::None : hasEdges ? Goal::Edges : Goal::IsoValue;
    return drive;
  }
};

/** Weight of a force, 0 or more, with the label of its property. */
struct WeightOfForce
{
  const char* Name;
  double SurfaceOptions::*Value;
};
inline constexpr WeightOfForce WeightsOfForces[] = {
  { "Tension Weight", &SurfaceOptions::TensionWeight },
  { "Elasticity Weight", &SurfaceOptions::ElasticityWeight },
  { "Isopotential Weight", &SurfaceOptions::IsopotentialWeight },
  { "Gradient Weight", &SurfaceOptions::GradientWeight },
  { "Point Attraction Weight", &SurfaceOptions::PointAttractionWeight },
  { "Edge Attraction Weight", &SurfaceOptions::EdgeAttractionWeight },
};
}

#endif
