// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceEvolution.h"

#include "ComponentWatch.h"
#include "Division.h"
#include "Dynamics.h"
#include "EdgeFlip.h"
#include "EdgeSplit.h"
#include "Field.h"
#include "InitialSurface.h"
#include "LostParts.h"
#include "Proximity.h"
#include "Remesher.h"
#include "RestCriterion.h"
#include "SurfaceCheck.h"
#include "SurfaceState.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>

namespace volumic
{
namespace
{
using Clock = std::chrono::steady_clock;

/** Adds the time since the last call to a phase. */
class Stopwatch
{
public:
  explicit Stopwatch(HistoryRow& row)
    : Row(row)
    , Start(Clock::now())
    , Last(Start)
  {
  }
  void Lap(Phase phase)
  {
    const Clock::time_point now = Clock::now();
    this->Row.PhaseSeconds[static_cast<int>(phase)] +=
      std::chrono::duration<double>(now - this->Last).count();
    this->Last = now;
  }
  void Stop()
  {
    this->Row.Seconds += std::chrono::duration<double>(Clock::now() - this->Start).count();
  }

private:
  HistoryRow& Row;
  Clock::time_point Start;
  Clock::time_point Last;
};

/** What an iteration is driven by: forces; shape and residual; shape alone. */
enum class Mode
{
  Evolve,
  Regularise,
  Adapt
};

/** Passes of tangential smoothing and snapping at the end of a level. */
constexpr int RegularisationPasses = 6;

void CheckRange(const char* name, double value, double low, double high)
{
  if (!(value >= low && value <= high))
  {
    throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) +
      ", it must lie in [" + std::to_string(low) + ", " + std::to_string(high) + "].");
  }
}
}

const char* Describe(StopReason reason)
{
  switch (reason)
  {
    case StopReason::Converged:
      return "converged";
    case StopReason::IterationLimit:
      return "iteration limit";
    case StopReason::Cancelled:
      return "cancelled";
    default:
      return "vanished";
  }
}

struct SurfaceEvolution::Implementation
{
  SurfaceOptions Options;
  Executor& Threads;
  Monitor& Listener;
  SurfaceState State;
  std::unique_ptr<Field> TheField;
  int Level = 0;
  std::vector<HistoryRow> Rows;
  int LastIterations = 0;
  LostParts LastLost;
  Proximity Near;
  Proximity Recheck;
  ComponentWatch Watch;
  RestCriterion Rest;
  std::vector<int> Awake;
  std::vector<int> Working;
  std::vector<int> Suspects;
  std::vector<std::uint8_t> Marked;
  std::vector<double> Partial;
  int Unlabelled = 0; ///< Merges and cuts since components were labelled last.
  int Shrunk = 0; ///< Collapses since components were labelled last.
  int Unresolved = 0;

  Implementation(const SurfaceOptions& options, Executor& executor, Monitor& monitor)
    : Options(options)
    , Threads(executor)
    , Listener(monitor)
  {
  }

  void Enter(const LevelImage& image, int level);
  void Reset();
  void Recover();
  void LayGrid();
  void DivideOnce();
  void Adapt();
  void WakeAll();
  void CollectAwake();
  void CollectWorking();
  void CollectSuspects();
  void MarkRing(int v);
  void RollBack();
  void UpdateTouched();
  double EnclosedVolume();
  void Iterate(HistoryRow& row, Dynamics& dynamics, Remesher& remesher, Mode mode);
  void FillRow(HistoryRow& row) const;
  void FillCounts(HistoryRow& row) const;
  void Regularise(Dynamics& dynamics);
  StopReason Evolve();
  StopReason Run();
};

void SurfaceEvolution::Implementation::Enter(const LevelImage& image, int level)
{
  this->TheField = std::make_unique<Field>(image, this->Options, this->Threads);
  this->Level = level;
  this->State.Delta = static_cast<float>(this->Options.SamplingRatio * image.Unit);
}

void SurfaceEvolution::Implementation::Reset()
{
  SurfaceState& s = this->State;
  s.Mesh.Reorder(SpaceFillingOrder(s.Mesh, s.Delta));
  this->LayGrid();
  this->CollectAwake();
  s.UpdateShape(this->Awake, this->Threads);
  // Verification relies on it that no edge is longer than the constraints allow.
  Remesher(s, nullptr, false).Split(this->Awake);
  s.Touched.clear();
  s.UpdateShape(this->Awake, this->Threads);
  this->Near.Examine(s, this->Awake, this->Threads);
  this->Watch.Label(s);
}

