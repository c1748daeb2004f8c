// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/RemainingContacts.h"

#include "Core/Common/Spans.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace volumic
{
namespace
{
/** Relative tolerance of the distance bound. */
constexpr double Rounding = 1e-6;
/** Distance, in lambda delta, within which another part of the surface may constrain a vertex. */
constexpr float ContactRadius = 1.15f;
/** Distance to the isosurface, in delta, from which on a vertex is constrained. */
constexpr float FarFromIso = 0.1f;

/** Return lambda delta less the tolerance. */
double BoundOf(const SizingField& sizing, int v)
{
  return static_cast<double>(SizingField::LambdaInDelta) * sizing.At(v) * (1. - Rounding);
}
}

RemainingContacts FindRemainingContacts(
  const SurfaceState& state, const Field& field, Executor& executor)
{
  const SurfaceMesh& mesh = state.Mesh;
  constexpr std::size_t size = 2048;
  const std::size_t n = mesh.Rings.size();
  std::vector<std::vector<std::array<int, 2>>> spans((n + size - 1) / size);
  RemainingContacts contacts;
  MakeZeroed(contacts.Held, n); // Free slots take no memory.
  ForSpans(executor, n, size,
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
        const double bound = BoundOf(state.Sizing, v);
        const float radius = state.Sizing.LargestClearance(v, ContactRadius);
        bool hasOther = false;
        state.Grid.Visit(mesh.Position[v], radius,
          [&](int w)
          {
            const VectorD across = VectorD(mesh.Position[w]) - p;
            const double squared = Dot(across, across);
            const bool isForbidden = squared < bound * bound;
            // Only vertices that face it constrain a vertex.
            const bool mayConstrain = !hasOther && squared < static_cast<double>(radius) * radius &&
              Dot(state.Normal[v].Axis(), state.Normal[w].Axis()) < 0;
            if (w != v && ((isForbidden && w > v) || mayConstrain) && mesh.AreFarApart(v, w))
            {
              hasOther = hasOther || mayConstrain;
              if (isForbidden && w > v)
              {
                spans[b].push_back({ v, w });
              }
            }
          });
        if (hasOther)
        {
          const Field::Sample sample = field.At(mesh.Position[v]);
          contacts.Held[i] =
            std::abs(sample.Value) > FarFromIso * state.Sizing.At(v) * field.SlopeOf(sample);
        }
      }
      std::sort(spans[b].begin(), spans[b].end());
    });
  Concatenate(executor, spans, contacts.Pairs); // Sorted, as the spans are.
  return contacts;
}
}
