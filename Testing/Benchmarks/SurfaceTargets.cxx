// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SurfaceTargets.h"

#include <cmath>
#include <limits>
#include <set>

namespace volumic
{
namespace bench
{
namespace
{

const double Unknown = std::numeric_limits<double>::quiet_NaN();

class TargetTable
{
public:
  explicit TargetTable(const std::vector<SurfaceRunResult>& runs) : Runs(runs) {}

  TextRows Rows{ TargetHeading() };

  double Get(const char* run, const char* figure) const
  {
    const SurfaceRunResult* found = FindRun(this->Runs, run);
    return found ? found->Figures.Get(figure) : Unknown;
  }

  double Ratio(const char* figure, const char* one, const char* other) const
  {
    return this->Get(one, figure) / this->Get(other, figure);
  }

  void Add(const char* name, const std::string& what, double figure, Bound bound, double limit)
  {
    this->Rows.push_back(TargetRow(name, what, figure, bound, limit));
  }

  /** The worst of a figure, or of a sum of figures, over the levels of us-1. */
  void AddWorst(const char* name, const std::string& what, const std::vector<const char*>& figures,
    Bound bound, double limit)
  {
    double worst = Unknown, finest = Unknown;
    int worstLevel = -1;
    for (int h = 0; h < this->Levels(); ++h)
    {
      double sum = 0.0;
      for (const char* figure : figures)
      {
        sum += this->Get("us-1", RunFigures::Indexed("level", h, figure).c_str());
      }
      finest = h == 0 ? sum : finest;
      const bool worse = bound == Bound::AtMost ? sum > worst : sum < worst;
      if (!std::isnan(sum) && (std::isnan(worst) || worse))
      {
        worst = sum;
        worstLevel = h;
      }
    }
    std::string where;
    if (worstLevel > 0)
    {
      where = ", level " + std::to_string(worstLevel) + " (level 0: " + ShortText(finest) + ")";
    }
    this->Add(name, what + where, worst, bound, limit);
  }

  /** Number of surfaces that differ among those that must not; unknown with less than two runs. */
  double DistinctSurfaces() const
  {
    std::set<std::string> distinct;
    int count = 0;
    for (const SurfaceRunResult& run : this->Runs)
    {
      const bool isUsN = run.Name.compare(0, 3, "us-") == 0 && run.Name[3] >= '0' &&
        run.Name[3] <= '9' && run.Figures.GetText("Failure").empty();
      if (isUsN)
      {
        distinct.insert(run.Figures.GetText("Fingerprint"));
        count += static_cast<int>(run.Figures.Get("Repetitions"));
        if (run.Figures.Get("RepetitionsDiffer") > 0.0)
        {
          distinct.insert(run.Name + " differs from itself");
        }
      }
    }
    return count < 2 ? Unknown : static_cast<double>(distinct.size());
  }

private:
  int Levels() const
  {
    const double levels = this->Get("us-1", "Levels");
    return std::isnan(levels) ? 0 : static_cast<int>(levels);
  }

  const std::vector<SurfaceRunResult>& Runs;
};

} // namespace

//------------------------------------------------------------------------------
std::vector<std::string> TargetHeading()
{
  return { "target", "what", "figure", "limit", "verdict" };
}

std::vector<std::string> TargetRow(
  const std::string& name, const std::string& what, double figure, Bound bound, double limit)
{
  const bool isReached = bound == Bound::AtMost ? figure <= limit : figure >= limit;
  return { name, what, ShortText(figure),
    (bound == Bound::AtMost ? "<= " : ">= ") + ShortText(limit),
    std::isnan(figure) ? "not run" : (isReached ? "reached" : "missed") };
}

TextRows TargetRows(const std::vector<SurfaceRunResult>& runs)
{
  TargetTable table(runs);
  const char* seconds = "ProcessorSeconds";
  table.Add("S1", "us-1 / remeshed, processor seconds", table.Ratio(seconds, "us-1", "remeshed"),
    Bound::AtMost, 0.5);
  table.Add("S2", "us-1 / mesher, processor seconds", table.Ratio(seconds, "us-1", "mesher"),
    Bound::AtMost, 0.6);
  table.Add("S3", "us-1 / levelset, processor seconds", table.Ratio(seconds, "us-1", "levelset"),
    Bound::AtMost, 0.05);
  table.Add("S4", "us-1, us per vertex and iteration",
    table.Get("us-1", "MicrosecondsPerVertexIteration"), Bound::AtMost, 1.0);
  table.Add("S5", "us-1 / us-flat, processor seconds", table.Ratio(seconds, "us-1", "us-flat"),
    Bound::AtMost, 0.25);
  table.Add("S5", "  to the same result: difference of share reached, %",
    100.0 * std::fabs(table.Get("us-1", "Reach") - table.Get("us-flat", "Reach")), Bound::AtMost,
    0.5);
  table.Add("S5", "  and of enclosed volume, %",
    100.0 * std::fabs(table.Ratio("Volume", "us-1", "us-flat") - 1.0), Bound::AtMost, 0.5);
  // Of single runs; the target is one of medians, see MeasureThreads.
  table.Add("S6", "us-1 / us-2, seconds", table.Ratio("WallSeconds", "us-1", "us-2"),
    Bound::AtLeast, table.Get("us-1", "Voxels") > LargeVolume ? 1.85 : 1.75);
  table.Add("S7", "us-1 / remeshed, MB at the peak",
    table.Ratio("PeakMegabytes", "us-1", "remeshed"), Bound::AtMost, 0.6);

  table.AddWorst("Q1", "open, non-manifold, misoriented",
    { "OpenEdges", "NonManifold", "MisorientedEdges" }, Bound::AtMost, 0.0);
  table.AddWorst("Q1", "self-intersections", { "SelfIntersections" }, Bound::AtMost, 0.0);
  table.AddWorst("Q2", "edges outside [delta, 2.5 delta]", { "EdgesOutside" }, Bound::AtMost, 0.0);
  table.AddWorst("Q2", "pairs too near", { "NearPairs" }, Bound::AtMost, 0.0);
  table.AddWorst("Q3", "radius ratio mean", { "RatioMean" }, Bound::AtLeast, 0.97);
  table.AddWorst("Q3", "radius ratio 1 % quantile", { "RatioQuantile01" }, Bound::AtLeast, 0.80);
  table.AddWorst("Q3", "radius ratio minimum", { "RatioLeast" }, Bound::AtLeast, 0.50);
  table.AddWorst(
    "Q4", "distance at vertices", { "DistanceAtVertices" }, Bound::AtMost, 0.02);
  table.AddWorst(
    "Q4", "distance at centroids", { "DistanceAtCentroids" }, Bound::AtMost, 0.09);
  table.AddWorst("Q4", "share of boundary reached", { "Reach" }, Bound::AtLeast, 0.98);
  table.Add(
    "Q5", "different surfaces over runs and threads", table.DistinctSurfaces(), Bound::AtMost, 1.0);
  return table.Rows;
}

} // namespace bench
} // namespace volumic
