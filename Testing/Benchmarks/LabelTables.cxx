// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "LabelTables.h"

#include "SurfaceTargets.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>

namespace volumic
{
namespace bench
{
namespace
{

const double Unknown = std::numeric_limits<double>::quiet_NaN();

struct Column
{
  const char* Name;
  const char* Title;
};

const std::vector<Column> ShownColumns = { { "ProcessorSeconds", "s" }, { "Vertices", "vertices" },
  { "DistanceAtVertices", "dist v" }, { "DistanceAtCentroids", "dist c" },
  { "DistanceLargest", "max" }, { "NormalAngle", "normals" }, { "VolumeError", "vol %" },
  { "VolumeByVoxels", "vox vol %" }, { "VoxelsOutside", "out" }, { "VoxelsInside", "in" },
  { "ReportedWrong", "told" }, { "DihedralMedian", "dih 50" }, { "Dihedral95", "dih 95" },
  { "RatioLeast", "q min" }, { "RatioQuantile01", "q p01" }, { "RatioMean", "q mean" },
  { "SelfIntersections", "x" } };

const std::vector<const char*> CsvColumns = { "Seconds", "ProcessorSeconds", "PeakMegabytes",
  "LabelVoxels", "Vertices", "Triangles", "Components", "OpenEdges", "NonManifold",
  "MisorientedEdges", "SelfIntersections", "EdgeMean", "EdgesOutside", "NearPairs", "RatioLeast",
  "RatioQuantile01", "RatioMean", "DistanceAtVertices", "DistanceAtCentroids", "DistanceLargest",
  "NormalAngle", "VolumeError", "VolumeByVoxels", "VoxelsOutside", "VoxelsInside",
  "ReportedWrong", "DihedralMedian", "Dihedral95", "DihedralLargest", "OverlapPairs",
  "OverlapVertices", "OverlapMean", "OverlapLargest", "OverlapIntersections" };

bool IsPercent(const std::string& name)
{
  return name == "VolumeError" || name == "VolumeByVoxels";
}

std::string LabelText(const LabelRow& row)
{
  return row.Label == LabelRow::AllLabels ? "all" : std::to_string(row.Label);
}

bool IsMade(const LabelRow& row)
{
  return row.Figures.GetText("Failure").empty();
}

/** A label's surface with triangles. */
bool HasSurface(const LabelRow& row)
{
  return IsMade(row) && row.Label != LabelRow::AllLabels && row.Figures.Get("Triangles") > 0.0;
}

double Faults(const LabelRow& row)
{
  return row.Figures.Get("OpenEdges") + row.Figures.Get("NonManifold") +
    row.Figures.Get("MisorientedEdges");
}

double Wrong(const LabelRow& row)
{
  return row.Figures.Get("VoxelsOutside") + row.Figures.Get("VoxelsInside");
}

std::vector<std::string> RunsOf(const std::vector<LabelRow>& rows)
{
  std::vector<std::string> runs;
  for (const LabelRow& row : rows)
  {
    if (std::count(runs.begin(), runs.end(), row.Run) == 0)
    {
      runs.push_back(row.Run);
    }
  }
  return runs;
}

/** What a run did over its labels. */
struct Summary
{
  int Labels = 0, Failed = 0, Empty = 0;
  double Seconds = 0.0, Vertices = 0.0, Outside = 0.0, Inside = 0.0, Told = 0.0, FaultCount = 0.0,
         Crossings = 0.0;
  double RatioLeast = 1.0, Ratio01 = 1.0, RatioMean = 1.0;
  std::vector<double> Dihedral95;

  void Add(const LabelRow& row)
  {
    if (row.Label == LabelRow::AllLabels || !IsMade(row))
    {
      this->Failed += row.Label != LabelRow::AllLabels;
      return;
    }
    ++this->Labels;
    const auto get = [&row](const char* name) { return row.Figures.Get(name); };
    this->Seconds += row.Figures.Has("ProcessorSeconds") ? get("ProcessorSeconds") : 0.0;
    this->Outside += get("VoxelsOutside");
    if (!HasSurface(row))
    {
      ++this->Empty;
      return;
    }
    this->Vertices += get("Vertices");
    this->Inside += get("VoxelsInside");
    this->Told += row.Figures.Has("ReportedWrong") ? get("ReportedWrong") : 0.0;
    this->FaultCount += Faults(row);
    this->Crossings += get("SelfIntersections");
    this->RatioLeast = std::min(this->RatioLeast, get("RatioLeast"));
    this->Ratio01 = std::min(this->Ratio01, get("RatioQuantile01"));
    this->RatioMean = std::min(this->RatioMean, get("RatioMean"));
    this->Dihedral95.push_back(get("Dihedral95"));
  }
};

/** Of many rows, the worst figure and where it is. */
class Worst
{
public:
  double Value = Unknown;
  std::string Where;

