// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SurfaceTables.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <sstream>

namespace volumic
{
namespace bench
{
namespace
{

struct Figure
{
  const char* Name;
  const char* Title;
  int Digits = 3;
};

const std::vector<Figure> CostFigures = {
  { "WallSeconds", "seconds" },
  { "ProcessorSeconds", "processor seconds" },
  { "WallRatio", "seconds / us-1" },
  { "ProcessorRatio", "processor seconds / us-1" },
  { "PyramidSeconds", "of these the pyramid" },
  { "BaseMegabytes", "MB before", 4 },
  { "PeakMegabytes", "MB at the peak", 4 },
  { "CoarsestLevel", "coarsest level" },
  { "Iterations", "iterations" },
  { "MicrosecondsPerVertexIteration", "us / vertex, iteration" },
};

const std::vector<Figure> LevelCostFigures = {
  { "Iterations", "iterations" },
  { "Seconds", "seconds" },
  { "VertexIterations", "vertices x iterations" },
  { "MicrosecondsPerVertexIteration", "us / vertex, iteration" },
  { "LostParts", "lost parts" },
  { "RecoveredParts", "recovered parts" },
  { "Delta", "delta" },
};

const std::vector<Figure> QualityFigures = {
  { "Vertices", "vertices" },
  { "Triangles", "triangles" },
  { "Components", "components" },
  { "Genus", "genus" },
  { "GenusOfLargest", "genus of the largest" },
  { "OpenEdges", "open edges" },
  { "NonManifold", "not manifold" },
  { "MisorientedEdges", "misoriented edges" },
  { "SelfIntersections", "self-intersections" },
  { "EdgeShortest", "edge min" },
  { "EdgeMean", "edge mean" },
  { "EdgeLongest", "edge max" },
  { "EdgesOutside", "edges outside bounds" },
  { "NearPairs", "pairs too near" },
  { "RatioLeast", "radius ratio min" },
  { "RatioQuantile01", "radius ratio p01" },
  { "RatioMean", "radius ratio mean", 4 },
  { "DistanceAtVertices", "distance at vertices" },
  { "DistanceAtCentroids", "distance at centroids" },
  { "Reach", "share reached", 4 },
  { "VoxelsRatioLeast", "voxels: radius ratio min" },
  { "VoxelsRatioQuantile01", "voxels: radius ratio p01" },
  { "VoxelsRatioMean", "voxels: radius ratio mean", 4 },
  { "VoxelsDistanceAtVertices", "voxels: distance at vertices" },
  { "VoxelsDistanceAtCentroids", "voxels: distance at centroids" },
  { "WorldRatioLeast", "world: radius ratio min" },
  { "WorldRatioQuantile01", "world: radius ratio p01" },
  { "WorldRatioMean", "world: radius ratio mean", 4 },
  { "WorldDistanceAtVertices", "world: distance at vertices" },
  { "WorldDistanceAtCentroids", "world: distance at centroids" },
};

/** In the CSV only. */
const std::vector<Figure> MoreFigures = {
  { "Volume", "" },
  { "Outward", "" },
  { "FlatTriangles", "" },
  { "EdgesTooShort", "" },
  { "EdgesTooLong", "" },
  { "Voxels", "" },
};

std::vector<Figure> Joined(const std::vector<Figure>& a, const std::vector<Figure>& b)
{
  std::vector<Figure> all = a;
  all.insert(all.end(), b.begin(), b.end());
  return all;
}

int LevelsOf(const RunFigures& ours)
{
  return ours.Has("Levels") ? static_cast<int>(ours.Get("Levels")) : 0;
}

double SumOverLevels(const RunFigures& ours, const std::string& name)
{
  double sum = 0.0;
  for (int h = 0; h < LevelsOf(ours); ++h)
  {
    sum += ours.Get(RunFigures::Indexed("level", h, name));
  }
  return sum;
}

/** Forces of ForcesSeconds. */
std::string WithoutSeconds(const std::string& phase)
{
  return phase.substr(0, phase.size() - std::string("Seconds").size());
}

} // namespace

//------------------------------------------------------------------------------
const SurfaceRunResult* FindRun(const std::vector<SurfaceRunResult>& runs, const std::string& name)
{
  for (const SurfaceRunResult& run : runs)
  {
    if (run.Name == name && run.Figures.GetText("Failure").empty())
    {
      return &run;
    }
  }
  return nullptr;
}

void PrintTable(const TextRows& rows, std::size_t leftColumns)
{
  std::vector<std::size_t> widths;
  for (const auto& row : rows)
  {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t c = 0; c < row.size(); ++c)
    {
      widths[c] = std::max(widths[c], row[c].size());
    }
  }
  for (std::size_t r = 0; r < rows.size(); ++r)
  {
    std::string line;
    for (std::size_t c = 0; c < rows[r].size(); ++c)
    {
      const std::string blanks(widths[c] - rows[r][c].size(), ' ');
      line += c == 0 ? "" : "  ";
      line += c < leftColumns ? rows[r][c] + blanks : blanks + rows[r][c];
    }
    std::printf("%s\n", line.c_str());
    if (r == 0)
    {
      std::printf("%s\n", std::string(line.size(), '-').c_str());
    }
  }
}

void AddDerivedFigures(std::vector<SurfaceRunResult>& runs)
{
  const SurfaceRunResult* found = FindRun(runs, "us-1");
  const RunFigures us = found ? found->Figures : RunFigures();
  const auto addOutside = [](RunFigures& figures, const std::string& prefix)
  {
    figures.Set(prefix + "EdgesOutside",
      figures.Get(prefix + "EdgesTooShort") + figures.Get(prefix + "EdgesTooLong"));
  };
  for (SurfaceRunResult& run : runs)
  {
    RunFigures& figures = run.Figures;
    figures.Set("WallRatio", figures.Get("WallSeconds") / us.Get("WallSeconds"));
    figures.Set("ProcessorRatio", figures.Get("ProcessorSeconds") / us.Get("ProcessorSeconds"));
    figures.Set("MicrosecondsPerVertexIteration",
      1e6 * figures.Get("ProcessorSeconds") / figures.Get("VertexIterations"));
    addOutside(figures, "");
    for (int h = 0; h < LevelsOf(figures); ++h)
    {
      const std::string prefix = RunFigures::Indexed("level", h, "");
      figures.Set(prefix + "MicrosecondsPerVertexIteration",
        1e6 * figures.Get(prefix + "Seconds") / figures.Get(prefix + "VertexIterations"));
      addOutside(figures, prefix);
    }
  }
}

//------------------------------------------------------------------------------
void PrintRuns(const std::vector<SurfaceRunResult>& runs)
{
  TextRows rows(1, { "" });
  for (const SurfaceRunResult& run : runs)
  {
    rows[0].push_back(run.Figures.GetText("Failure").empty() ? run.Name : run.Name + " FAILED");
  }
  for (const Figure& figure : Joined(CostFigures, QualityFigures))
  {
    std::vector<std::string> row(1, figure.Title);
    for (const SurfaceRunResult& run : runs)
    {
      row.push_back(ShortText(run.Figures.Get(figure.Name), figure.Digits));
    }
    rows.push_back(row);
  }
  PrintTable(rows);
}

TextRows RunRows(const std::vector<SurfaceRunResult>& runs)
{
  const std::vector<Figure> figures = Joined(Joined(CostFigures, QualityFigures), MoreFigures);
  TextRows rows(1, { "Run" });
  for (const Figure& figure : figures)
  {
    rows[0].push_back(figure.Name);
  }
  rows[0].insert(rows[0].end(), { "StopReason", "Fingerprint", "Failure" });
  for (const SurfaceRunResult& run : runs)
  {
    std::vector<std::string> row(1, run.Name);
    for (const Figure& figure : figures)
    {
      row.push_back(ExactText(run.Figures.Get(figure.Name)));
    }
    for (const char* text : { "StopReason", "Fingerprint", "Failure" })
    {
      row.push_back(run.Figures.GetText(text));
    }
    rows.push_back(row);
  }
  return rows;
}

//------------------------------------------------------------------------------
void PrintLevels(const RunFigures& ours)
{
  TextRows rows(1, { "us-1" });
  for (int h = LevelsOf(ours) - 1; h >= 0; --h)
  {
    rows[0].push_back("level " + std::to_string(h));
  }
  for (const Figure& figure : Joined(LevelCostFigures, QualityFigures))
  {
    std::vector<std::string> row(1, figure.Title);
    for (int h = LevelsOf(ours) - 1; h >= 0; --h)
    {
      row.push_back(
        ShortText(ours.Get(RunFigures::Indexed("level", h, figure.Name)), figure.Digits));
    }
    rows.push_back(row);
  }
  PrintTable(rows);
}

TextRows LevelRows(const RunFigures& ours)
{
  std::vector<std::string> names;
  for (const Figure& figure : Joined(LevelCostFigures, QualityFigures))
  {
    names.push_back(figure.Name);
  }
  std::vector<std::string> phases = PhasesOf(ours);
  if (!phases.empty())
  {
    phases.insert(phases.end(), PartsBetweenIterations.begin(), PartsBetweenIterations.end());
  }
  names.insert(names.end(), phases.begin(), phases.end());
  std::transform(phases.begin(), phases.end(), std::back_inserter(names), SerialOf);
  TextRows rows(1, { "Level" });
  rows[0].insert(rows[0].end(), names.begin(), names.end());
  for (int h = 0; h < LevelsOf(ours); ++h)
  {
    std::vector<std::string> row(1, std::to_string(h));
    for (const std::string& name : names)
    {
      row.push_back(ExactText(ours.Get(RunFigures::Indexed("level", h, name))));
    }
    rows.push_back(row);
  }
  return rows;
}

//------------------------------------------------------------------------------
std::vector<std::string> PhasesOf(const RunFigures& ours)
{
  std::vector<std::string> names;
  std::istringstream stream(ours.GetText("Phases"));
  for (std::string name; std::getline(stream, name, ',');)
  {
    names.push_back(name);
  }
  return names;
}

std::string SerialOf(const std::string& phase)
{
  return WithoutSeconds(phase) + "SerialSeconds";
}

void PrintProfile(const RunFigures& ours)
{
  const double all = ours.Get("WallSeconds");
  TextRows rows(1, { "phase", "level", "seconds", "share", "serial", "us / vertex, iteration" });
  const auto add = [&](const std::string& phase, const std::string& level, double seconds,
                     const std::string& serial, double vertexIterations)
  {
    rows.push_back({ phase, level, ShortText(seconds), ShortText(100.0 * seconds / all) + " %",
      serial, vertexIterations > 0.0 ? ShortText(1e6 * seconds / vertexIterations) : "-" });
  };
  const auto addLevel = [&](int h, const std::string& phase, const std::string& what)
  {
    const auto get = [&](const std::string& name)
    { return ours.Get(RunFigures::Indexed("level", h, name)); };
    add(what + WithoutSeconds(phase), std::to_string(h), get(phase),
      ShortText(get(SerialOf(phase))), get("VertexIterations"));
  };
  const std::vector<std::string> phases = PhasesOf(ours);
  double insideIterations = 0.0, betweenIterations = 0.0, restOfAll = 0.0;
  for (int h = LevelsOf(ours) - 1; h >= 0; --h)
  {
    const auto get = [&](const std::string& name)
    { return ours.Get(RunFigures::Indexed("level", h, name)); };
    double rest = get("Seconds");
    insideIterations += rest;
    for (const std::string& phase : phases)
    {
      addLevel(h, phase, "");
      const bool isBetween = phase == BetweenIterations;
      betweenIterations += isBetween ? get(phase) : 0.0;
      rest -= isBetween ? 0.0 : get(phase);
    }
    for (const char* part : PartsBetweenIterations)
    {
      addLevel(h, part, "  of this ");
    }
    add("rest of the iterations", std::to_string(h), rest, "", get("VertexIterations"));
    restOfAll += rest;
  }
  const double vertexIterations = ours.Get("VertexIterations");
  for (const std::string& phase : phases)
  {
    add(WithoutSeconds(phase), "all", SumOverLevels(ours, phase),
      ShortText(SumOverLevels(ours, SerialOf(phase))), vertexIterations);
  }
  for (const std::string part : PartsBetweenIterations)
  {
    add("  of this " + WithoutSeconds(part), "all", SumOverLevels(ours, part),
      ShortText(SumOverLevels(ours, SerialOf(part))), vertexIterations);
  }
  add("rest of the iterations", "all", restOfAll, "", vertexIterations);
  const double pyramid = ours.Get("PyramidSeconds");
  add("pyramid", "all", pyramid, "", vertexIterations);
  add("voxels, output", "all", all - pyramid - insideIterations - betweenIterations, "",
    vertexIterations);
  PrintTable(rows);
}

} // namespace bench
} // namespace volumic
