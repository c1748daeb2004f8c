// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * vtkLabelsToSurfaces and its peers, side by side: on digitised shapes, whose surfaces are known,
 * on label maps, on labels made of a scan, and on a map with the size of a body. See
 * LabelBenchmarkUsage for the command line, LabelPeers.h for the peers.
 *
 * Ours is run on the whole map, and by itself on each label, cut out with some voxels about it;
 * peers have each label cut out, too, which makes them faster than they are on the whole map. All
 * runs are of one process; seconds are those of the processor, of one thread unless --threads says
 * else. Times of ours alone, and of the remeshed peer, are what the target of time compares.
 */

#include "LabelBenchmarkOptions.h"
#include "LabelMaps.h"
#include "LabelTables.h"
#include "SurfaceBenchmarkOptions.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <map>

using namespace volumic::bench;
using volumic::support::LabelMap;
using volumic::support::LabelShape;

namespace
{

constexpr double GapOfTarget = 0.3;

/** A map, its labels to be measured, and their shapes where these are known. */
struct Subject
{
  std::string Name;
  LabelMap Map;
  std::vector<int> Labels;
  std::map<int, LabelShape> Shapes;

  const LabelShape* ShapeOf(int label) const
  {
    const auto found = this->Shapes.find(label);
    return found == this->Shapes.end() ? nullptr : &found->second;
  }
};

class Runs
{
public:
  Runs(const Subject& subject, const LabelBenchmarkOptions& options, std::vector<LabelRow>& rows)
    : Of(subject), Options(options), Rows(rows)
  {
  }

  void Make()
  {
    this->MakeTogether("us", 0.0);
    this->MakeTogether("us-gap", GapOfTarget);
    for (const std::string& run : LabelRunNames())
    {
      if (run != "us" && run != "us-gap" && this->Options.Has(run))
      {
        std::fprintf(stderr, "%s %s\n", this->Of.Name.c_str(), run.c_str());
        for (const int label : this->Of.Labels)
        {
          this->MakeAlone(run, label);
        }
      }
    }
  }

private:
  /** Failures are told and are rows, too. */
  void Try(LabelRow row, const std::function<void(RunFigures&)>& work)
  {
    try
    {
      work(row.Figures);
    }
    catch (const std::exception& error)
    {
      row.Figures.SetText("Failure", error.what());
      std::fprintf(stderr, "%s %d %s failed: %s\n", row.Map.c_str(), row.Label, row.Run.c_str(),
        error.what());
    }
    this->Rows.push_back(row);
  }

  void Judge(const LabelSurface& surface, RunFigures& figures)
  {
    const LabelMap about = CropToLabel(this->Of.Map, surface.Label, 4);
    SetLabelVerdict(surface, about, this->Of.ShapeOf(surface.Label), figures);
    this->EdgeLengths[surface.Label] = figures.Get("EdgeMean") * this->Of.Map.ShortestSpacing();
  }

  void MakeTogether(const std::string& run, double gap)
  {
    const bool isCompared = run == "us" && this->Options.Has("remeshed");
    if (!this->Options.Has(run) && !isCompared)
    {
      return;
    }
    std::fprintf(stderr, "%s %s\n", this->Of.Name.c_str(), run.c_str());
    std::vector<LabelSurface> surfaces;
    this->Try({ this->Of.Name, LabelRow::AllLabels, run, {} },
      [&](RunFigures& figures)
      {
        LabelSettings settings = this->Options.Settings;
        settings.Gap = gap;
        surfaces = OurSurfaces(this->Of.Map, this->Of.Labels, settings, figures);
        SetOverlap(surfaces, this->Of.Map.ShortestSpacing(), figures);
      });
    for (const LabelSurface& surface : surfaces)
    {
      this->Try({ this->Of.Name, surface.Label, run, {} },
        [&](RunFigures& figures) { this->Judge(surface, figures); });
    }
  }

  void MakeAlone(const std::string& run, int label)
  {
    this->Try({ this->Of.Name, label, run, {} },
      [&](RunFigures& figures)
      {
        const double edge = this->EdgeLengths.count(label) ? this->EdgeLengths[label] : 0.0;
        const LabelSurface surface = SurfaceAlone(run, this->Of.Map, label,
          edge > 0.0 ? edge : this->Of.Map.ShortestSpacing(), this->Options.Settings, figures);
        const std::map<int, double> before = this->EdgeLengths;
        this->Judge(surface, figures);
        this->EdgeLengths = before;
      });
  }