  void Add(double value, const LabelRow& row, bool isWorse)
  {
    if (!std::isnan(value) && (std::isnan(this->Value) || isWorse))
    {
      this->Value = value;
      this->Where = ": " + row.Map + " " + LabelText(row);
    }
  }
};

class LabelTargets
{
public:
  explicit LabelTargets(const std::vector<LabelRow>& rows) : All(rows) {}

  TextRows Rows{ TargetHeading() };

  void Add(const char* name, const std::string& what, const std::string& run,
    const std::function<double(const LabelRow&)>& figure, Bound bound, double limit)
  {
    Worst worst;
    for (const LabelRow& row : this->All)
    {
      if (row.Run == run && IsMade(row))
      {
        const double value = figure(row);
        worst.Add(
          value, row, bound == Bound::AtMost ? value > worst.Value : value < worst.Value);
      }
    }
    this->Rows.push_back(TargetRow(name, what + worst.Where, worst.Value, bound, limit));
  }

  /** A figure of labels that have a surface. */
  void AddOfLabels(
    const char* name, const std::string& what, const char* figure, Bound bound, double limit)
  {
    this->Add(name, what, "us",
      [figure](const LabelRow& row)
      { return HasSurface(row) ? std::fabs(row.Figures.Get(figure)) : Unknown; },
      bound, limit);
  }

