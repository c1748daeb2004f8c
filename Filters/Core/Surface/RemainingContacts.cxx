// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/RemainingContacts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace volumic
{
namespace
{
/** Distances a rounding under the bound don't count. */
constexpr double Rounding = 1e-6;
/** Distance, in lambda delta, within which another part of the surface may hold a vertex. */
constexpr float HoldingReach = 1.15f;
/** Distance to the isopotential, in delta, that counts as held. */
constexpr float FarFromIso = 0.1f;
/** Floor of the gradient, in TypicalSlope. */
constexpr float GradientFloor = 0.15f;
}

RemainingContacts FindRemainingContacts(
  const SurfaceState& state, const Field& field, Executor& executor)
{
  const SurfaceMesh& mesh = state.Mesh;
  const double bound =
    static_cast<double>(constraint::NearestOthers) * state.Delta * (1. - Rounding);
  const float reach = HoldingReach * constraint::NearestOthers * state.Delta;
  const float floor = GradientFloor * field.TypicalSlope();
  constexpr std::size_t size = 2048;
  const std::size_t n = mesh.Rings.size();
  std::vector<std::vector<std::array<int, 2>>> blocks((n + size - 1) / size);
  RemainingContacts contacts;
  contacts.Held = std::vector<std::uint8_t>(n);
  ForBlocks(executor, n, size,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const int v = static_cast<int>(i);
        if (!mesh.IsAlive(v))
        {
          continue;
        }
        const VectorD p(mesh.Position[v]);
        bool hasOther = false;
        state.Grid.Visit(mesh.Position[v], reach,
          [&](int w)
          {
            const VectorD across = VectorD(mesh.Position[w]) - p;
            const double squared = Dot(across, across);
            const bool isForbidden = squared < bound * bound;
            // What holds a vertex faces it.
            const bool mayHold = !hasOther && squared < static_cast<double>(reach) * reach &&
              Dot(state.Normal[v], state.Normal[w]) < 0;
            if (w != v && ((isForbidden && w > v) || mayHold) &&
              mesh.AreFarApart(v, w))
            {
              hasOther = hasOther || mayHold;
              if (isForbidden && w > v)
              {
                blocks[b].push_back({ v, w });
              }
            }
          });
        if (hasOther)
        {
          const Field::Sample sample = field.At(mesh.Position[v]);
          const float slope = std::max(Length(sample.Gradient), floor);
          contacts.Held[i] = std::abs(sample.Value) > FarFromIso * state.Delta * slope;
        }
      }
    });
  for (const auto& block : blocks)
  {
    contacts.Pairs.insert(contacts.Pairs.end(), block.begin(), block.end());
  }
  std::sort(contacts.Pairs.begin(), contacts.Pairs.end());
  return contacts;
}
}
