// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceCrossings.h"

#include "Core/Common/Sort.h"
#include "Core/Common/Spans.h"
#include "Core/Interfaces/InterfaceClearance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace volumic
{
namespace
{
constexpr std::size_t SpanSize = 2048;
/** Edge length of a cube, in mean box sizes of the faces. */
constexpr float CubeInFaces = 2.f;
constexpr int MostCubes = 1 << 20; ///< along an axis

class CrossingFinder
{
public:
  CrossingFinder(const InterfaceMesh& mesh, double tolerance, Executor& executor)
    : Mesh(mesh), Tolerance(tolerance), Threads(executor)
  {
  }

  InterfaceCrossings Find()
  {
    this->SetUpCubes();
    const std::vector<std::vector<int>> layers = this->FindFacesOfLayers();
    std::vector<std::vector<std::array<int, 2>>> pairs(layers.size());
    std::vector<std::vector<int>> candidates(pairs.size());
    ForSpans(this->Threads, layers.size(), 1,
      [&](std::size_t layer, std::size_t, std::size_t) {
        this->TestLayer(static_cast<int>(layer), layers[layer], pairs[layer], candidates[layer]);
      });
    InterfaceCrossings found;
    found.Pairs = Joined(this->Threads, pairs);
    found.Candidates = Joined(this->Threads, candidates);
    Sort(this->Threads, found.Candidates);
    found.Candidates.erase(
      std::unique(found.Candidates.begin(), found.Candidates.end()), found.Candidates.end());
    return found;
  }

private:
  Box BoxOf(int face) const
  {
    const std::array<int, 3>& v = this->Mesh.Faces[static_cast<std::size_t>(face)].Vertex;
    const Vector* at = this->Mesh.Position.data();
    Box box = Box::Of(at[v[0]], at[v[1]], at[v[2]]);
    const auto thick = static_cast<float>(this->Tolerance);
    box.High += Vector(thick, thick, thick);
    return box;
  }

  void SetUpCubes()
  {
    const FaceBoxes boxes = FindBoxes(
      this->Mesh, SpanSize, this->Threads, [this](int face) { return this->BoxOf(face); });
    this->Low = boxes.All.Low;
    this->PerCube = 1.f /
      std::max({ 1e-6f, CubeInFaces * static_cast<float>(boxes.MeanSide()),
        LongestSide(boxes.All) / static_cast<float>(MostCubes) });
    const std::array<int, 3> last = this->CubeOf(boxes.All.High);
    this->Count = { last[0] + 1, last[1] + 1, last[2] + 1 };
  }

  std::array<int, 3> CubeOf(const Vector& position) const
  {
    const Vector from = (position - this->Low) * this->PerCube;
    return { std::max(static_cast<int>(from.X), 0), std::max(static_cast<int>(from.Y), 0),
      std::max(static_cast<int>(from.Z), 0) };
  }

  std::vector<std::vector<int>> FindFacesOfLayers() const
  {
    using LayersOfFace = std::array<int, 3>;
    const auto perFace =
      CollectInSpans<LayersOfFace>(this->Threads, this->Mesh.Faces.size(), SpanSize,
        [this](std::size_t f, std::vector<LayersOfFace>& some)
        {
          if (this->Mesh.Faces[f].IsThere())
          {
            const Box box = this->BoxOf(static_cast<int>(f));
            some.push_back(
              { static_cast<int>(f), this->CubeOf(box.Low)[2], this->CubeOf(box.High)[2] });
          }
        });
    std::vector<std::vector<int>> faces(static_cast<std::size_t>(this->Count[2]));
    for (const auto& [face, low, high] : perFace)
    {
      for (int k = low; k <= high; ++k)
      {
        faces[static_cast<std::size_t>(k)].push_back(face);
      }
    }
    return faces;
  }

  void TestLayer(int layer, const std::vector<int>& faces, std::vector<std::array<int, 2>>& pairs,
    std::vector<int>& candidates) const
  {
    // Counting sort of the faces by cube.
    std::vector<std::size_t> first(
      static_cast<std::size_t>(this->Count[0]) * this->Count[1] + 1, 0);
    const auto forCubes = [&](const auto& visit)
    {
      for (const int f : faces)
      {
        const Box box = this->BoxOf(f);
        const std::array<int, 3> low = this->CubeOf(box.Low);
        const std::array<int, 3> high = this->CubeOf(box.High);
        for (int j = low[1]; j <= high[1]; ++j)
        {
          for (int i = low[0]; i <= high[0]; ++i)
          {
            visit(static_cast<std::size_t>(j) * this->Count[0] + i, f);
          }
        }
      }
    };
    forCubes([&](std::size_t cube, int) { ++first[cube + 1]; });
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<int> inCubes(first.back());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    forCubes([&](std::size_t cube, int f) { inCubes[next[cube]++] = f; });
    for (std::size_t cube = 0; cube + 1 < first.size(); ++cube)
    {
      if (first[cube + 1] > first[cube])
      {
        const int along = static_cast<int>(cube);
        this->TestCube({ along % this->Count[0], along / this->Count[0], layer },
          inCubes.data() + first[cube], inCubes.data() + first[cube + 1], pairs, candidates);
      }
    }
  }

  void TestCube(const std::array<int, 3>& cube, const int* first, const int* last,
    std::vector<std::array<int, 2>>& pairs, std::vector<int>& candidates) const
  {
    if (this->AreOneSheet(first, last))
    {
      return;
    }
    for (const int* f = first; f != last; ++f)
    {
      candidates.push_back(*f);
      const Box box = this->BoxOf(*f);
      const MeshTriangle triangle = TriangleAt(this->Mesh, *f);
      for (const int* g = f + 1; g != last; ++g)
      {
        const Box other = this->BoxOf(*g);
        if (box.IsApartFrom(other))
        {
          continue;
        }
        // Test each pair once: in the first cube that both faces overlap.
        if (this->CubeOf(box.Within(other).Low) == cube &&
          TrianglesIntersect(triangle, TriangleAt(this->Mesh, *g), this->Tolerance))
        {
          pairs.push_back({ *f, *g });
        }
      }
    }
  }

  bool AreOneSheet(const int* first, const int* last) const
  {
    const auto faceOf = [this](int face) -> const InterfaceMesh::Face&
    { return this->Mesh.Faces[static_cast<std::size_t>(face)]; };
    const InterfaceMesh::Face& one = faceOf(*first);
    VectorD sum;
    for (const int* f = first; f != last; ++f)
    {
      const InterfaceMesh::Face& face = faceOf(*f);
      if (face.Behind != one.Behind || face.Front != one.Front)
      {
        return false;
      }
      sum += this->Mesh.NormalOf(face);
    }
    const VectorD along = Normalized(sum);
    return std::all_of(first, last,
      [&](int face)
      {
        const VectorD normal = this->Mesh.NormalOf(faceOf(face));
        return Dot(normal, along) > LeastSheetCosine * Length(normal);
      });
  }

  const InterfaceMesh& Mesh;
  double Tolerance;
  Executor& Threads;
  Vector Low;
  float PerCube = 1.f;
  std::array<int, 3> Count = { 1, 1, 1 }; ///< cubes along each axis
};
}

InterfaceCrossings FindCrossings(const InterfaceMesh& mesh, double tolerance, Executor& executor)
{
  return CrossingFinder(mesh, tolerance, executor).Find();
}
}
