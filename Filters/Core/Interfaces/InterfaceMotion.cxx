// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceMotion.h"

#include "Core/Common/Spans.h"
#include "Core/Interfaces/InterfaceClearance.h"
#include "Core/Interfaces/TriangleShape.h"

#include <algorithm>
#include <array>
#include <vector>

namespace volumic
{
namespace
{
constexpr std::size_t SpanSize = 1024;
/** Cosine of the angle by which a face may turn. */
constexpr double LeastTurnCosine = 0.3;

/** Takes back what is not safe. */
class Verification
{
public:
  Verification(InterfaceMesh& mesh, const LargeVector<Vector>& before, double tolerance,
    double leastAngle, Executor& executor)
    : Mesh(mesh), Before(before), Clearance(mesh, tolerance), LeastAngle(leastAngle),
      Threads(executor), IsBack(mesh.Position.size(), 0)
  {
  }

  void Run()
  {
    std::vector<int> faces;
    for (int f = 0; f < static_cast<int>(this->Mesh.Faces.size()); ++f)
    {
      if (this->Mesh.Faces[static_cast<std::size_t>(f)].IsThere())
      {
        faces.push_back(f);
      }
    }
    std::vector<int> back;
    for (const int f : faces)
    {
      this->TakeBackTurned(f, back);
    }
    this->Clearance.Reset(this->Threads);
    // Each round takes back a vertex more, or is the last one.
    for (bool isFirst = true; isFirst || !faces.empty(); isFirst = false)
    {
      this->TakeBackIntersecting(faces, isFirst, back);
      this->FindFacesOf(back, faces);
      back.clear();
      for (const int f : faces)
      {
        this->TakeBackTurned(f, back);
      }
      std::vector<int> more;
      this->FindFacesOf(back, more);
      faces.insert(faces.end(), more.begin(), more.end());
    }
  }

private:
  void TakeBack(int v, std::vector<int>& back)
  {
    unsigned char& isBack = this->IsBack[static_cast<std::size_t>(v)];
    if (isBack == 0)
    {
      isBack = 1;
      this->Mesh.Position[static_cast<std::size_t>(v)] = this->Before[static_cast<std::size_t>(v)];
      back.push_back(v);
      this->TakeBack(this->Mesh.NextImage[static_cast<std::size_t>(v)], back);
    }
  }

  void TakeBackTurned(int f, std::vector<int>& back)
  {
    const InterfaceMesh::Face& face = this->Mesh.Faces[static_cast<std::size_t>(f)];
    const auto at = [&](int k)
    { return VectorD(this->Before[static_cast<std::size_t>(face.Vertex[k])]); };
    const VectorD before = Cross(at(1) - at(0), at(2) - at(0));
    const VectorD after = this->Mesh.NormalOf(face);
    const auto isSpoilt = [&]
    {
      const double angle = SmallestAngle(TriangleOf(this->Mesh, face.Vertex));
      return angle < this->LeastAngle && angle < SmallestAngle(at(0), at(1), at(2));
    };
    if ((this->LeastAngle > 0. && isSpoilt()) ||
      Dot(before, after) < LeastTurnCosine * Length(before) * Length(after))
    {
      for (const int v : face.Vertex)
      {
        this->TakeBack(v, back);
      }
    }
  }

  void TakeBackIntersecting(const std::vector<int>& faces, bool isFirst, std::vector<int>& back)
  {
    this->Follow(back);
    std::vector<std::vector<std::array<int, 2>>> ofSpans((faces.size() + SpanSize - 1) / SpanSize);
    ForSpans(this->Threads, faces.size(), SpanSize,
      [&](std::size_t span, std::size_t begin, std::size_t end)
      {
        std::vector<int> near;
        for (std::size_t n = begin; n < end; ++n)
        {
          const int first = isFirst ? faces[n] : 0;
          int other = this->Clearance.FindIntersecting(faces[n], first, near);
          other = other >= 0 ? other : this->FindPassed(faces[n], first, near);
          if (other >= 0)
          {
            ofSpans[span].push_back({ faces[n], other });
          }
        }
      });
    for (const std::array<int, 2>& pair : Joined(this->Threads, ofSpans))
    {
      for (const int f : pair)
      {
        for (const int v : this->Mesh.Faces[static_cast<std::size_t>(f)].Vertex)
        {
          this->TakeBack(v, back);
        }
      }
    }
    this->Follow(back);
  }

  /** One of those from `first` on with an edge of this face that it has been turned past; -1: none.
   */
  int FindPassed(int face, int first, std::vector<int>& about) const
  {
    const std::array<int, 3>& corners = this->Mesh.Faces[static_cast<std::size_t>(face)].Vertex;
    for (int k = 0; k < 3; ++k)
    {
      const int u = corners[k];
      const int v = corners[(k + 1) % 3];
      this->Mesh.FindFaces(u, v, about);
      for (const int other : about)
      {
        if (other != face && other >= first &&
          HavePassed(u, v, { this->FaceBefore(face), this->FaceBefore(other) },
            { TriangleOf(this->Mesh, corners),
              TriangleOf(this->Mesh, this->Mesh.Faces[static_cast<std::size_t>(other)].Vertex) }))
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

  /** What has been taken back is where it is found from now on. */
  void Follow(const std::vector<int>& back)
  {
    for (const int v : back)
    {
      this->Mesh.ForFaces(v, [&](int f) { this->Clearance.Change(f); });
    }
  }

  void FindFacesOf(const std::vector<int>& vertices, std::vector<int>& faces) const
  {
    faces.clear();
    for (const int v : vertices)
    {
      this->Mesh.ForFaces(v, [&](int f) { faces.push_back(f); });
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  }

  InterfaceMesh& Mesh;
  const LargeVector<Vector>& Before;
  InterfaceClearance Clearance;
  double LeastAngle;
  Executor& Threads;
  std::vector<unsigned char> IsBack;
};

/** Has images make the shortest of their steps. */
void MoveImagesAlike(const InterfaceMesh& mesh, LargeVector<Vector>& after)
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
      const Vector place = after[static_cast<std::size_t>(shortest)];
      for (const auto& image : images)
      {
        after[static_cast<std::size_t>(image[0])] = mesh.OnSides(image[0], place);
      }
    }
  }
}
}

void MoveInterfaces(InterfaceMesh& mesh, const InterfaceFields& fields, int steps, double share,
  double shortest, double tolerance, double leastAngle, Executor& executor, double straightening)
{
  const LargeVector<Vector> before = mesh.Position;
  LargeVector<Vector> after = before;
  for (int step = 0; step < steps; ++step)
  {
    ForSpans(executor, before.size(), SpanSize,
      [&](std::size_t, std::size_t begin, std::size_t end)
      {
        VertexTargets targets(mesh, fields, share, shortest, straightening);
        for (std::size_t v = begin; v < end; ++v)
        {
          if (mesh.IsVertex(static_cast<int>(v)))
          {
            after[v] = targets.Of(static_cast<int>(v));
          }
        }
      });
    MoveImagesAlike(mesh, after);
    mesh.Position.swap(after);
  }
  Verification(mesh, before, tolerance, leastAngle, executor).Run();
}
}
