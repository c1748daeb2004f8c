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
  const bool hasDeleted = watch.DeleteDegenerate(state);
  this->Label(state, executor); // The watch has labels of its own.
  return hasDeleted;
}

std::vector<int> SurfaceComponents::FindInsideOut(
  const SurfaceState& state, Executor& executor) const
{
  const LargeVector<int>& labels = state.Component.AsVector();
  const std::vector<int>& roots = this->Connected.Roots();
  std::vector<Vector> places;
  for (const int root : roots)
  {
    places.push_back(state.Mesh.Position[root]);
  }
  const std::vector<ComponentRay> rays =
    CastRays(roots, places, VolumesOfFaces(state.Mesh, labels, places, executor));
  return JudgeFromOutsideIn(rays, FindCrossings(state.Mesh, labels, rays, executor));
}

bool SurfaceComponents::DeleteInsideOut(SurfaceState& state, Executor& executor)
{
  this->Label(state, executor);
  const std::vector<int> insideOut = this->FindInsideOut(state, executor);
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