void SurfaceEvolution::Implementation::LayGrid()
{
  SurfaceState& s = this->State;
  const LevelImage& image = this->TheField->Image();
  Vector low(0, 0, 0);
  Vector high(static_cast<float>(image.Size[0] * image.Step[0]),
    static_cast<float>(image.Size[1] * image.Step[1]),
    static_cast<float>(image.Size[2] * image.Step[2]));
  for (const Vector& p : s.Mesh.Position)
  {
    low = Vector(std::min(low.X, p.X), std::min(low.Y, p.Y), std::min(low.Z, p.Z));
    high = Vector(std::max(high.X, p.X), std::max(high.Y, p.Y), std::max(high.Z, p.Z));
  }
  const Vector margin(2 * s.Delta, 2 * s.Delta, 2 * s.Delta);
  this->Near.Clear();
  this->Recheck.Clear();
  s.Reset(low - margin, high + margin);
}

void SurfaceEvolution::Implementation::DivideOnce()
{
  SurfaceState& s = this->State;
  s.Mesh.Reorder(SpaceFillingOrder(s.Mesh, s.Delta));
  const int firstNew = volumic::Divide(s.Mesh);
  // The division flips edges of the old surface; in narrow places these may pass through each
  // other. Such edges are flipped back, which at worst leaves the old surface, and cut to length.
  constexpr int rounds = 8;
  this->LayGrid();
  this->CollectAwake();
  s.UpdateShape(this->Awake, this->Threads);
  this->Near.Examine(s, this->Awake, this->Threads);
  for (int round = 0; round < rounds && !this->Near.Meetings().empty(); ++round)
  {
    std::vector<int> halves;
    for (const Proximity::Meeting& meeting : this->Near.Meetings())
    {
      for (const std::array<int, 3>& face : { meeting.First, meeting.Second })
      {
        for (int k = 0; k < 3; ++k)
        {
          const int a = face[k];
          const int b = face[(k + 1) % 3];
          if (a < firstNew || b < firstNew || !s.Mesh.AreNeighbours(a, b))
          {
            continue;
          }
          const EdgeFlip flip = EdgeFlip::Of(s.Mesh, a, b);
          if (flip.A < firstNew && flip.B < firstNew && flip.IsLegal(s.Mesh))
          {
            flip.Apply(s.Mesh);
            const EdgeSplit split{ flip.A, flip.B };
            const Vector middle =
              (s.Mesh.Position[flip.A] + s.Mesh.Position[flip.B]) * 0.5f;
            const int m = split.IsLegal(s.Mesh) ? split.Apply(s.Mesh, middle) : -1;
            if (m >= 0)
            {
              s.Adopt(m, flip.A);
            }
          }
        }
      }
    }
    this->CollectAwake();
    s.UpdateShape(this->Awake, this->Threads);
    this->Near.Examine(s, this->Awake, this->Threads);
  }
}

void SurfaceEvolution::Implementation::Adapt()
{
  // The verified displacements and edits of an iteration, until the lengths are legal.
  Dynamics dynamics(*this->TheField, this->Options, this->Threads);
  Remesher remesher(this->State, this->TheField.get(), false);
  constexpr int rounds = 40;
  for (int round = 0; round < rounds; ++round)
  {
    HistoryRow row;
    this->WakeAll();
    this->Iterate(row, dynamics, remesher, Mode::Adapt);
    if (row.Splits + row.Collapses <= this->State.Mesh.NumberOfVertices() / 1000)
    {
      break;
    }
  }
  this->Reset();
}

void SurfaceEvolution::Implementation::WakeAll()
{
  for (int v = 0; v < this->State.Mesh.Size(); ++v)
  {
    this->State.Awake[v] = this->State.Mesh.IsAlive(v);
  }
}

void SurfaceEvolution::Implementation::Recover()
{
  this->LastLost = LostParts();
  // Without an isopotential there is no object's side to look for.
  if (!this->Options.RecoverLostParts || !(this->Options.IsopotentialWeight > 0.))
  {
    return;
  }
  SurfaceState& s = this->State;
  const double radius = SmallestSeed * s.Delta;
  const LostPartSeeds lost =
    FindLostParts(s, *this->TheField, this->Options.MinimumPartSize, radius);
  this->LastLost = { lost.Found, lost.Seeded };
  if (lost.Centres.empty())
  {
    return;
  }
  for (const Point& centre : lost.Centres)
  {
    s.Mesh.Append(Icosahedron(centre, radius));
  }
  this->Reset();
}

