// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceOptions_h
#define volumicSurfaceOptions_h

#include "Core/Image/FieldOptions.h"

#include <cstdint>

namespace volumic
{
/**
 * All properties of the deformable surface, with their only defaults.
 * Weights are relative to a mass of 1 per vertex; forces are measured in delta, so that one set
 * of weights serves every level.
 */
struct SurfaceOptions : FieldOptions
{
  double SeedRadius = 0.;      ///< Radius of seeds, workspace; 0 = 1.2 delta.
  double SamplingRatio = 0.85; ///< delta_h / U_h, in [sqrt(3)/2.5, 1] (eq. 7).

  double TensionWeight = 0.2;      ///< F_c, towards the barycentre of the neighbours.
  double ElasticityWeight = 0.1;   ///< F_e, springs along edges, rest length 1.6 delta.
  double IsopotentialWeight = 1.;  ///< F_i, along the normal, bounded by 1.
  double GradientWeight = 0.;      ///< F_di, descent along the discrete gradient; see Dynamics.h.
  double PointAttractionWeight = 1.; ///< Of points known to belong to the object; PointAttraction.h
  /**
   * Of the edges of LevelImage::Edges, which stop the surface where this is more than
   * IsopotentialWeight; see EdgeAttraction.h.
   */
  double EdgeAttractionWeight = 0.;
  double Friction = 3.;            ///< Per unit of time, see Dynamics.h for strong forces.

  bool TopologyChanges = true;     ///< Off: contacts only stop the surface.

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
  bool SnapsToEdges() const { return this->SnapToIsoValue && this->EdgeAttractionWeight > 0.; }
  bool SnapsToIsoValue() const { return this->SnapToIsoValue && !this->SnapsToEdges(); }

  /**
   * After a division, parts of the object that the coarser level did not resolve, and that the
   * surface therefore has lost, are enclosed again (Documentation/differences.md).
   */
  bool RecoverLostParts = true;
  bool RecoverCavities = false; ///< The same for background that the object encloses.
  int MinimumPartSize = 20; ///< Voxels of the level that a lost part must have to be recovered.

  double MaximumStep = 0.5; ///< Largest displacement of an iteration, in delta; at most 0.5.
  /**
   * Side of the blocks that are visited, in delta; 0 = SurfaceBlocks::SideInDelta, the least that
   * may be visited at the same time. No property: tests make others.
   */
  double BlockSide = 0.;

  /** Whether no other force stops the surface: the object is what the values of voxels tell. */
  bool IsDrivenByFieldAlone() const
  {
    return this->IsopotentialWeight > 0. && !(this->GradientWeight > 0.) &&
      !(this->EdgeAttractionWeight > 0.);
  }
  /** Whether, so, where it is to lie is known before a level begins. */
  bool FollowsFieldAlone() const
  {
    return this->IsDrivenByFieldAlone() && this->SnapToIsoValue && this->FreezeMotionlessVertices;
  }
};
}

#endif