  /** Of labels that both made: us-alone / the other, in the sum and for the worst of some size. */
  void AddTimes(const std::string& peer)
  {
    std::map<std::pair<std::string, int>, double> ours;
    for (const LabelRow& row : this->All)
    {
      if (row.Run == "us-alone" && HasSurface(row))
      {
        ours[{ row.Map, row.Label }] = row.Figures.Get("ProcessorSeconds");
      }
    }
    double ofUs = 0.0, ofPeer = 0.0;
    Worst worst;
    for (const LabelRow& row : this->All)
    {
      const auto mine = ours.find({ row.Map, row.Label });
      if (row.Run == peer && HasSurface(row) && mine != ours.end())
      {
        const double seconds = row.Figures.Get("ProcessorSeconds");
        ofUs += mine->second;
        ofPeer += seconds;
        const bool isLarge = row.Figures.Get("LabelVoxels") >= 1000.0;
        const double ratio = isLarge ? mine->second / seconds : Unknown;
        worst.Add(ratio, row, ratio > worst.Value);
      }
    }
    this->Rows.push_back(TargetRow("time", "us-alone / " + peer + ", processor seconds of all",
      ofPeer > 0.0 ? ofUs / ofPeer : Unknown, Bound::AtMost, 0.5));
    this->Rows.push_back(TargetRow("time",
      "  of a label from 1000 voxels on, the worst" + worst.Where, worst.Value, Bound::AtMost,
      0.5));
  }

private:
  const std::vector<LabelRow>& All;
};

} // namespace

//------------------------------------------------------------------------------
void PrintLabelRows(const std::vector<LabelRow>& rows)
{
  TextRows table(1, { "map", "label", "run" });
  for (const Column& column : ShownColumns)
  {
    table[0].push_back(column.Title);
  }
  for (const LabelRow& row : rows)
  {
    if (row.Label == LabelRow::AllLabels)
    {
      continue;
    }
    table.push_back({ row.Map, LabelText(row), row.Run });
    for (const Column& column : ShownColumns)
    {
      const double value = row.Figures.Get(column.Name);
      table.back().push_back(ShortText(IsPercent(column.Name) ? 100.0 * value : value));
    }
    if (!IsMade(row))
    {
      table.back()[3] = "failed";
    }
  }
  PrintTable(table, 3);
}

void PrintLabelSummary(const std::vector<LabelRow>& rows)
{
  TextRows table(1,
    { "run", "labels", "failed", "empty", "s", "vertices", "out", "in", "told", "dih 95 median",
      "dih 95 worst", "q min", "q p01", "q mean", "Q1 faults", "x" });
  for (const std::string& run : RunsOf(rows))
  {
    Summary summary;
    for (const LabelRow& row : rows)
    {
      if (row.Run == run)
      {
        summary.Add(row);
      }
    }
    std::sort(summary.Dihedral95.begin(), summary.Dihedral95.end());
    const std::vector<double>& angles = summary.Dihedral95;
    table.push_back({ run, std::to_string(summary.Labels), std::to_string(summary.Failed),
      std::to_string(summary.Empty) });
    for (const double value :
      { summary.Seconds, summary.Vertices, summary.Outside, summary.Inside, summary.Told,
        angles.empty() ? Unknown : angles[angles.size() / 2],
        angles.empty() ? Unknown : angles.back(), summary.RatioLeast, summary.Ratio01,
        summary.RatioMean, summary.FaultCount, summary.Crossings })
    {
      table.back().push_back(ShortText(value));
    }
  }
  PrintTable(table);

  std::vector<LabelRow> ours;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(ours),
    [](const LabelRow& row) { return row.Run == "us" && HasSurface(row); });
  const std::size_t shown = std::min<std::size_t>(8, ours.size());
  std::partial_sort(ours.begin(), ours.begin() + shown, ours.end(),
    [](const LabelRow& a, const LabelRow& b)
    { return a.Figures.Get("Dihedral95") > b.Figures.Get("Dihedral95"); });
  ours.resize(shown);
  std::printf("\nThe least smooth of ours:\n\n");
  PrintLabelRows(ours);
}

TextRows LabelCsvRows(const std::vector<LabelRow>& rows)
{
  TextRows table(1, { "Map", "Label", "Run" });
  table[0].insert(table[0].end(), CsvColumns.begin(), CsvColumns.end());
  table[0].push_back("Failure");
  for (const LabelRow& row : rows)
  {
    table.push_back({ row.Map, LabelText(row), row.Run });
    for (const char* name : CsvColumns)
    {
      table.back().push_back(ExactText(row.Figures.Get(name)));
    }
    table.back().push_back(row.Figures.GetText("Failure"));
  }
  return table;
}

//------------------------------------------------------------------------------
TextRows LabelTargetRows(const std::vector<LabelRow>& rows)
{
  LabelTargets targets(rows);
  targets.AddOfLabels(
    "truth", "distance at vertices, voxels", "DistanceAtVertices", Bound::AtMost, 0.1);
  targets.AddOfLabels(
    "truth", "distance at centroids, voxels", "DistanceAtCentroids", Bound::AtMost, 0.1);
  targets.AddOfLabels("truth", "angle of normals, degrees", "NormalAngle", Bound::AtMost, 3.0);
  targets.AddOfLabels("truth", "error of the volume", "VolumeError", Bound::AtMost, 0.002);
  targets.AddOfLabels(
    "smooth", "dihedral angle, 95 %, degrees", "Dihedral95", Bound::AtMost, 8.0);
  targets.Add("lossless", "wrong voxels that it does not tell", "us",
    [](const LabelRow& row)
    { return HasSurface(row) ? Wrong(row) - row.Figures.Get("ReportedWrong") : Unknown; },
    Bound::AtMost, 0.0);
  targets.Add("lossless", "wrong voxels of all, %", "us",
    [](const LabelRow& row)
    { return HasSurface(row) ? 100.0 * Wrong(row) / row.Figures.Get("LabelVoxels") : Unknown; },
    Bound::AtMost, 0.0);
  targets.Add("Q1", "open, non-manifold, misoriented", "us",
    [](const LabelRow& row) { return HasSurface(row) ? Faults(row) : Unknown; }, Bound::AtMost,
    0.0);
  targets.AddOfLabels("Q1", "self-intersections", "SelfIntersections", Bound::AtMost, 0.0);
  targets.AddOfLabels(
    "Q2", "edges outside [delta, 2.5 delta]", "EdgesOutside", Bound::AtMost, 0.0);
  targets.AddOfLabels("Q2", "pairs too near", "NearPairs", Bound::AtMost, 0.0);
  targets.AddOfLabels("Q3", "radius ratio mean", "RatioMean", Bound::AtLeast, 0.97);
  targets.AddOfLabels("Q3", "radius ratio 1 % quantile", "RatioQuantile01", Bound::AtLeast, 0.80);
  targets.AddOfLabels("Q3", "radius ratio minimum", "RatioLeast", Bound::AtLeast, 0.50);
  const auto overlap = [](const char* name)
  { return [name](const LabelRow& row) { return row.Figures.Get(name); }; };
  targets.Add("overlap", "mean depth in neighbours, voxels", "us", overlap("OverlapMean"),
    Bound::AtMost, 0.05);
  targets.Add("overlap", "pairs of triangles that cross with Gap of .3 voxel", "us-gap",
    overlap("OverlapIntersections"), Bound::AtMost, 0.0);
  targets.AddTimes("remeshed");
  return targets.Rows;
}

} // namespace bench
} // namespace volumic
