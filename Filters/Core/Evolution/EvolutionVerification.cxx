// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The last look at what a level, or a run that was stopped, hands on: see SurfaceIteration for why
// it finds nothing.

#include "Core/Evolution/EvolutionImplementation.h"
#include "Core/Surface/NewFaces.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace volumic
{
std::string SurfaceEvolution::Verdict::Describe(int level) const
{
  return "The surface of level " + std::to_string(level) + " intersected itself at " +
    std::to_string(this->Found) +
    (this->Left > 0 ? " vertices, and does so still: it could not be mended."
                    : " vertices; it has got another mesh, whose triangles are less even.") +
    " This is an error of Volumic: please report it, with the volume.";
}

int SurfaceEvolution::Implementation::CountIntersecting()
{
  return static_cast<int>(volumic::CountIntersecting(this->State, this->Threads));
}

void SurfaceEvolution::Implementation::Verify()
{
  this->LastVerdict.Found = this->CountIntersecting();
  this->LastVerdict.Left = 0;
  if (this->LastVerdict.Found == 0)
  {
    return;
  }
  this->ForgetBlocks();
  const SurfaceMesh before = this->State.Mesh;
  this->State.Sizing = SizingField(this->State.Sizing.OfLevel()); // The mesh to come is even.
  const bool wasStopped = std::exchange(this->Stopped, false);
  this->IsMending = true;
  try
  {
    this->TakeRemeshed(before.ToIndexed(this->Threads));
  }
  catch (const std::invalid_argument&)
  {
    this->State.Mesh = before;
    this->LayGrid();
    this->MakeBlocks();
    this->LastVerdict.Left = this->LastVerdict.Found;
  }
  this->IsMending = false;
  this->Stopped = wasStopped;
}
}