  const Subject& Of;
  const LabelBenchmarkOptions& Options;
  std::vector<LabelRow>& Rows;
  std::map<int, double> EdgeLengths; ///< of us, world; what the remeshed peer is told
};

//------------------------------------------------------------------------------
std::vector<Subject> ShapesToMeasure(const LabelBenchmarkOptions& options)
{
  std::vector<Subject> subjects;
  for (const auto kind : volumic::support::AllLabelShapeKinds())
  {
    const std::string name = volumic::support::LabelShapeName(kind);
    if (!options.Shapes.empty() &&
      std::count(options.Shapes.begin(), options.Shapes.end(), name) == 0)
    {
      continue;
    }
    for (const int size : options.Sizes)
    {
      for (const double stretch : options.Stretches)
      {
        Subject subject;
        volumic::support::DigitisedShapes shapes = Digitise(kind, size, stretch);
        subject.Name = name + " " + std::to_string(size) + (stretch > 1.0 ? " 1:" : "") +
          (stretch > 1.0 ? ShortText(stretch) : "");
        subject.Map = std::move(shapes.Map);
        for (const LabelShape& shape : shapes.Shapes)
        {
          subject.Labels.push_back(shape.Label);
          subject.Shapes[shape.Label] = shape;
        }
        subjects.push_back(std::move(subject));
      }
    }
  }
  return subjects;
}

Subject MapToMeasure(const LabelBenchmarkOptions& options)
{
  Subject subject;
  if (!options.Scan.empty())
  {
    subject.Name = options.Scan.substr(options.Scan.rfind('/') + 1);
    subject.Map = LabelsOfScan(options.Scan, options.Thresholds);
  }
  else if (!options.Map.empty())
  {
    subject.Name = options.Map.substr(options.Map.rfind('/') + 1);
    subject.Map = ReadLabelMap(options.Map);
    subject.Map = options.Mask ? MaskOf(std::move(subject.Map)) : std::move(subject.Map);
  }
  else
  {
    subject.Name = "body";
    subject.Map = volumic::support::MakeBodyMap(options.Body, options.BodyLabels);
  }
  int left = 0;
  for (const auto& [label, voxels] : CountLabels(subject.Map))
  {
    const bool isAsked = options.Labels.empty() ||
      std::count(options.Labels.begin(), options.Labels.end(), label) > 0;
    if (isAsked && voxels >= options.LeastVoxels)
    {
      subject.Labels.push_back(label);
    }
    left += isAsked && voxels < options.LeastVoxels;
  }
  if (subject.Labels.empty())
  {
    throw UsageError(subject.Name + " has none of these labels, or too few voxels of them");
  }
  const std::array<int, 3>& size = subject.Map.Size;
  std::printf("%s: %d x %d x %d voxels, %zu labels; %d smaller ones left out\n\n",
    subject.Name.c_str(), size[0], size[1], size[2], subject.Labels.size(), left);
  std::fflush(stdout);
  return subject;
}

void PrintTogether(const std::vector<LabelRow>& rows)
{
  std::printf("\nAll labels together:\n\n");
  TextRows table(1,
    { "map", "run", "s of the clock", "processor s", "MB", "neighbours", "vertices inside",
      "mean depth", "largest", "crossing" });
  for (const LabelRow& row : rows)
  {
    if (row.Label == LabelRow::AllLabels)
    {
      table.push_back({ row.Map, row.Run });
      for (const char* name :
        { "Seconds", "ProcessorSeconds", "PeakMegabytes", "OverlapPairs", "OverlapVertices",
          "OverlapMean", "OverlapLargest", "OverlapIntersections" })
      {
        table.back().push_back(ShortText(row.Figures.Get(name)));
      }
    }
  }
  PrintTable(table, 2);
}

int Main(int argc, char** argv)
{
  const LabelBenchmarkOptions options = ParseLabelOptions(argc, argv);
  if (options.Help)
  {
    std::printf("%s", LabelBenchmarkUsage);
    return 0;
  }
  vtkSMPTools::Initialize(1);
  std::vector<LabelRow> rows;
  const std::vector<Subject> subjects = options.IsOfShapes()
    ? ShapesToMeasure(options)
    : std::vector<Subject>(1, MapToMeasure(options));
  for (const Subject& subject : subjects)
  {
    Runs(subject, options, rows).Make();
  }
  if (options.IsOfShapes())
  {
    PrintLabelRows(rows);
  }
  else
  {
    PrintLabelSummary(rows);
  }
  PrintTogether(rows);
  const TextRows targets = LabelTargetRows(rows);
  std::printf("\nTargets (the worst of us):\n\n");
  PrintTable(targets, 2);
  if (!options.Csv.empty())
  {
    WriteCsv(options.Csv, LabelCsvRows(rows));
    WriteCsv(CsvNameOf(options.Csv, "targets"), targets);
  }
  const bool isMade = std::all_of(rows.begin(), rows.end(),
    [](const LabelRow& row) { return row.Figures.GetText("Failure").empty(); });
  return isMade ? 0 : 1;
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    return Main(argc, argv);
  }
  catch (const UsageError& error)
  {
    std::cerr << "BenchmarkLabels: " << error.what() << "\nTry --help." << std::endl;
    return 2;
  }
  catch (const std::exception& error)
  {
    std::cerr << "BenchmarkLabels: " << error.what() << std::endl;
    return 1;
  }
}