void SurfaceEvolution::Implementation::CollectAwake()
{
  this->Awake.clear();
  for (int v = 0; v < this->State.Mesh.Size(); ++v)
  {
    if (this->State.Awake[v])
    {
      this->Awake.push_back(v);
    }
  }
}

void SurfaceEvolution::Implementation::MarkRing(int v)
{
  const Ring& ring = this->State.Mesh.Rings[v];
  for (int i = 0; i < ring.Count; ++i)
  {
    const int w = ring.Item[i];
    if (!this->Marked[w])
    {
      this->Marked[w] = 1;
      this->Working.push_back(w);
    }
  }
}

void SurfaceEvolution::Implementation::CollectWorking()
{
  // The awake vertices and the corners of all triangles that move with them.
  this->Marked.assign(this->State.Mesh.Rings.size(), 0);
  this->Working = this->Awake;
  for (int v : this->Awake)
  {
    this->Marked[v] = 1;
  }
  for (int v : this->Awake)
  {
    this->MarkRing(v);
  }
  for (std::size_t i = this->Awake.size(); i < this->Working.size(); ++i)
  {
    this->State.Before[this->Working[i]] = this->State.Mesh.Position[this->Working[i]];
  }
}

void SurfaceEvolution::Implementation::CollectSuspects()
{
  // A star that had some room when it was examined needs no new look before it has used half of
  // it: whatever comes near has used half of its own and is examined itself.
  SurfaceState& s = this->State;
  this->Threads.For(this->Working.size(), 1024,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const int v = this->Working[i];
        const Ring& ring = s.Mesh.Rings[v];
        float moved = s.Moved[v];
        for (int k = 0; k < ring.Count; ++k)
        {
          moved = std::max(moved, s.Moved[ring.Item[k]]);
        }
        s.Drift[v] += moved;
      }
    });
  this->Suspects.clear();
  for (int v : this->Working)
  {
    if (s.Drift[v] > 0.5f * s.Slack[v])
    {
      s.Drift[v] = 0;
      this->Suspects.push_back(v);
    }
  }
  for (int v : this->Awake)
  {
    s.Moved[v] = 0;
  }
}

void SurfaceEvolution::Implementation::UpdateTouched()
{
  std::vector<int>& touched = this->State.Touched;
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  this->State.UpdateShape(touched, this->Threads);
  for (int v : touched)
  {
    this->State.Drift[v] = 1e6f; // Its star is another one: what was examined tells nothing.
  }
  touched.clear();
}

void SurfaceEvolution::Implementation::RollBack()
{
  // The mesh before the displacement was free of intersections, and so is any mesh all of whose
  // vertices have gone back: take back more and more about each hit until none is left.
  SurfaceState& s = this->State;
  const std::vector<Proximity::Meeting>* meetings = &this->Near.Meetings();
  std::vector<int> back;
  std::vector<int> list;
  constexpr int rounds = 12;
  for (int round = 0; round < rounds && !meetings->empty(); ++round)
  {
    back.clear();
    for (const Proximity::Meeting& meeting : *meetings)
    {
      back.insert(back.end(), meeting.First.begin(), meeting.First.end());
      back.insert(back.end(), meeting.Second.begin(), meeting.Second.end());
    }
    for (int widening = 0; widening < round - 1; ++widening)
    {
      const std::size_t n = back.size();
      for (std::size_t i = 0; i < n; ++i)
      {
        const Ring& ring = s.Mesh.Rings[back[i]];
        back.insert(back.end(), ring.Item, ring.Item + ring.Count);
      }
      std::sort(back.begin(), back.end());
      back.erase(std::unique(back.begin(), back.end()), back.end());
    }
    std::sort(back.begin(), back.end());
    back.erase(std::unique(back.begin(), back.end()), back.end());
    bool moved = false;
    list = back;
    for (int v : back)
    {
      // Vertices that are not in the working list have not moved; their Before may be old.
      if (!this->Marked[v])
      {
        continue;
      }
      const Vector& before = s.Before[v];
      moved = moved || SquaredDistance(before, s.Mesh.Position[v]) > 0;
      s.MoveTo(v, before);
      s.Velocity[v] = Vector();
      s.Stuck[v] = static_cast<std::uint8_t>(std::min(s.Stuck[v] + 2, 200));
      s.Awake[v] = 1;
      s.Quiet[v] = 0;
      s.Drift[v] = 1e6f;
      list.insert(list.end(), s.Mesh.Rings[v].Item, s.Mesh.Rings[v].Item + s.Mesh.Rings[v].Count);
    }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    s.UpdateShape(list, this->Threads);
    this->Recheck.Examine(s, list, this->Threads);
    meetings = &this->Recheck.Meetings();
    (void)moved;
  }
  if (!meetings->empty())
  {
    ++this->Unresolved;
  }
}

