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
 * Forces, time step, Newton's law with friction, contact, displacement and freezing: everything
 * of an iteration that moves vertices. It only reads, but for the state and the step that a visit
 * hands in, so visits share it.
 *
 * Forces, in delta per unit of time squared (mass 1):
 * - tension F_c: TensionWeight times the pull to the barycentre of the neighbours, less its
 *   reaction on them. The reaction keeps the sum of the forces zero, so closed surfaces do not
 *   shrink (a pure barycentre pull does).
 * - elasticity F_e: springs along the edges with rest length 1.6 delta.
 * - isopotential F_i: along the normal, Value / (|gradient| 0.75 delta), clamped to 1; the
 *   gradient has a floor, so that plateaus do not make the force arbitrarily stiff.
 * - gradient F_di: the image is taken as a potential and the vertex descends it along its normal:
 *   - (gradient of the image . n) / (0.5 TypicalSlope), clamped to 1. To segment by edges instead
 *   of by value, give an image with valleys where the contours are (such as minus the gradient
 *   magnitude), GradientWeight 1, and a small IsopotentialWeight whose iso-value drives the
 *   surface over the flat parts.
 * - edges: EdgeAttractionWeight times EdgeAttraction::Along, if the image of the field has a map
 *   of edges.
 *
 * Friction is Options.Friction per unit of time; where the weights of the outer forces (the last
 * three) add up to s > 1 it is times sqrt(s), so that strong forces swing no more than weak ones: a
 * common factor of all is another unit of time. Tension and elasticity that the time step cannot
 * follow would swing themselves up: the step is shortened down to a quarter, then the two are
 * weakened to what it can follow.
 *
 * Beyond the margin of the image gradient and edges give way to a pull back, against the normal, of
 * their weights; no displacement leads further out than ImageMargin allows.
 */
class Dynamics
{
public:
  /** The close pairs of a vertex, and what of its velocity they forbid. */
  struct ContactsOfVertex
  {
    int Vertex;
    std::size_t Begin; ///< Of the pairs.
    std::size_t End;
    Vector Correction;
  };
  /** A step in time of some vertices. */
  struct Step
  {
    float Time = 0;
    std::vector<Vector> Force;              ///< In the order of the vertices.
    std::vector<ContactsOfVertex> Contacts; ///< Of those that have any.
  };

  /** @param executor for what it finds out about the map of edges */
  Dynamics(const Field& field, const SurfaceOptions& options, Executor& executor);

  /**
   * From now on the way of the last LeftOff is left to the regularisation, whose passes lead there at
   * once: for a level whose field the surface has descended, and that is not graded.
   */
  void LeaveToRegularisation() { this->Leaves = true; }

  /**
   * Computes forces and velocities of the active vertices; `pairs` are the contacts known from the
   * last examination.
   */
  void Accelerate(SurfaceState& state, const std::vector<int>& active,
    const std::vector<Proximity::ClosePair>& pairs, Step& step, Executor& executor) const;

  /** Ways in a pass of Relax. */
  struct Relaxation
  {
    float Longest;   ///< Of a vertex, in delta.
    float Smoothing; ///< Share of the way to the barycentre of the neighbours, along the surface.
    bool Snap;       ///< Also onto the isopotential, or up to the ridge of the map of edges.
    bool LeavesThin; ///< What is near another part of the surface stays where it is.
  };
  static constexpr Relaxation Descending = { 0.5f, 0.5f, true, true };
  static constexpr Relaxation Regularising = { 0.15f, 0.7f, true, false };
  static constexpr Relaxation Adapting = { 0.15f, 0.7f, false, false };

  /**
   * Instead of Accelerate: velocities that even the mesh out tangentially and, on request, lead onto
   * the isopotential (Newton's step along the normal), or, by SurfaceDrive::SnapsTo, up to
   * the ridge of the map of edges, never towards a contact.
   */
  void Relax(SurfaceState& state, const std::vector<int>& vertices,
    const std::vector<Proximity::ClosePair>& pairs, const Relaxation& relaxation, Step& step,
    Executor& executor) const;

  /** Displaces them; the place before is kept in SurfaceState::PreviousPosition. */
  void Displace(SurfaceState& state, const std::vector<int>& active, const Step& step) const;

  /** How far off the isopotential, in delta, a vertex may be that is left to the regularisation. */
  static constexpr float LeftOff = 0.5f;
  /**
   * After roll back: vertices at rest become motionless, the neighbours of moved ones active, but
   * for those that are left to the regularisation.
   * `working` holds the active vertices and all their neighbours.
   */
  void Freeze(
    SurfaceState& state, const std::vector<int>& active, const std::vector<int>& working) const;

private:
  void SetPace();
  Vector ForceAt(const SurfaceState& state, int v, float& value) const;
  /** The way of a vertex in a pass of Relax. */
  Vector RelaxationOf(const SurfaceState& state, int v, const Relaxation& relaxation) const;
  /**
   * Whether two vertices with a common neighbour lie across a hole, or a waist, that the image
   * wants closed: contact between them would keep it open for ever, short of the 3-cycle that a
   * cut needs.
   */
  bool MayClose(const SurfaceState& state, int v, int w) const;
  /** Takes from the velocities what would bring vertices nearer than eq. (1) allows. */
  void ApplyContacts(SurfaceState& state, const std::vector<int>& moving,
    const std::vector<Proximity::ClosePair>& pairs, Step& step) const;
  Vector CorrectionOf(const SurfaceState& state, const std::vector<Proximity::ClosePair>& pairs,
    const ContactsOfVertex& contacts, bool separates, float time) const;

  const Field& TheField;
  const SurfaceOptions& Options;
  const SurfaceDrive::Goal SnapsTo;
  std::unique_ptr<EdgeAttraction> Edges; ///< Null where there is none.
  bool Leaves = false;  ///< See LeaveToRegularisation.
  float Drag = 0;       ///< Friction as it acts.
  float Longest = 0;    ///< Time step, unless shortened.
  float InnerShare = 1; ///< Of the internal forces that the time step can follow.
};
}

#endif
