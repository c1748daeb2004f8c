// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * vtkLabelsToSurfaces and its peers, side by side: on digitised shapes, whose surfaces are known,
 * on label maps, on labels made of a scan, and on a map with the size of a body. Figures go to the
 * standard output, "@row MAP<tab>LABEL<tab>RUN" before them: benchmark_labels.py, which starts this
 * program with options that it has checked, makes tables of them. See LabelPeers.h for the peers.
 *
 * Ours is run on the whole map, and by itself on each label, cut out with some voxels about it;
 * peers have each label cut out, too, which makes them faster than they are on the whole map. All
 * runs are of one process; seconds are those of the processor, of one thread unless --threads says
 * else. Times of ours alone, and of the remeshed peer, are what the target of time compares.
 */

#include "LabelBenchmarkOptions.h"
#include "LabelMaps.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

using namespace volumic::bench;
using volumic::support::LabelMap;
using volumic::support::LabelShape;

namespace
{

constexpr double GapOfTarget = 0.3;

/** The label of a row that is about all of them together. */
constexpr int AllLabels = -100000;

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
  Runs(const Subject& subject, const LabelBenchmarkOptions& options)
    : Of(subject), Options(options)
  {
  }

  void Make()
  {
    this->MakeTogether("us", 0.0);
    this->MakeTogether("us-gap", GapOfTarget);
    for (const std::string& run : LabelRunNames())
    {
      if (run != "us" && run != "us-gap" && this->IsWanted(run))
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
  bool IsWanted(const std::string& run) const
  {
    const std::vector<std::string>& runs = this->Options.Runs;
    return runs.empty() || std::count(runs.begin(), runs.end(), run) > 0;
  }

  /** Failures are told and are rows, too. */
  void Try(int label, const std::string& run, const std::function<void(RunFigures&)>& work)
  {
    RunFigures figures;
    try
    {
      work(figures);
    }
    catch (const std::exception& error)
    {
      figures.SetText("Failure", error.what());
      std::fprintf(stderr, "%s %d %s failed: %s\n", this->Of.Name.c_str(), label, run.c_str(),
        error.what());
    }
    std::cout << "@row " << this->Of.Name << '\t'
              << (label == AllLabels ? "all" : std::to_string(label)) << '\t' << run << '\n';
    figures.Write(std::cout);
  }

  void Judge(const LabelSurface& surface, RunFigures& figures)
  {
    const LabelMap about = CropToLabel(this->Of.Map, surface.Label, 4);
    SetLabelVerdict(surface, about, this->Of.ShapeOf(surface.Label), figures);
    this->EdgeLengths[surface.Label] = figures.Get("EdgeMean") * this->Of.Map.ShortestSpacing();
  }

  void MakeTogether(const std::string& run, double gap)
  {
    const bool isCompared = run == "us" && this->IsWanted("remeshed");
    if (!this->IsWanted(run) && !isCompared)
    {
      return;
    }
    std::fprintf(stderr, "%s %s\n", this->Of.Name.c_str(), run.c_str());
    std::vector<LabelSurface> surfaces;
    this->Try(AllLabels, run,
      [&](RunFigures& figures)
      {
        LabelSettings settings = this->Options.Settings;
        settings.Gap = gap;
        surfaces = OurSurfaces(this->Of.Map, this->Of.Labels, settings, figures);
        SetOverlap(surfaces, this->Of.Map.ShortestSpacing(), figures);
      });
    for (const LabelSurface& surface : surfaces)
    {
      this->Try(surface.Label, run,
        [&](RunFigures& figures) { this->Judge(surface, figures); });
    }
  }

  void MakeAlone(const std::string& run, int label)
  {
    this->Try(label, run,
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
        std::ostringstream words;
        words << name << ' ' << size;
        if (stretch > 1.0)
        {
          words << " 1:" << stretch;
        }
        subject.Name = words.str();
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
    throw std::invalid_argument(subject.Name + " has none of these labels, or too few voxels of them");
  }
  const std::array<int, 3>& size = subject.Map.Size;
  std::printf("%s: %d x %d x %d voxels, %zu labels; %d smaller ones left out\n\n",
    subject.Name.c_str(), size[0], size[1], size[2], subject.Labels.size(), left);
  std::fflush(stdout);
  return subject;
}

//------------------------------------------------------------------------------
std::vector<std::string> Words(const std::string& text)
{
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, ',');)
  {
    words.push_back(word);
  }
  return words;
}

std::vector<double> Numbers(const std::string& text)
{
  std::vector<double> numbers;
  for (const std::string& word : Words(text))
  {
    numbers.push_back(std::stod(word));
  }
  return numbers;
}

std::vector<int> Integers(const std::string& text)
{
  const std::vector<double> numbers = Numbers(text);
  return { numbers.begin(), numbers.end() };
}

/** @throws std::invalid_argument for a name that is not known in this build. */
std::vector<std::string> Names(const std::string& text, const std::vector<std::string>& known)
{
  const std::vector<std::string> names = Words(text);
  for (const std::string& name : names)
  {
    if (std::count(known.begin(), known.end(), name) == 0)
    {
      std::string all;
      for (const std::string& one : known)
      {
        all += (all.empty() ? "" : ", ") + one;
      }
      throw std::invalid_argument("no \"" + name + "\" in this build; there are " + all);
    }
  }
  return names;
}

std::vector<std::string> ShapeNames()
{
  std::vector<std::string> names;
  for (const auto kind : volumic::support::AllLabelShapeKinds())
  {
    names.push_back(volumic::support::LabelShapeName(kind));
  }
  return names;
}

LabelBenchmarkOptions ParseOptions(int argc, char** argv)
{
  LabelBenchmarkOptions o;
  using Text = const std::string&;
  const std::map<std::string, std::function<void(Text)>> takers = {
    { "--map", [&o](Text text) { o.Map = text; } },
    { "--mask", [&o](Text text) { o.Mask = text == "1"; } },
    { "--scan", [&o](Text text) { o.Scan = text; } },
    { "--thresholds", [&o](Text text) { o.Thresholds = Numbers(text); } },
    { "--body",
      [&o](Text text)
      {
        const std::vector<int> size = Integers(text);
        std::copy_n(size.begin(), 3, o.Body.begin());
      } },
    { "--body-labels", [&o](Text text) { o.BodyLabels = std::stoi(text); } },
    { "--shapes", [&o](Text text) { o.Shapes = Names(text, ShapeNames()); } },
    { "--sizes", [&o](Text text) { o.Sizes = Integers(text); } },
    { "--stretches", [&o](Text text) { o.Stretches = Numbers(text); } },
    { "--labels", [&o](Text text) { o.Labels = Integers(text); } },
    { "--least", [&o](Text text) { o.LeastVoxels = std::stoi(text); } },
    { "--runs", [&o](Text text) { o.Runs = Names(text, LabelRunNames()); } },
    { "--threads", [&o](Text text) { o.Settings.Threads = std::stoi(text); } },
    { "--repetitions", [&o](Text text) { o.Settings.Repetitions = std::stoi(text); } },
    { "--finest", [&o](Text text) { o.Settings.FinestLevel = std::stoi(text); } },
    { "--smoothing", [&o](Text text) { o.Settings.Smoothing = std::stod(text); } },
    { "--voxel-tolerance", [&o](Text text) { o.Settings.VoxelTolerance = std::stod(text); } },
  };
  for (int i = 1; i < argc; i += 2)
  {
    if (takers.count(argv[i]) == 0 || i + 1 == argc)
    {
      throw std::invalid_argument(std::string("no option, or one without a value: ") + argv[i]);
    }
    takers.at(argv[i])(argv[i + 1]);
  }
  return o;
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    const LabelBenchmarkOptions options = ParseOptions(argc, argv);
    vtkSMPTools::Initialize(1);
    const std::vector<Subject> subjects = options.IsOfShapes()
      ? ShapesToMeasure(options)
      : std::vector<Subject>(1, MapToMeasure(options));
    for (const Subject& subject : subjects)
    {
      Runs(subject, options).Make();
    }
    return 0;
  }
  catch (const std::invalid_argument& error)
  {
    std::cerr << "BenchmarkLabels: " << error.what()
              << "\nbenchmark_labels.py --help tells of the options." << std::endl;
    return 2;
  }
  catch (const std::exception& error)
  {
    std::cerr << "BenchmarkLabels: " << error.what() << std::endl;
    return 1;
  }
}
