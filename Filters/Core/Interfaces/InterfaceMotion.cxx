// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceMotion.h"

#include "Core/Common/Select.h"
#include "Core/Interfaces/InterfaceClearance.h"
#include "Core/Interfaces/InterfaceCrossings.h"
#include "Core/Interfaces/TriangleShape.h"

#include <algorithm>
#include <array>
#include <vector>

namespace volumic
{
namespace
{
constexpr std::size_t SpanSize = 1024;
constexpr double LeastTurnCosine = 0.3; ///< of the angle by which a face may turn

/** Moves vertices of invalid faces back to their initial positions. */
class Verification
{
public:
  Verification(InterfaceMesh& mesh, const LargeVector<Vector>& before, double tolerance,
    double leastAngle, Executor& executor)
    : Mesh(mesh), Before(before), Clearance(mesh, tolerance), Tolerance(tolerance),
      LeastAngle(leastAngle), Threads(executor), IsRestored(mesh.Position.size(), 0)
  {
  }

  void Run()
  {
    std::vector<int> restored;
    this->RestoreTurned(this->FindTurned(), restored);
    const InterfaceCrossings crossings = FindCrossings(this->Mesh, this->Tolerance, this->Threads);
    this->RestorePairs(crossings.Pairs, restored);
    this->RestorePairs(this->FindPassed(crossings.Candidates), restored);
    if (restored.empty())
    {
      return;
    }
    this->Clearance.Reset(this->Threads);
    // Terminates: each round except for the last one moves at least one more vertex back.
    while (!restored.empty())
    {
      std::vector<int> faces = this->FindFacesOf(restored);
      restored.clear();
      this->RestoreTurned(faces, restored);
      const std::vector<int> more = this->FindFacesOf(restored);
      faces.insert(faces.end(), more.begin(), more.end());
      this->UpdateClearance(restored);
      const std::vector<std::array<int, 2>> pairs = this->FindPairs(faces,
        [this](int face, std::vector<int>& near)
        { return this->Clearance.FindIntersecting(face, near); });
      std::vector<int> now;
      this->RestorePairs(pairs, now);
      this->RestorePairs(this->FindPassed(faces), now);
      this->UpdateClearance(now);
      restored.insert(restored.end(), now.begin(), now.end());
    }
  }

private:
  void Restore(int v, std::vector<int>& restored)
  {
    unsigned char& isRestored = this->IsRestored[static_cast<std::size_t>(v)];
    if (isRestored == 0)
    {
      isRestored = 1;
      this->Mesh.Position[static_cast<std::size_t>(v)] = this->Before[static_cast<std::size_t>(v)];
      restored.push_back(v);
      this->Restore(this->Mesh.NextImage[static_cast<std::size_t>(v)], restored);
    }
  }

  bool HasTurned(int f) const
  {
    const MeshTriangle old = this->FaceBefore(f);
    const MeshTriangle now = TriangleAt(this->Mesh, f);
    const VectorD before = NormalOf(old);
    const VectorD after = NormalOf(now);
    const auto isDegraded = [&]
    {
      const double angle = SmallestAngle(now);
      return angle < this->LeastAngle && angle < SmallestAngle(old);
    };
    return (this->LeastAngle > 0. && isDegraded()) ||
      Dot(before, after) < LeastTurnCosine * Length(before) * Length(after);
  }

  std::vector<int> FindTurned() const
  {
    return CollectInSpans<int>(this->Threads, this->Mesh.Faces.size(), SpanSize,
      [this](std::size_t f, std::vector<int>& turned)
      {
        if (this->Mesh.Faces[f].IsThere() && this->HasTurned(static_cast<int>(f)))
        {
          turned.push_back(static_cast<int>(f));
        }
      });
  }

  void RestoreTurned(const std::vector<int>& faces, std::vector<int>& restored)
  {
    for (const int f : faces)
    {
      if (this->HasTurned(f))
      {
        this->RestoreFace(f, restored);
      }
    }
  }

  void RestoreFace(int f, std::vector<int>& restored)
  {
    for (const int v : this->Mesh.Faces[static_cast<std::size_t>(f)].Vertex)
    {
      this->Restore(v, restored);
    }
  }

  void RestorePairs(const std::vector<std::array<int, 2>>& pairs, std::vector<int>& restored)
  {
    for (const std::array<int, 2>& pair : pairs)
    {
      this->RestoreFace(pair[0], restored);
      this->RestoreFace(pair[1], restored);
    }
  }

