// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicDynamicsTestTools_h
#define volumicDynamicsTestTools_h

#include "Core/Common/Executor.h"
#include "Core/Evolution/Dynamics.h"
#include "Core/Surface/Proximity.h"
#include "LiveSurface.h"

namespace volumic
{
/** A surface and an image for tests of forces. */
struct Stage
{
  TestVolume Volume;
  SurfaceOptions Options;
  LiveSurface State;
  std::vector<int> All;
  Executor Threads;

  /** Surface in an empty image, all forces disabled. */
  Stage(const IndexedSurface& surface, float delta)
    : Volume(MakeVolume(33, [](double, double, double) { return 0.; })), State(surface, delta),
      All(this->State.All())
  {
    this->Options.IsopotentialWeight = 0;
    this->Options.TensionWeight = 0;
    this->Options.ElasticityWeight = 0;
  }

  /** Ball of radius 8 and concentric sphere at (16, 16, 16), default forces. */
  explicit Stage(double radius, float delta = 1)
    : Stage(DividedIcosahedron({ 16, 16, 16 }, radius, 1.6 * delta), delta)
  {
    this->Volume = MakeVolume(
      33, [](double x, double y, double z) { return 8.5 - Distance(x, y, z, 16, 16, 16); });
    this->Options = SurfaceOptions();
    this->Options.IsoValue = 0.5;
  }

  void UpdateShape() { this->State.UpdateShape(); }

  /** Apply velocities and displacements of one iteration. @return time step */
  double Push(const std::vector<Proximity::ClosePair>& pairs = {})
  {
    const Field field(this->Volume.Image, this->Options, this->Threads);
    const Dynamics dynamics(field, this->Options, this->Threads);
    Dynamics::Step step;
    dynamics.Accelerate(this->State, this->All, pairs, step, OnThisThread());
    dynamics.Displace(this->State, this->All, step);
    return step.Time;
  }

  /** Compute the velocities of a smoothing pass. */
  void Relax(bool snap, const std::vector<Proximity::ClosePair>& pairs = {})
  {
    const Field field(this->Volume.Image, this->Options, this->Threads);
    const Dynamics dynamics(field, this->Options, this->Threads);
    Dynamics::Step step;
    dynamics.Relax(this->State, this->All, pairs,
      snap ? Dynamics::Regularising : Dynamics::Adapting, step, OnThisThread());
  }

  Vector OutwardAt(int v) const
  {
    return Normalized(this->State.Mesh.Position[v] - Vector(16, 16, 16));
  }

  /** Return the mean radial speed. */
  double MeanSpeedOutward() const
  {
    double sum = 0;
    for (int v : this->All)
    {
      sum += Dot(this->State.Velocity[v], this->OutwardAt(v));
    }
    return sum / static_cast<double>(this->All.size());
  }
};
}

#endif
