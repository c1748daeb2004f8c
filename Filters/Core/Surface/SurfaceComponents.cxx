// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceComponents.h"

#include "Core/Common/Box.h"
#include "Core/Surface/ComponentNesting.h"
#include "Core/Surface/ComponentWatch.h"

namespace volumic
{
void SurfaceComponents::Label(SurfaceState& state, Executor& executor)
{
  this->Connected.Label(state.Mesh, state.Component.AsVector(), executor);
  this->Components = static_cast<int>(this->Connected.Roots().size());
}

bool SurfaceComponents::DeleteDegenerate(SurfaceState& state, Executor& executor)
{
  constexpr float far = 1e9f;
  ComponentWatch watch;
  watch.LabelSmall(
    state, 0, state.Mesh.Size(), { Vector(-far, -far, -far), Vector(far, far, far) });
  const bool deleted = watch.DeleteDegenerate(state);
  this->Label(state, executor); // It gives labels of its own.
  return deleted;
}

bool SurfaceComponents::DeleteInsideOut(SurfaceState& state, Executor& executor)
{
  this->Label(state, executor);
  const std::vector<int> insideOut = FindInsideOut(
    state.Mesh, state.Component.AsVector(), this->Connected.Roots(), executor);
  for (const int root : insideOut)
  {
    state.RemoveComponent(root);
  }
  if (!insideOut.empty())
  {
    this->Label(state, executor);
  }
  return !insideOut.empty();
}
}
