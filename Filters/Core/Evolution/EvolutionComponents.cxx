// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The components of the surface, between sweeps.

#include "Core/Evolution/EvolutionImplementation.h"

namespace volumic
{
void SurfaceEvolution::Implementation::LabelComponents()
{
  this->Components->Label(this->State, this->Threads);
  this->NumberOfComponents = this->Components->NumberOfComponents();
}

void SurfaceEvolution::Implementation::DeleteDegenerate()
{
  this->Components->DeleteDegenerate(this->State, this->Threads);
  this->NumberOfComponents = this->Components->NumberOfComponents();
}

void SurfaceEvolution::Implementation::DeleteThoseInsideOut()
{
  this->Components->DeleteInsideOut(this->State, this->Threads);
  this->NumberOfComponents = this->Components->NumberOfComponents();
  this->Unchecked = 0;
}
}
