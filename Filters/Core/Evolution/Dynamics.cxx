// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/Dynamics.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace volumic
{
namespace
{
/** Distance to the isosurface, in delta, at which the isopotential force reaches its bound. */
constexpr float ForceRange = 0.75f;
/** Motion along the normal from the anchor that counts as visible, in delta. */
constexpr float VisibleAlongNormal = 0.03f;
/** The same, if the rest is left to the regularisation. */
constexpr float VisibleIfLeft = 0.08f;
/** The same in any direction. Tangential motion has no effect until the end of a level. */
constexpr float Visible = 0.3f;
/** If the rest is left to the regularisation, vertices this near to the isosurface, in delta,
 * converge at once, except those with close pairs, which contacts keep away. */
constexpr float ConvergedWithin = 0.25f;
/** Iterations without visible motion until a vertex has converged. */
constexpr int IterationsToConverge = 3;

/** Gradient of the image, relative to TypicalSlope(), at which the gradient force reaches its
 * bound. */
constexpr float FullGradient = 0.5f;
/** Gauss-Seidel passes over the contacts. */
constexpr int ContactSweeps = 3;
/** Fraction of the missing distance to delta that two vertices in contact recover per step. */
constexpr float ContactRecovery = 0.25f;

/** Largest stiffness of tension per unit of weight, that of a zigzag. */
constexpr float TensionStiffness = 4.f;
constexpr float ElasticityStiffness = 12.f;
/** Minimum number of vertices per thread. */
constexpr std::size_t VertexGrain = 128;
/** Largest reduction of the time step for internal forces. */
constexpr float Shortening = 4.f;

float Clamp(float x)
{
  return std::min(std::max(x, -1.f), 1.f);
}
}

Dynamics::Dynamics(const Field& field, const SurfaceOptions& options, Executor& executor)
  : TheField(field), Options(options), SnapsTo(options.Drive().SnapsTo)
{
  if (options.EdgeAttractionWeight > 0 && field.Image().Edges)
  {
    this->Edges = std::make_unique<EdgeAttraction>(field.Image(), executor);
  }
  this->SetPace();
}

void Dynamics::SetPace()
{
  const float drive = static_cast<float>(this->Options.IsopotentialWeight +
    this->Options.GradientWeight + (this->Edges ? this->Options.EdgeAttractionWeight : 0.));
  // Friction scales with the forces as in another unit of time, so strong forces oscillate no more.
  this->Drag = static_cast<float>(this->Options.Friction) * std::sqrt(std::max(drive, 1.f));
  // A free vertex at its terminal speed under the full force moves by the largest step.
  this->Longest =
    static_cast<float>(this->Options.MaximumStep) * this->Drag / std::max(drive, 0.5f);
  // A spring of stiffness k is unstable if k step^2 exceeds 4 + 2 friction step.
  const float outer = drive / ForceRange;
  const float inner = TensionStiffness * static_cast<float>(this->Options.TensionWeight) +
    ElasticityStiffness * static_cast<float>(this->Options.ElasticityWeight);
  const float stiffness = outer + inner;
  const float stable =
    (this->Drag + std::sqrt(this->Drag * this->Drag + 4 * stiffness)) / std::max(stiffness, 1e-6f);
  this->Longest = std::min(this->Longest, std::max(stable, this->Longest / Shortening));
  const float most = (4 + 2 * this->Drag * this->Longest) / (this->Longest * this->Longest) - outer;
  this->InnerShare = inner > 0 && inner > most ? std::max(most, 0.f) / inner : 1.f;
}

Vector Dynamics::ForceAt(const SurfaceState& state, int v, float& value) const
{
  const Vector n = state.Normal[v].Axis();
  const float delta = state.Sizing.At(v);
  const Field::Sample sample = this->TheField.At(state.Mesh.Position[v]);
  value = sample.Value;
  float along = static_cast<float>(this->Options.IsopotentialWeight) *
    Clamp(sample.Value / (this->TheField.SlopeOf(sample) * ForceRange * delta));
  float beside = 0;
  float most = 0;
  if (this->Options.GradientWeight > 0)
  {
    // The potential is the image, whose sign differs from that of Value for dark objects.
    const float sign = this->Options.ObjectIsBright ? 1.f : -1.f;
    const float weight = static_cast<float>(this->Options.GradientWeight);
    beside -= weight *
      Clamp(sign * Dot(sample.Gradient, n) / (FullGradient * this->TheField.TypicalSlope()));
    most += weight;
  }
  if (this->Edges)
  {
    const float weight = static_cast<float>(this->Options.EdgeAttractionWeight);
    beside += weight * this->Edges->Along(state.Mesh.Position[v], n);
    most += weight;
  }
  if (most > 0)
  {
    // Beyond the margin of the image, an inward force of the same strength replaces them.
    const float share = this->TheField.Margin().DepthAt(state.Mesh.Position[v]).Fraction;
    along += beside - share * (beside + most);
  }
  const Ring& ring = state.Mesh.Rings[v];
  Vector tension = state.Laplacian[v];
  for (int i = 0; i < ring.Count; ++i)
  {
    const Vector& pull = state.Laplacian[ring.Item[i]];
    tension -= pull * pull.Padding;
  }
  const float inverse = 1.f / delta;
  Vector force = n * along +
    tension * (this->InnerShare * static_cast<float>(this->Options.TensionWeight) * inverse) +
    state.SpringPull[v] *
      (this->InnerShare * static_cast<float>(this->Options.ElasticityWeight) * inverse);
  force.Padding = 0;
  return force;
}

void Dynamics::Accelerate(SurfaceState& state, const std::vector<int>& active,
  const std::vector<Proximity::ClosePair>& pairs, Step& step, Executor& executor) const
{
  const float friction = this->Drag;
  const float longest = this->Longest;
  step.Force.resize(active.size());
  executor.For(active.size(), VertexGrain,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const int v = active[i];
        step.Force[i] = this->ForceAt(state, v, state.FieldValue[v]) * state.Sizing.At(v);
      }
    });
  float fastest = 0;
  for (std::size_t i = 0; i < active.size(); ++i)
  {
    const Vector speed =
      (state.Velocity[active[i]] + step.Force[i] * longest) * (1 / (1 + friction * longest));
    fastest = std::max(fastest, SquaredLength(speed));
  }
  fastest = std::sqrt(fastest);
  const float largest = static_cast<float>(this->Options.MaximumStep) * state.Sizing.Smallest();
  step.Time = fastest * longest > largest ? largest / fastest : longest;
  for (std::size_t i = 0; i < active.size(); ++i)
  {
    Vector& velocity = state.Velocity[active[i]];
    velocity = (velocity + step.Force[i] * step.Time) * (1 / (1 + friction * step.Time));
  }
  this->ApplyContacts(state, active, pairs, step);
}