double SurfaceEvolution::Implementation::EnclosedVolume()
{
  // Fixed blocks summed in order; each face is seen from its three corners.
  const SurfaceMesh& mesh = this->State.Mesh;
  constexpr std::size_t size = 2048;
  this->Partial.assign((mesh.Rings.size() + size - 1) / size, 0.);
  const VectorD origin(mesh.Position.front());
  ForBlocks(this->Threads, mesh.Rings.size(), size,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      double sum = 0;
      for (std::size_t v = begin; v < end; ++v)
      {
        const Ring& ring = mesh.Rings[v];
        const VectorD p = VectorD(mesh.Position[v]) - origin;
        VectorD fan;
        for (int i = 0; i < ring.Count; ++i)
        {
          fan += Cross(VectorD(mesh.Position[ring.Item[i]]) - origin,
            VectorD(mesh.Position[ring.Next(i)]) - origin);
        }
        sum += ring.Count > 0 ? Dot(p, fan) : 0.;
      }
      this->Partial[b] = sum;
    });
  double sum = 0;
  for (double x : this->Partial)
  {
    sum += x;
  }
  return sum / 18.;
}

void SurfaceEvolution::Implementation::Iterate(
  HistoryRow& row, Dynamics& dynamics, Remesher& remesher, Mode mode)
{
  SurfaceState& s = this->State;
  Stopwatch watch(row);
  s.Counts = EditCounts();
  this->CollectAwake();
  row.ActiveVertices = static_cast<int>(this->Awake.size());
  row.Vertices = s.Mesh.NumberOfVertices();
  const bool relax = mode != Mode::Evolve;
  if (relax)
  {
    dynamics.Relax(s, this->Awake, this->Near.Pairs(),
      mode == Mode::Regularise && this->Options.SnapToIsoValue);
  }
  else
  {
    dynamics.Accelerate(s, this->Awake, this->Near.Pairs());
  }
  row.TimeStep = dynamics.TimeStep();
  watch.Lap(Phase::Forces);

  dynamics.Displace(s, this->Awake);
  this->CollectWorking();
  s.UpdateShape(this->Working, this->Threads);
  watch.Lap(Phase::Contact);

  const std::size_t unsplit = this->Working.size();
  remesher.Split(this->Working);
  this->Marked.resize(s.Mesh.Rings.size(), 0);
  for (std::size_t i = unsplit; i < this->Working.size(); ++i)
  {
    this->Marked[this->Working[i]] = 1; // New, with a place before of its own.
  }
  for (int v : s.Touched)
  {
    if (!this->Marked[v])
    {
      this->Marked[v] = 1;
      s.Before[v] = s.Mesh.Position[v];
      this->Working.push_back(v);
    }
  }
  this->UpdateTouched();
  watch.Lap(Phase::Remeshing);

  this->CollectSuspects();
  this->Near.Examine(s, this->Suspects, this->Threads);
  watch.Lap(Phase::Proximity);
  this->RollBack();
  if (!relax)
  {
    dynamics.Freeze(s, this->Awake);
  }
  watch.Lap(Phase::Verification);

  if (!relax)
  {
    remesher.Merge(this->Near.Pairs());
  }
  watch.Lap(Phase::Topology);
  remesher.Collapse(this->Working);
  remesher.Flip(this->Working);
  remesher.Unstick(this->Working);
  for (int v : this->Working)
  {
    if (s.Stuck[v] > 0)
    {
      --s.Stuck[v];
    }
  }
  this->UpdateTouched();
  watch.Lap(Phase::Remeshing);

  // A component may become a small one without any change of topology.
  this->Shrunk += s.Counts.Collapses;
  constexpr int suspicious = 40;
  this->Unlabelled += s.Counts.Merges + s.Counts.Cuts;
  const bool due = row.Vertices < 20000 || this->LastIterations % 4 == 0;
  if ((this->Unlabelled > 0 && due) || this->Shrunk > suspicious)
  {
    this->Unlabelled = 0;
    this->Watch.Label(s);
    this->Shrunk = 0;
  }
  this->Watch.DeleteDoomed(s);
  watch.Lap(Phase::Topology);
  this->FillRow(row);
  watch.Stop();
}