  /** Return the pairs (face, other(face, scratch)) with a non-negative second face. */
  template <typename Other>
  std::vector<std::array<int, 2>> FindPairs(const std::vector<int>& faces, const Other& other) const
  {
    return CollectInSpans<std::array<int, 2>>(this->Threads, faces.size(), SpanSize,
      [&](std::size_t n, std::vector<std::array<int, 2>>& pairs)
      {
        std::vector<int> scratch;
        const int found = other(faces[n], scratch);
        if (found >= 0)
        {
          pairs.push_back({ faces[n], found });
        }
      });
  }

  std::vector<std::array<int, 2>> FindPassed(const std::vector<int>& faces) const
  {
    return this->FindPairs(
      faces, [this](int face, std::vector<int>& atEdge) { return this->FindPassed(face, atEdge); });
  }

  /** Return a face at a common edge past which a face has been turned; -1: none. */
  int FindPassed(int face, std::vector<int>& atEdge) const
  {
    const std::array<int, 3>& corners = this->Mesh.Faces[static_cast<std::size_t>(face)].Vertex;
    for (int k = 0; k < 3; ++k)
    {
      const int u = corners[k];
      const int v = corners[(k + 1) % 3];
      this->Mesh.FindFaces(u, v, atEdge);
      for (const int other : atEdge)
      {
        if (other != face &&
          HavePassed(u, v, { this->FaceBefore(face), this->FaceBefore(other) },
            { TriangleOf(this->Mesh, corners), TriangleAt(this->Mesh, other) }))
        {
          return other;
        }
      }
    }
    return -1;
  }

  MeshTriangle FaceBefore(int face) const
  {
    MeshTriangle triangle;
    for (int k = 0; k < 3; ++k)
    {
      const int v = this->Mesh.Faces[static_cast<std::size_t>(face)].Vertex[k];
      triangle.Vertex[k] = v;
      triangle.Corner[k] = VectorD(this->Before[static_cast<std::size_t>(v)]);
    }
    return triangle;
  }

  void UpdateClearance(const std::vector<int>& restored)
  {
    for (const int v : restored)
    {
      this->Mesh.ForFaces(v, [&](int f) { this->Clearance.Change(f); });
    }
  }

  std::vector<int> FindFacesOf(const std::vector<int>& vertices) const
  {
    std::vector<int> faces;
    for (const int v : vertices)
    {
      this->Mesh.ForFaces(v, [&](int f) { faces.push_back(f); });
    }
    SortUnique(faces);
    return faces;
  }

  InterfaceMesh& Mesh;
  const LargeVector<Vector>& Before;
  InterfaceClearance Clearance;
  double Tolerance;
  double LeastAngle;
  Executor& Threads;
  std::vector<unsigned char> IsRestored;
};

/** Give all images of a vertex the shortest of their steps. */
void SynchronizeImages(const InterfaceMesh& mesh, LargeVector<Vector>& after)
{
  const auto lengthOf = [&](int v)
  {
    return SquaredDistance(
      after[static_cast<std::size_t>(v)], mesh.Position[static_cast<std::size_t>(v)]);
  };
  std::vector<std::array<int, 2>> images;
  for (int v = 0; v < static_cast<int>(after.size()); ++v)
  {
    if (mesh.HasImages(v))
    {
      mesh.FindImages(v, v, images);
      const int shortest = (*std::min_element(images.begin(), images.end(),
        [&](const auto& a, const auto& b) { return lengthOf(a[0]) < lengthOf(b[0]); }))[0];
      const Vector position = after[static_cast<std::size_t>(shortest)];
      for (const auto& image : images)
      {
        after[static_cast<std::size_t>(image[0])] = mesh.ProjectToSides(image[0], position);
      }
    }
  }
}
}

void MoveInterfaces(InterfaceMesh& mesh, const InterfaceFields& fields, int steps,
  double relaxation, double shortest, double tolerance, double leastAngle, Executor& executor,
  double straightening, double mostOfEdge)
{
  const LargeVector<Vector> before = mesh.Position;
  LargeVector<Vector> after = before;
  try
  {
    for (int step = 0; step < steps; ++step)
    {
      ForSpans(executor, before.size(), SpanSize,
        [&](std::size_t, std::size_t begin, std::size_t end)
        {
          VertexTargets targets(mesh, fields, relaxation, shortest, straightening, mostOfEdge);
          for (std::size_t v = begin; v < end; ++v)
          {
            if (mesh.IsVertex(static_cast<int>(v)))
            {
              after[v] = targets.TargetOf(static_cast<int>(v));
            }
          }
        });
      SynchronizeImages(mesh, after);
      mesh.Position.swap(after);
    }
    Verification(mesh, before, tolerance, leastAngle, executor).Run();
  }
  catch (...)
  {
    mesh.Position = before; // The steps are not verified.
    throw;
  }
}
}