void Dynamics::Relax(SurfaceState& state, const std::vector<int>& vertices,
  const std::vector<Proximity::ClosePair>& pairs, const Relaxation& relaxation, Step& step,
  Executor& executor) const
{
  step.Time = 1;
  executor.For(vertices.size(), VertexGrain,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        state.Velocity[vertices[i]] = this->RelaxationOf(state, vertices[i], relaxation);
      }
    });
  // Contacts: distances must not decrease.
  this->ApplyContacts(state, vertices, pairs, step);
}

Vector Dynamics::RelaxationOf(const SurfaceState& state, int v, const Relaxation& relaxation) const
{
  if (relaxation.LeavesThin && state.NearOthers[v])
  {
    return Vector();
  }
  const float longest = relaxation.Longest * state.Sizing.At(v);
  const Vector n = state.Normal[v].Axis();
  Vector pull = state.Laplacian[v];
  pull.Padding = 0;
  Vector move = (pull - n * Dot(pull, n)) * relaxation.Smoothing;
  if (relaxation.Snap && this->SnapsTo == SurfaceDrive::Goal::IsoValue)
  {
    const Field::Sample sample = this->TheField.At(state.Mesh.Position[v]);
    move += n * this->TheField.StepToIso(sample, n, longest);
  }
  if (this->Edges && this->SnapsTo == SurfaceDrive::Goal::Edges)
  {
    const float share = this->TheField.Margin().DepthAt(state.Mesh.Position[v]).Fraction;
    move += n * ((1 - share) * longest * this->Edges->Along(state.Mesh.Position[v], n));
  }
  const float length = Length(move);
  return length > longest ? move * (longest / length) : move;
}

bool Dynamics::MayClose(const SurfaceState& state, int v, int w) const
{
  const Ring& ring = state.Mesh.Rings[v];
  bool common = false;
  for (int i = 0; i < ring.Count && !common; ++i)
  {
    common = state.Mesh.AreNeighbours(ring.Item[i], w);
  }
  if (!common)
  {
    return false;
  }
  const Vector across = state.Mesh.Position[w] - state.Mesh.Position[v];
  const bool front = Dot(state.Normal[v].Axis() - state.Normal[w].Axis(), across) > 0;
  const float value =
    this->TheField.ValueAt((state.Mesh.Position[v] + state.Mesh.Position[w]) * 0.5f);
  return front ? value > 0 : value < 0;
}