void SurfaceEvolution::Implementation::FillCounts(HistoryRow& row) const
{
  row.Vertices = this->State.Mesh.NumberOfVertices();
  row.EulerCharacteristic = this->State.EulerCharacteristic;
  row.Components = this->Watch.NumberOfComponents();
}

void SurfaceEvolution::Implementation::FillRow(HistoryRow& row) const
{
  const SurfaceState& s = this->State;
  row.Iteration = static_cast<int>(this->Rows.size()) + 1;
  row.Level = this->Level;
  row.Merges = s.Counts.Merges;
  row.Cuts = s.Counts.Cuts;
  row.Splits = s.Counts.Splits;
  row.Collapses = s.Counts.Collapses;
  row.Flips = s.Counts.Flips;
  this->FillCounts(row);
  double energy = 0;
  for (int v : this->Awake)
  {
    if (s.Mesh.IsAlive(v))
    {
      const double speed = Dot(s.Velocity[v], s.Normal[v]);
      energy += 0.5 * speed * speed;
    }
  }
  row.KineticEnergy = energy / std::max(row.Vertices, 1);
}

void SurfaceEvolution::Implementation::Regularise(Dynamics& dynamics)
{
  // The same verified displacements and edits, driven by shape and residual instead of forces.
  SurfaceState& s = this->State;
  const std::vector<std::uint8_t> awake = s.Awake;
  Remesher remesher(s, this->TheField.get(), false);
  std::fill(s.Velocity.begin(), s.Velocity.end(), Vector());
  HistoryRow row;
  for (int pass = 0; pass < RegularisationPasses && s.Mesh.NumberOfVertices() > 0; ++pass)
  {
    this->WakeAll();
    this->Iterate(row, dynamics, remesher, Mode::Regularise);
  }
  for (int v = 0; v < s.Mesh.Size(); ++v)
  {
    s.Awake[v] = s.Mesh.IsAlive(v) && (v >= static_cast<int>(awake.size()) || awake[v]);
    s.Velocity[v] = Vector();
  }
  if (!this->Rows.empty())
  {
    HistoryRow& last = this->Rows.back();
    last.PhaseSeconds[static_cast<int>(Phase::Division)] += row.Seconds;
    this->FillCounts(last);
  }
}

StopReason SurfaceEvolution::Implementation::Run()
{
  const StopReason reason = this->Evolve();
  if (reason == StopReason::Converged || reason == StopReason::IterationLimit)
  {
    Dynamics dynamics(*this->TheField, this->Options, this->Threads);
    this->Regularise(dynamics);
    if (this->State.Mesh.NumberOfVertices() == 0)
    {
      return StopReason::Vanished;
    }
  }
  return reason;
}

StopReason SurfaceEvolution::Implementation::Evolve()
{
  SurfaceState& s = this->State;
  this->LastIterations = 0;
  this->Rest.Reset();
  Dynamics dynamics(*this->TheField, this->Options, this->Threads);
  const bool evidence = this->Options.IsopotentialWeight > 0;
  Remesher remesher(s, evidence ? this->TheField.get() : nullptr, this->Options.TopologyChanges);
  const double cube = std::pow(static_cast<double>(s.Delta), 3);
  while (true)
  {
    if (s.Mesh.NumberOfVertices() == 0)
    {
      return StopReason::Vanished;
    }
    if (this->LastIterations >= this->Options.MaximumNumberOfIterations)
    {
      return StopReason::IterationLimit;
    }
    HistoryRow row;
    this->Iterate(row, dynamics, remesher, Mode::Evolve);
    this->Rows.push_back(row);
    ++this->LastIterations;
    Monitor::Status status;
    status.Level = this->Level;
    status.Iteration = this->LastIterations;
    status.Vertices = row.Vertices;
    status.ActiveVertices = row.ActiveVertices;
    status.Fraction = 1. - std::exp(-this->LastIterations / 80.);
    if (!this->Listener.Continue(status))
    {
      return StopReason::Cancelled;
    }
    if (this->LastIterations % RestCriterion::Interval == 0 && s.Mesh.NumberOfVertices() > 0)
    {
      const double volume = this->EnclosedVolume();
      this->Rest.Add(volume);
      if (this->Rest.IsMet(
            std::max(cube, this->Options.ConvergenceTolerance * std::abs(volume))))
      {
        return StopReason::Converged;
      }
    }
  }
}

