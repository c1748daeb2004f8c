// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicDynamics_h
#define volumicDynamics_h

#include "Core/Evolution/SurfaceOptions.h"
#include "Core/Image/EdgeAttraction.h"
#include "Core/Image/Field.h"
#include "Core/Surface/Proximity.h"
#include "Core/Surface/SurfaceState.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace volumic
{
/**
 * Motion of vertices in an iteration: forces, time step, Newton's law with friction, contact,
 * displacement and freezing. Thread-safe: methods write to the given state and step only.
 *
 * Forces, in delta per unit of time squared (mass 1):
 * - tension F_c: TensionWeight times the vector to the barycentre of the neighbours, minus the
 *   reaction on them. The sum of the forces is zero, so closed surfaces do not shrink.
 * - elasticity F_e: springs along the edges with rest length 1.6 delta.
 * - isopotential F_i: along the normal, Value / (|gradient| 0.75 delta), clamped to 1. The gradient
 *   has a lower bound (Field::SlopeOf), which limits the stiffness on plateaus.
 * - gradient F_di: descent of the image along the normal, -(gradient . n) / (0.5 TypicalSlope),
 *   clamped to 1. For segmentation by edges, use an image with valleys at the edges (such as the
 *   negative gradient magnitude), GradientWeight 1, and a small IsopotentialWeight for flat
 * regions.
 * - edges: EdgeAttractionWeight times EdgeAttraction::Along(), if there is an edge map.
 *
 * Friction is Options.Friction per unit of time, times sqrt(s) if the weights s of the external
 * forces (the last three) exceed 1 in sum. A common factor of all forces only scales the time. For
 * large tension and elasticity the time step is reduced, at most to a quarter. Beyond that, both
 * forces are reduced to the stability limit.
 *
 * Beyond the margin of the image, an inward force of the same weights replaces gradient and edges.
 * No displacement leads further out than ImageMargin allows.
 */
class Dynamics
{
public:
  /** Close pairs of a vertex, and the correction of its velocity. */
  struct ContactsOfVertex
  {
    int Vertex;
    std::size_t Begin; ///< of its pairs
    std::size_t End;
    Vector Correction;
  };
  /** Time step of some vertices. */
  struct Step
  {
    float Time = 0;
    std::vector<Vector> Force;              ///< in the order of the vertices
    std::vector<ContactsOfVertex> Contacts; ///< of vertices with pairs
  };

  Dynamics(const Field& field, const SurfaceOptions& options, Executor& executor);

  /**
   * Freeze vertices within LeftOff of the isosurface, and leave the rest of their motion to the
   * regularisation. For ungraded levels whose field the surface has descended.
   */
  void LeaveToRegularisation() { this->Leaves = true; }

  /**
   * Compute forces and velocities of the active vertices. `pairs` are the contacts of the last
   * proximity test.
   */
  void Accelerate(SurfaceState& state, const std::vector<int>& active,
    const std::vector<Proximity::ClosePair>& pairs, Step& step, Executor& executor) const;

  /** Options of Relax(). */
  struct Relaxation
  {
    float Longest;   ///< largest displacement, in delta
    float Smoothing; ///< fraction of the tangential vector to the barycentre of the neighbours
    bool Snap;       ///< Move onto the isosurface, or the ridge of the edge map, too.
    bool LeavesThin; ///< Keep vertices near another part of the surface.
  };
  static constexpr Relaxation Descending = { 0.5f, 0.5f, true, true };
  static constexpr Relaxation Regularising = { 0.15f, 0.7f, true, false };
  static constexpr Relaxation Adapting = { 0.15f, 0.7f, false, false };

  /**
   * Instead of Accelerate(): compute velocities that smooth the mesh tangentially and, on request,
   * lead onto the target SurfaceDrive::SnapsTo: the isosurface (Newton step along the normal) or
   * the ridge of the edge map, but never towards a contact.
   */
  void Relax(SurfaceState& state, const std::vector<int>& vertices,
    const std::vector<Proximity::ClosePair>& pairs, const Relaxation& relaxation, Step& step,
    Executor& executor) const;

  /** Displace vertices. Old positions are kept in SurfaceState::PreviousPosition. */
  void Displace(SurfaceState& state, const std::vector<int>& active, const Step& step) const;

  /** See LeaveToRegularisation(), in delta. */
  static constexpr float LeftOff = 0.5f;
  /**
   * After the rollback: freeze converged vertices, and activate the neighbours of moved ones,
   * except those left to the regularisation. `working` has the active vertices and their
   * neighbours.
   */
  void Freeze(
    SurfaceState& state, const std::vector<int>& active, const std::vector<int>& working) const;

private:
  void SetPace();
  Vector ForceAt(const SurfaceState& state, int v, float& value) const;
  /** Return the displacement of a vertex in Relax(). */
  Vector RelaxationOf(const SurfaceState& state, int v, const Relaxation& relaxation) const;
  /**
   * Return whether two vertices with a common neighbour lie across a hole or a waist that the image
   * closes. A contact between them would prevent the 3-cycle that a cut requires.
   */
  bool MayClose(const SurfaceState& state, int v, int w) const;
  /** Remove the components of velocities that would violate eq. (1). */
  void ApplyContacts(SurfaceState& state, const std::vector<int>& moving,
    const std::vector<Proximity::ClosePair>& pairs, Step& step) const;
  Vector CorrectionOf(const SurfaceState& state, const std::vector<Proximity::ClosePair>& pairs,
    const ContactsOfVertex& contacts, bool separates, float time) const;

  const Field& TheField;
  const SurfaceOptions& Options;
  const SurfaceDrive::Goal SnapsTo;
  std::unique_ptr<EdgeAttraction> Edges; ///< null: no edge map
  bool Leaves = false;                   ///< see LeaveToRegularisation()
  float Drag = 0;                        ///< effective friction
  float Longest = 0;                     ///< longest time step
  float InnerShare = 1; ///< fraction of the internal forces within the stability limit
};
}

#endif
