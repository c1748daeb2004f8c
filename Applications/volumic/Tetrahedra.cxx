// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Tetrahedra.h"

#include "OutputFiles.h"
#include "SolidRegions.h"
#include "SurfaceFormats.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIntArray.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>
#include <unordered_map>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace tool
{
namespace
{
// ---- The program --------------------------------------------------------------------------------

/** Whether a program of this name is in the folders of PATH. */
bool IsInstalled(const std::string& program)
{
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
  {
    if (access((folder + "/" + program).c_str(), X_OK) == 0)
    {
      return true;
    }
  }
  return false;
}

/** The last lines of what a program has said, in one. */
std::string EndOf(const std::string& log)
{
  std::ifstream file(log);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);)
  {
    // gmsh frames a summary with dashes.
    if (!Trimmed(line).empty() && line.find("-----") == std::string::npos)
    {
      lines.push_back(Trimmed(line));
    }
  }
  std::string end;
  for (std::size_t i = lines.size() > 3 ? lines.size() - 3 : 0; i < lines.size(); ++i)
  {
    end += (end.empty() ? "" : "; ") + lines[i];
  }
  return Shortened(end, 400);
}

/** Run a program in a folder, until it ends or there is an interrupt. @throws Failure if it fails
 */
void RunProgram(std::vector<std::string> words, const std::string& folder, bool (*isInterrupted)())
{
  const std::string program = words.front();
  const std::string log = folder + "/log";
  std::vector<char*> pointers;
  std::transform(words.begin(), words.end(), std::back_inserter(pointers),
    [](std::string& word) { return word.data(); });
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, log.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_adddup2(&actions, 1, 2);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  // What there is after an interrupt is filled as well, unless there is a second one.
  const bool mayStop = isInterrupted && !isInterrupted();
  pid_t child = 0;
  const int error =
    posix_spawnp(&child, program.c_str(), &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  FailIf(error != 0, program + " cannot be run");
  int status = 0;
  bool isStopped = false;
  while (waitpid(child, &status, WNOHANG) == 0)
  {
    if (mayStop && !isStopped && isInterrupted())
    {
      isStopped = true;
      kill(child, SIGKILL);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  const bool isWell = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  FailIf(!isWell && mayStop && isInterrupted(),
    "interrupted while " + program + " made tetrahedra; not written");
  FailIf(!isWell,
    program + " fails (" +
      (WIFEXITED(status) ? "exit code " + std::to_string(WEXITSTATUS(status))
                         : "signal " + std::to_string(WTERMSIG(status))) +
      "): " + EndOf(log));
}

/**
 * gmsh takes volumes of a file for meshed, with or without elements: each gets one of gmsh's own
 * with the same boundary in its place, and in its physical group.
 */
const char* const OwnVolumes = R"(p() = Physical Volume{:};
For k In {0 : #p() - 1}
  v() = Physical Volume{p(k)};
  For i In {0 : #v() - 1}
    b() = Boundary{ Volume{v(i)}; };
    Delete{ Volume{v(i)}; }
    Surface Loop(v(i)) = b();
    Volume(v(i)) = {v(i)};
  EndFor
  Physical Volume(p(k)) = v();
EndFor
)";

/** @return the file, as Medit has it, whose references are the labels' numbers */
std::string RunTetgen(const SolidMaker& maker, const SurfaceFile& surface)
{
  const std::string folder = std::filesystem::path(surface.Path).parent_path().string();
  WriteSmesh({ surface.Surface, folder + "/solid.smesh", "", 0, surface.Line });
  surface.Line.Show(0.1, "");
  // p: what the triangles bound, Y: these as they are, A: with the labels, q: well-shaped, with
  // angles between faces of 8 degrees where the triangles allow that.
  const std::string volume =
    maker.Choice.MaximumVolume > 0.0 ? "a" + NumberText(maker.Choice.MaximumVolume) : std::string();
  RunProgram({ "tetgen", "-pYAq/8gNEF" + volume, "solid.smesh" }, folder, maker.IsInterrupted);
  return folder + "/solid.1.mesh";
}

std::string RunGmsh(const SolidMaker& maker, const SurfaceFile& surface)
{
  const std::string folder = std::filesystem::path(surface.Path).parent_path().string();
  WriteMsh({ surface.Surface, folder + "/solid.msh", "", 0, surface.Line });
  WriteBytes(folder + "/volumes.geo", OwnVolumes, std::char_traits<char>::length(OwnVolumes));
  surface.Line.Show(0.1, "");
  std::vector<std::string> words = { "gmsh", "-3", "solid.msh", "volumes.geo", "-o", "solid.mesh",
    "-format", "mesh", "-setnumber", "Mesh.SaveElementTagType", "2", "-v", "2" };
  if (maker.Choice.MaximumVolume > 0.0)
  {
    // The edge of a regular tetrahedron of this volume.
    words.insert(words.end(),
      { "-clmax", NumberText(std::cbrt(6.0 * std::sqrt(2.0) * maker.Choice.MaximumVolume)) });
  }
  RunProgram(words, folder, maker.IsInterrupted);
  return folder + "/solid.mesh";
}

// ---- What it has made ---------------------------------------------------------------------------

/** A place in as many digits as both programs write at least. */
std::string PlaceKey(const double* place)
{
  char text[96];
  std::snprintf(text, sizeof(text), "%.14g %.14g %.14g", place[0], place[1], place[2]);
  return text;
}

double SixfoldVolume(const std::array<Vector3, 4>& corners)
{
  return Dot(Cross(Minus(corners[1], corners[0]), Minus(corners[2], corners[0])),
    Minus(corners[3], corners[0]));
}

/**
 * The surface's points come first, in their order, and all digits of them.
 * @param numbers of the points in the file those that they get
 */
vtkSmartPointer<vtkPoints> ReadPoints(
  std::istream& file, vtkPolyData* surface, std::vector<vtkIdType>& numbers)
{
  std::unordered_map<std::string, vtkIdType> own;
  for (vtkIdType point = 0; point < surface->GetNumberOfPoints(); ++point)
  {
    own.emplace(PlaceKey(surface->GetPoint(point)), point);
  }
  vtkIdType count = 0;
  file >> count;
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  for (vtkIdType point = 0; point < surface->GetNumberOfPoints(); ++point)
  {
    points->InsertNextPoint(surface->GetPoint(point));
  }
  Vector3 place;
  std::string reference;
  for (; count > 0 && file >> place[0] >> place[1] >> place[2] >> reference; --count)
  {
    const auto found = own.find(PlaceKey(place.data()));
    numbers.push_back(found == own.end() ? points->InsertNextPoint(place.data()) : found->second);
  }
  FailIf(count > 0, "the mesher's file of nodes is cut off");
  return points;
}

/** Those of positive volume, as VTK and solvers have their corners, with their labels. */
void ReadCells(std::istream& file, vtkUnstructuredGrid* grid, const std::vector<vtkIdType>& numbers)
{
  vtkIdType count = 0;
  file >> count;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkIntArray> labels;
  labels->SetName("Label");
  std::array<vtkIdType, 4> corners;
  int label = 0;
  for (; count > 0 && file >> corners[0] >> corners[1] >> corners[2] >> corners[3] >> label;
       --count)
  {
    std::array<Vector3, 4> places;
    for (std::size_t i = 0; i < 4; ++i)
    {
      FailIf(corners[i] < 1 || corners[i] > static_cast<vtkIdType>(numbers.size()),
        "the mesher's file of tetrahedra is damaged");
      corners[i] = numbers[static_cast<std::size_t>(corners[i] - 1)];
      grid->GetPoint(corners[i], places[i].data());
    }
    if (SixfoldVolume(places) < 0.0)
    {
      std::swap(corners[2], corners[3]);
    }
    cells->InsertNextCell(4, corners.data());
    labels->InsertNextValue(label);
  }
  FailIf(count > 0, "the mesher's file of tetrahedra is cut off");
  grid->SetCells(VTK_TETRA, cells);
  grid->GetCellData()->SetScalars(labels);
}

vtkSmartPointer<vtkUnstructuredGrid> ReadMedit(const std::string& name, vtkPolyData* surface)
{
  std::ifstream file(name);
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  std::vector<vtkIdType> numbers;
  for (std::string word; file >> word;)
  {
    if (word[0] == '#')
    {
      std::getline(file, word);
    }
    else if (word == "Vertices")
    {
      grid->SetPoints(ReadPoints(file, surface, numbers));
    }
    else if (word == "Tetrahedra" && grid->GetPoints())
    {
      ReadCells(file, grid, numbers);
    }
  }
  FailIf(grid->GetNumberOfCells() == 0, "the mesher has made no tetrahedra");
  return grid;
}

std::array<std::set<vtkIdType>, 6> FindBoxNodes(vtkPolyData* surface)
{
  std::array<std::set<vtkIdType>, 6> nodes;
  vtkDataArray* faces = surface->GetCellData()->GetArray("BoxFace");
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; faces && cell < surface->GetNumberOfCells(); ++cell)
  {
    const auto face = static_cast<std::size_t>(faces->GetTuple1(cell));
    surface->GetCellPoints(cell, corners);
    for (vtkIdType k = 0; face > 0 && k < corners->GetNumberOfIds(); ++k)
    {
      nodes[face - 1].insert(corners->GetId(k));
    }
  }
  return nodes;
}

/** The least angle between two faces, degrees. */
double LeastAngleOf(const std::array<Vector3, 4>& corners)
{
  // The faces that meet at the edge of the last two lead to the first two.
  static const std::size_t edges[6][4] = { { 0, 1, 2, 3 }, { 0, 2, 1, 3 }, { 0, 3, 1, 2 },
    { 1, 2, 0, 3 }, { 1, 3, 0, 2 }, { 2, 3, 0, 1 } };
  double most = -1.0; // cosine
  for (const auto& [i, j, a, b] : edges)
  {
    const Vector3 edge = Minus(corners[b], corners[a]);
    const Vector3 m = Cross(edge, Minus(corners[i], corners[a]));
    const Vector3 n = Cross(edge, Minus(corners[j], corners[a]));
    most = std::max(most, Dot(m, n) / std::sqrt(Dot(m, m) * Dot(n, n)));
  }
  return vtkMath::DegreesFromRadians(std::acos(std::clamp(most, -1.0, 1.0)));
}

void Measure(Solid& solid)
{
  std::vector<double> angles;
  const auto* labels =
    vtkIntArray::SafeDownCast(solid.Grid->GetCellData()->GetScalars())->GetPointer(0);
  vtkIdType count = 0;
  const vtkIdType* corners = nullptr;
  for (vtkIdType cell = 0; cell < solid.Grid->GetNumberOfCells(); ++cell)
  {
    solid.Grid->GetCellPoints(cell, count, corners);
    std::array<Vector3, 4> places;
    for (std::size_t i = 0; i < 4; ++i)
    {
      solid.Grid->GetPoint(corners[i], places[i].data());
    }
    Solid::Region& region = solid.Regions[labels[cell]];
    ++region.Tetrahedra;
    region.Volume += SixfoldVolume(places) / 6.0;
    angles.push_back(LeastAngleOf(places));
  }
  const auto percent = angles.begin() + static_cast<std::ptrdiff_t>(angles.size() / 100);
  std::nth_element(angles.begin(), percent, angles.end());
  solid.PercentAngle = *percent;
  solid.LeastAngle = *std::min_element(angles.begin(), percent + 1);
}
}

bool NeedsMesher(const std::string& name, const SolidChoice& choice)
{
  const std::string suffix = SuffixOf(name);
  return suffix == ".vtu" || suffix == ".inp" || (suffix == ".msh" && !choice.Mesher.empty());
}

std::string FindMesher(const SolidChoice& choice)
{
  for (const char* program : { "tetgen", "gmsh" })
  {
    if ((choice.Mesher.empty() || choice.Mesher == program) && IsInstalled(program))
    {
      return program;
    }
  }
  throw Failure(choice.Mesher.empty()
      ? "tetrahedra are made by TetGen or gmsh, none of which is installed (Debian: apt install "
        "tetgen)"
      : choice.Mesher + " is not installed (Debian: apt install " + choice.Mesher + ")");
}

const Solid& SolidMaker::Make(vtkPolyData* surface, const std::string& beside, ProgressLine& line)
{
  if (this->Surface == surface)
  {
    return this->Made;
  }
  this->Surface = nullptr;
  Solid solid;
  solid.Mesher = FindMesher(this->Choice);
  const StagedFiles work(std::filesystem::path(beside).parent_path().string());
  const SurfaceFile file{ surface, work.Folder() + "/solid", "", 0, line };
  solid.Grid =
    ReadMedit(solid.Mesher == "gmsh" ? RunGmsh(*this, file) : RunTetgen(*this, file), surface);
  solid.Grid->GetFieldData()->ShallowCopy(surface->GetFieldData());
  const std::vector<SurfaceLabel> labels = LabelledTriangles(surface).Labels;
  const std::vector<int> numbers = SolidNumbers(labels);
  for (std::size_t i = 0; i < labels.size(); ++i)
  {
    solid.Names[numbers[i]] = labels[i].Name;
  }
  solid.BoxNodes = FindBoxNodes(surface);
  Measure(solid);
  for (const auto& [number, name] : solid.Names)
  {
    FailIf(solid.Regions.count(number) == 0, solid.Mesher + " has left out " + name);
  }
  this->Made = std::move(solid);
  this->Surface = surface;
  return this->Made;
}
}