SurfaceEvolution::SurfaceEvolution(
  const SurfaceOptions& options, Executor& executor, Monitor& monitor)
{
  CheckRange("SamplingRatio", options.SamplingRatio, std::sqrt(3.) / 2.5 - 1e-6, 1.);
  CheckRange("TensionWeight", options.TensionWeight, 0., 1e6);
  CheckRange("ElasticityWeight", options.ElasticityWeight, 0., 1e6);
  CheckRange("IsopotentialWeight", options.IsopotentialWeight, 0., 1e6);
  CheckRange("GradientWeight", options.GradientWeight, 0., 1e6);
  CheckRange("Friction", options.Friction, 1e-6, 1e6);
  CheckRange("SeedRadius", options.SeedRadius, 0., 1e9);
  CheckRange("ConvergenceTolerance", options.ConvergenceTolerance, 0., 1.);
  CheckRange("MaximumStep", options.MaximumStep, 1e-3, 0.5);
  this->Self = std::make_unique<Implementation>(options, executor, monitor);
}

SurfaceEvolution::~SurfaceEvolution() = default;

void SurfaceEvolution::StartEnclosing(const LevelImage& image, int level)
{
  Implementation& self = *this->Self;
  self.Enter(image, level);
  self.State.Mesh.Clear();
  self.State.Mesh.Append(EnclosingSurface(image, 2. * self.State.Delta));
  self.Reset();
}

int SurfaceEvolution::StartSeeds(
  const LevelImage& image, int level, const std::vector<Point>& centres)
{
  Implementation& self = *this->Self;
  self.Enter(image, level);
  const double delta = self.State.Delta;
  const double radius = std::max(
    self.Options.SeedRadius > 0. ? self.Options.SeedRadius : 1.2 * delta, SmallestSeed * delta);
  const std::vector<Point> places =
    ChooseSeeds(*self.TheField, centres, 2. * radius + 1.6 * delta);
  self.State.Mesh.Clear();
  for (const Point& centre : places)
  {
    self.State.Mesh.Append(DividedIcosahedron(centre, radius, 2. * delta));
  }
  self.Reset();
  return static_cast<int>(places.size());
}

void SurfaceEvolution::StartSurface(
  const LevelImage& image, int level, const IndexedSurface& surface)
{
  CheckInitialSurface(surface);
  CheckOverlapsImage(surface, image);
  Implementation& self = *this->Self;
  const IndexedSurface prepared = LimitValence(surface);
  if (CountSelfIntersections(prepared, 1) > 0)
  {
    throw std::invalid_argument("The initial surface has points with more neighbours than can be "
                                "handled, and intersects itself when they are split. Remesh it.");
  }
  self.Enter(image, level);
  self.State.Mesh.Clear();
  self.State.Mesh.Append(prepared);
  self.Reset();
  self.Adapt();
}

StopReason SurfaceEvolution::Run()
{
  return this->Self->Run();
}

void SurfaceEvolution::Divide(const LevelImage& image, int level)
{
  Implementation& self = *this->Self;
  const double coarse = self.State.Delta;
  self.Enter(image, level);
  // As many divisions as bring delta nearest to the new one: one where the pyramid's factor is
  // the mesh's, sqrt 3.
  const int divisions = static_cast<int>(
    std::lround(std::log(coarse / self.State.Delta) / std::log(std::sqrt(3.))));
  for (int i = 0; i < divisions; ++i)
  {
    self.DivideOnce();
  }
  self.Reset();
  self.Recover();
}

SurfaceResult SurfaceEvolution::Result() const
{
  const SurfaceState& s = this->Self->State;
  SurfaceResult result;
  static_cast<IndexedSurface&>(result) = s.Mesh.ToIndexed();
  result.Delta = s.Delta;
  const float sign = this->Self->Options.ObjectIsBright ? 1.f : -1.f;
  for (int v = 0; v < s.Mesh.Size(); ++v)
  {
    if (s.Mesh.IsAlive(v))
    {
      const Vector& n = s.Normal[v];
      result.Normals.push_back({ n.X, n.Y, n.Z });
      result.Residual.push_back(sign * this->Self->TheField->ValueAt(s.Mesh.Position[v]));
      result.Motionless.push_back(!s.Awake[v]);
    }
  }
  return result;
}

const std::vector<HistoryRow>& SurfaceEvolution::History() const
{
  return this->Self->Rows;
}

int SurfaceEvolution::Iterations() const
{
  return this->Self->LastIterations;
}

SurfaceEvolution::LostParts SurfaceEvolution::Lost() const
{
  return this->Self->LastLost;
}
}
