// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/SurfaceEvolution.h"

#include "Core/Common/Refuse.h"
#include "Core/Common/Spans.h"
#include "Core/Evolution/EvolutionImplementation.h"
#include "Core/Evolution/GradedSizes.h"
#include "Core/Evolution/InitialSurface.h"
#include "Core/Evolution/Stopwatch.h"
#include "Core/Mesh/SurfaceCheck.h"
#include "Core/Surface/RemainingContacts.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace volumic
{
namespace
{
/** Vertices that one thread hands out at a time. */
constexpr std::size_t ResultSpan = 256; // They look at voxels: HostThreads::For.

void CheckRange(const char* name, double value, double low, double high)
{
  if (!(value >= low && value <= high))
  {
    Refuse(name, " is ", value, ", it must lie in [", low, ", ", high, "].");
  }
}
}

const char* Describe(StopReason reason)
{
  switch (reason)
  {
    case StopReason::Converged:
      return "converged";
    case StopReason::LimitCycle:
      return "limit cycle";
    case StopReason::IterationLimit:
      return "iteration limit";
    case StopReason::Cancelled:
      return "cancelled";
    default:
      return "vanished";
  }
}

SurfaceEvolution::SurfaceEvolution(
  const SurfaceOptions& options, Executor& executor, Monitor& monitor)
{
  CheckRange("Sampling Ratio", options.SamplingRatio,
    SizingField::LeastSamplingRatio - 1e-6, 1.);
  CheckRange("Tension Weight", options.TensionWeight, 0., 1e6);
  CheckRange("Elasticity Weight", options.ElasticityWeight, 0., 1e6);
  CheckRange("Isopotential Weight", options.IsopotentialWeight, 0., 1e6);
  CheckRange("Gradient Weight", options.GradientWeight, 0., 1e6);
  CheckRange("Point Attraction Weight", options.PointAttractionWeight, 0., 1e6);
  CheckRange("Edge Attraction Weight", options.EdgeAttractionWeight, 0., 1e6);
  CheckRange("Friction", options.Friction, 1e-6, 1e6);
  CheckRange("Seed Radius", options.SeedRadius, 0., 1e9);
  CheckRange("Convergence Tolerance", options.ConvergenceTolerance, 0., 1.);
  CheckRange("MaximumStep", options.MaximumStep, 1e-3, 0.5);
  SurfaceOptions adjusted = options;
  adjusted.SnapToEdges = options.SnapToIsoValue && options.EdgeAttractionWeight > 0.;
  adjusted.SnapToIsoValue = options.SnapToIsoValue && !adjusted.SnapToEdges;
  this->Self = std::make_unique<Implementation>(adjusted, executor, monitor);
}

SurfaceEvolution::~SurfaceEvolution() = default;

void SurfaceEvolution::StartEnclosing(const LevelImage& image, int level)
{
  Implementation& self = *this->Self;
  Stopwatch watch(self.Preparing);
  self.Enter(image, level);
  self.Clear();
  self.State.Mesh.Append(EnclosingSurface(image, self.State.Sizing.OfLevel()));
  self.Reset();
  watch.Lap(Phase::Division);
  self.GoOn(Monitor::Activity::Starting, 1.);
}

void SurfaceEvolution::StartEnclosingParts(const LevelImage& image, int level)
{
  Implementation& self = *this->Self;
  Stopwatch watch(self.Preparing);
  self.Enter(image, level);
  self.Clear();
  self.Reset();
  self.Recover();
  watch.Lap(Phase::Recovery);
  if (self.LastLost.Enclosed == 0 && !self.Stopped)
  {
    this->StartEnclosing(image, level);
  }
}

int SurfaceEvolution::StartSeeds(
  const LevelImage& image, int level, const std::vector<Point>& centres)
{
  Implementation& self = *this->Self;
  Stopwatch watch(self.Preparing);
  self.Enter(image, level);
  const double delta = self.State.Sizing.OfLevel();
  const double radius = std::max(
    self.Options.SeedRadius > 0. ? self.Options.SeedRadius : 1.2 * delta, SmallestSeed * delta);
  const std::vector<Point> places =
    ChooseSeeds(*self.TheField, centres, 2. * radius + 1.6 * delta);
  self.Clear();
  for (const Point& centre : places)
  {
    self.State.Mesh.Append(DividedIcosahedron(centre, radius, 2. * delta));
  }
  self.Reset();
  watch.Lap(Phase::Division);
  return static_cast<int>(places.size());
}

void SurfaceEvolution::StartSurface(
  const LevelImage& image, int level, const IndexedSurface& surface)
{
  CheckInitialSurface(surface);
  CheckOverlapsImage(surface, image);
  Implementation& self = *this->Self;
  Stopwatch watch(self.Preparing);
  self.Enter(image, level);
  self.Take(surface, false);
  watch.Lap(Phase::Division);
}

void SurfaceEvolution::StartIsoSurface(
  const LevelImage& image, int level, const IndexedSurface& surface)
{
  if (surface.Triangles.empty())
  {
    this->StartSurface(image, level, surface);
    return;
  }
  Implementation& self = *this->Self;
  Stopwatch watch(self.Preparing);
  self.Enter(image, level);
  self.Take(surface, true);
  watch.Lap(Phase::Division);
}

StopReason SurfaceEvolution::Run()
{
  return this->Self->Run();
}

void SurfaceEvolution::Revise(const LevelImage& image)
{
  this->Self->Revise(image);
}

void SurfaceEvolution::ForgetMotion()
{
  this->Self->State.ForgetMotion();
}

void SurfaceEvolution::LeaveLevel()
{
  Implementation& self = *this->Self;
  self.ForgetBlocks();
  self.State.ForgetAllButMesh();
  self.TheField.reset();
}

void SurfaceEvolution::SetMeanEdgeLength(double length)
{
  this->Self->WantedMeanEdge = length;
}

void SurfaceEvolution::SetGrading(const Grading& grading)
{
  this->Self->WantedGrading = grading;
}

bool SurfaceEvolution::Divide(const LevelImage& image, int level)
{
  Implementation& self = *this->Self;
  Stopwatch watch(self.Preparing);
  self.GoOn(Monitor::Activity::Regularising, 1.);
  if (self.Stopped)
  {
    return false;
  }
  const double coarse = self.State.Sizing.OfLevel();
  self.LastLost = LostParts();
  self.Lost = LostBoundary();
  self.Enter(image, level);
  // As many divisions as bring delta nearest to the new one: one where the pyramid's factor is
  // the mesh's, sqrt 3.
  const int divisions = static_cast<int>(
    std::lround(std::log(coarse / self.State.Sizing.OfLevel()) /
      std::log(SizingField::DivisionFactor)));
  // After each of these steps the surface is one to hand over.
  const bool isGraded = self.WantedGrading.IsWanted();
  // What is too thin for the undivided mesh is lost in a descent, and must be found again. Beyond the
  // image the field is that of the level before.
  const bool descends = self.Options.FollowsFieldAlone() && self.Options.RecoverLostParts;
  if (descends && !isGraded && divisions > 0 && level >= 0)
  {
    self.DescendField(coarse);
  }
  bool goesOn = true;
  if (!isGraded || divisions == 0 || !self.DivideWhereWanted(coarse))
  {
    goesOn = self.DivideAll(divisions);
  }
  watch.Lap(Phase::Division);
  goesOn = self.GoOn(Monitor::Activity::Dividing, 1.) && goesOn;
  if (goesOn)
  {
    self.Recover();
  }
  if (self.HasDescended)
  {
    self.ActivateWhereOff(Dynamics::LeftOff);
  }
  watch.Lap(Phase::Recovery);
  self.GoOn(Monitor::Activity::Recovering, 1.);
  return true;
}

SurfaceResult SurfaceEvolution::Result() const
{
  const SurfaceState& s = this->Self->State;
  const Field& field = *this->Self->TheField;
  Executor& threads = this->Self->Threads;
  SurfaceResult result;
  result.Delta = s.Sizing.OfLevel();
  if (s.Mesh.NumberOfVertices() == 0)
  {
    return result;
  }
  RemainingContacts contacts = FindRemainingContacts(s, field, threads);
  static_cast<IndexedSurface&>(result) = s.Mesh.ToIndexed(threads);
  const float sign = this->Self->Options.ObjectIsBright ? 1.f : -1.f;
  const std::size_t n = s.Mesh.Rings.size();
  const std::vector<std::size_t> first = FirstOfSpans(threads, n, ResultSpan,
    [&s](std::size_t begin, std::size_t end)
    {
      std::size_t count = 0;
      for (std::size_t v = begin; v < end; ++v)
      {
        count += s.Mesh.IsAlive(static_cast<int>(v));
      }
      return count;
    });
  result.Normals.resize(first.back());
  result.Residual.resize(first.back());
  result.Motionless.resize(first.back());
  result.Held.resize(first.back());
  const bool isGraded = s.Sizing.IsGraded();
  const Grading& grading = this->Self->WantedGrading;
  const GradedSizes sizes(this->Self->State, field, grading, threads);
  result.Size.resize(isGraded ? first.back() : 0);
  result.Thickness.resize(grading.ThinParts ? first.back() : 0);
  LargeVector<int> index(n, -1); // As ToIndexed numbers them.
  ForSpans(threads, n, ResultSpan,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      std::size_t point = first[span];
      for (std::size_t v = begin; v < end; ++v)
      {
        if (s.Mesh.IsAlive(static_cast<int>(v)))
        {
          const NormalCone& normal = s.Normal[v];
          result.Normals[point] = { normal.X, normal.Y, normal.Z };
          result.Residual[point] = sign * field.ValueAt(s.Mesh.Position[v]);
          result.Motionless[point] = !s.Active[v];
          result.Held[point] = contacts.Held[v];
          if (isGraded)
          {
            result.Size[point] = s.Sizing.At(static_cast<int>(v));
          }
          if (grading.ThinParts)
          {
            result.Thickness[point] = sizes.ThicknessAt(static_cast<int>(v));
          }
          index[v] = static_cast<int>(point++);
        }
      }
    });
  if (s.Sizing.KeepsGradation()) // It has come to rest, or was at it.
  {
    result.FitToTolerance = sizes.Measure();
  }
  result.Contacts = std::move(contacts.Pairs);
  for (std::array<int, 2>& pair : result.Contacts)
  {
    pair = { index[pair[0]], index[pair[1]] };
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

bool SurfaceEvolution::IsStopped() const
{
  return this->Self->Stopped;
}

void SurfaceEvolution::StartClock(std::chrono::steady_clock::time_point start)
{
  this->Self->LastLap = start;
}

double SurfaceEvolution::EndLevel()
{
  Implementation& self = *this->Self;
  const double seconds = self.Lap();
  if (self.HasIteration())
  {
    self.Rows.back().SecondsAfter += seconds;
  }
  return std::exchange(self.LevelSeconds, 0.);
}

SurfaceEvolution::Verdict SurfaceEvolution::Verified() const
{
  return this->Self->LastVerdict;
}

SurfaceEvolution::LostParts SurfaceEvolution::Lost() const
{
  return this->Self->LastLost;
}
}