void Dynamics::ApplyContacts(SurfaceState& state, const std::vector<int>& moving,
  const std::vector<Proximity::ClosePair>& pairs, Step& step) const
{
  if (pairs.empty())
  {
    return;
  }
  for (const int v : moving)
  {
    state.Marks[v] |= IsMoving;
  }
  // The pairs of a vertex are contiguous.
  step.Contacts.clear();
  for (std::size_t from = 0; from < pairs.size();)
  {
    const int v = pairs[from].V;
    std::size_t to = from + 1;
    while (to < pairs.size() && pairs[to].V == v)
    {
      ++to;
    }
    if (state.Mesh.IsAlive(v) && (state.Marks[v] & IsMoving))
    {
      step.Contacts.push_back({ v, from, to, Vector() });
    }
    from = to;
  }
  for (int sweep = 0; sweep < ContactSweeps; ++sweep)
  {
    for (ContactsOfVertex& contacts : step.Contacts)
    {
      contacts.Correction = this->CorrectionOf(state, pairs, contacts, sweep == 0, step.Time);
    }
    for (const ContactsOfVertex& contacts : step.Contacts)
    {
      state.Velocity[contacts.Vertex] -= contacts.Correction;
    }
  }
  for (const int v : moving)
  {
    state.Marks[v] &= static_cast<std::uint8_t>(~IsMoving);
  }
}

Vector Dynamics::CorrectionOf(const SurfaceState& state,
  const std::vector<Proximity::ClosePair>& pairs, const ContactsOfVertex& contacts, bool separates,
  float time) const
{
  const int v = contacts.Vertex;
  Vector sum;
  int count = 0;
  for (std::size_t i = contacts.Begin; i < contacts.End; ++i)
  {
    const int w = pairs[i].W;
    if (!state.Mesh.IsAlive(w) || state.Mesh.AreNeighbours(v, w) || this->MayClose(state, v, w))
    {
      continue;
    }
    const Vector across = state.Mesh.Position[w] - state.Mesh.Position[v];
    const float distance = Length(across);
    if (distance > state.Sizing.Clearance(v, w) || distance <= 0)
    {
      continue;
    }
    const Vector direction = across * (1 / distance);
    float approach = Dot(state.Velocity[v], direction);
    if (state.Marks[w] & IsMoving)
    {
      approach = 0.5f * (approach - Dot(state.Velocity[w], direction));
    }
    const float least = std::min(state.Sizing.At(v), state.Sizing.At(w));
    if (separates && distance < least)
    {
      approach = std::max(approach, 0.f) + ContactRecovery * (least - distance) / time;
    }
    if (approach > 0)
    {
      sum += direction * approach;
      ++count;
    }
  }
  return sum * (1.f / static_cast<float>(std::max(count, 1)));
}

void Dynamics::Displace(SurfaceState& state, const std::vector<int>& active, const Step& step) const
{
  for (const int v : active)
  {
    const float longest = static_cast<float>(this->Options.MaximumStep) * state.Sizing.At(v);
    const Vector p = state.Mesh.Position[v];
    state.PreviousPosition[v] = p;
    Vector move = state.Velocity[v] * step.Time;
    const float length = Length(move);
    if (length > longest)
    {
      move *= longest / length;
    }
    state.Displacement[v] = std::min(length, longest);
    state.MoveTo(v, state.Margin.Confined(p, p + move));
  }
}

void Dynamics::Freeze(
  SurfaceState& state, const std::vector<int>& active, const std::vector<int>& working) const
{
  for (const int v : active)
  {
    if (!state.Mesh.IsAlive(v))
    {
      continue;
    }
    const float alongNormal =
      (this->Leaves ? VisibleIfLeft : VisibleAlongNormal) * state.Sizing.At(v);
    const float anywhere = Visible * state.Sizing.At(v);
    const Vector moved = state.Mesh.Position[v] - state.Anchor[v];
    if (std::abs(Dot(moved, state.Normal[v].Axis())) > alongNormal ||
      SquaredLength(moved) > anywhere * anywhere)
    {
      state.Anchor[v] = state.Mesh.Position[v];
      state.Marks[v] |= HasMoved;
    }
  }
  for (const int v : working)
  {
    const Ring& ring = state.Mesh.Rings[v];
    const bool moved = (state.Marks[v] & HasMoved) ||
      std::any_of(ring.Item, ring.Item + ring.Count,
        [&state](int w) { return (state.Marks[w] & HasMoved) != 0; });
    const auto isOff = [&](float least)
    { return this->TheField.IsOff(state.Mesh.Position[v], least * state.Sizing.At(v)); };
    const bool isLeftToRegularise =
      this->Leaves && state.Active[v] && !state.NearOthers[v] && !isOff(ConvergedWithin);
    if (!isLeftToRegularise && moved && (state.Active[v] || !this->Leaves || isOff(LeftOff)))
    {
      state.Activate(v);
    }
    else if (isLeftToRegularise ||
      (this->Options.FreezeMotionlessVertices && state.Active[v] &&
        ++state.ConvergedIterations[v] >= IterationsToConverge))
    {
      state.Active[v] = 0;
      state.Velocity[v] = Vector();
    }
  }
  for (const int v : active)
  {
    state.Marks[v] &= static_cast<std::uint8_t>(~HasMoved);
  }
}
}
