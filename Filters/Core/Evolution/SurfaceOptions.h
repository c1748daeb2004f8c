// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceOptions_h
#define volumicSurfaceOptions_h

#include "Core/Image/FieldOptions.h"

#include <cstdint>

namespace volumic
{
/** What drives the surface: all that depends on which forces act. See SurfaceOptions::Drive(). */
struct SurfaceDrive
{
  enum class Goal
  {
    None,
    IsoValue,
    Edges ///< The ridges of LevelImage::Edges.
  };

  /** The values of voxels determine what the object is: parts can be missing, and merges right. */
  bool HasObject = false;
  /** No force beside the isopotential force can stop the surface off the isopotential. */
  bool IsFieldAlone = false;
  /** The final position is known before a level begins: the surface may descend the field first. */
  bool IsPredictable = false;
  /** The surface of a level lies at the iso-value, from which tolerance and thickness are measured.
   */
  bool LiesAtIsoValue = false;
  /** What vertices snap to at the end of a level. */
  Goal SnapsTo = Goal::None;
};

/**
 * All properties of the deformable surface, with their only defaults.
 * Weights are relative to a mass of 1 per vertex; forces are measured in delta, so that one set
 * of weights serves every level.
 */
struct SurfaceOptions : FieldOptions
{
  double SeedRadius = 0.;      ///< Radius of seeds, workspace; 0 = 1.2 delta.
  double SamplingRatio = 0.85; ///< delta_h / U_h, in [sqrt(3)/2.5, 1] (eq. 7).

  double TensionWeight = 0.2;        ///< F_c, towards the barycentre of the neighbours.
  double ElasticityWeight = 0.1;     ///< F_e, springs along edges, rest length 1.6 delta.
  double IsopotentialWeight = 1.;    ///< F_i, along the normal, bounded by 1.
  double GradientWeight = 0.;        ///< F_di, descent along the discrete gradient; see Dynamics.h.
  double PointAttractionWeight = 1.; ///< Of points known to belong to the object; PointAttraction.h
  /**
   * Of the edges of LevelImage::Edges, which stop the surface where this is more than
   * IsopotentialWeight; see EdgeAttraction.h.
   */
  double EdgeAttractionWeight = 0.;
  double Friction = 3.; ///< Per unit of time, see Dynamics.h for strong forces.

  bool TopologyChanges = true; ///< Off: contacts only stop the surface.

  int MaximumNumberOfIterations = 1000; ///< Per level.
  /**
   * A level rests when the enclosed volume changes by less than max(delta^3, this share of it)
   * over the last 10 and over the last 20 iterations. See CycleCriterion for one that never does.
   */
  double ConvergenceTolerance = 5e-4;
  bool FreezeMotionlessVertices = true; ///< Skip vertices at rest until something near changes.
  /**
   * Vertices onto the isopotential at the end of a level; where EdgeAttractionWeight is not 0, and
   * the surface may rest at edges that are not at the iso-value, onto the edges near them instead.
   */
  bool SnapToIsoValue = true;

  /**
   * After a division, parts of the object that the coarser level did not resolve, and that the
   * surface therefore has lost, are enclosed again (Documentation/differences.md).
   */
  bool RecoverMissedParts = true;
  bool RecoverCavities = false; ///< The same for background that the object encloses.
  int MinimumPartSize = 20;     ///< Voxels of the level that a lost part must have to be recovered.

  double MaximumStep = 0.5; ///< Largest displacement of an iteration, in delta; at most 0.5.
  /**
   * Side of the blocks that are visited, in delta; 0 = SurfaceBlocks::SideInDelta, the least that
   * may be visited at the same time. No property: tests make others.
   */
  double BlockSide = 0.;

  /** Return what drives the surface. The only place that derives it from the weights. */
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
