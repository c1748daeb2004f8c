// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceMotion.h"

#include "Core/Common/Blocks.h"
#include "Core/Interfaces/InterfaceClearance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace volumic
{
namespace
{
constexpr std::size_t BlockSize = 1024;
/** Of the shortest edge, what a vertex may go. */
constexpr float MostOfEdge = 0.5f;
/** Shorter steps are none. */
constexpr float LeastPart = 0.1f;
/** Cosine of the angle by which a face may turn. */
constexpr double LeastTurnCosine = 0.3;
/** How far a junction line's vertices go to between their neighbours. */
constexpr float LineSmoothing = 0.5f;
/** At most, workspace: less than that voxels' centres are from lines. */
constexpr float MostSmoothing = 0.15f;
/** Keeps Newton's steps small where the fields say little, as a share of their squared slopes. */
constexpr double Damping = 0.02;

/** Where each vertex wants to be. */
class Targets
{
public:
  Targets(const InterfaceMesh& mesh, const InterfaceFields& fields, double share, double shortest)
    : Mesh(mesh), Fields(fields), Share(static_cast<float>(share)),
      Shortest(static_cast<float>(shortest))
  {
  }

  Vector Of(int v)
  {
    const Vector place = this->Mesh.Position[static_cast<std::size_t>(v)];
    this->Mesh.FindNeighbours(v, this->Neighbours);
    float shortest = SquaredDistance(
      place, this->Mesh.Position[static_cast<std::size_t>(this->Neighbours.front())]);
    for (const int w : this->Neighbours)
    {
      shortest =
        std::min(shortest, SquaredDistance(place, this->Mesh.Position[static_cast<std::size_t>(w)]));
    }
    this->Mesh.FindObjects(v, this->Objects);
    Vector target = place;
    switch (this->Mesh.StratumOf[static_cast<std::size_t>(v)])
    {
      case Stratum::Interface:
        target += this->AlongInterface(v) * this->Share;
        break;
      case Stratum::Line:
        target += this->AlongLine(v) * this->Share;
        break;
      case Stratum::Corner:
        break;
    }
    target += this->ToInterfaces(target);
    if (this->Mesh.StratumOf[static_cast<std::size_t>(v)] == Stratum::Line)
    {
      const Vector way = this->Straightening(target) * LineSmoothing;
      const float length = Length(way);
      target += length > MostSmoothing ? way * (MostSmoothing / length) : way;
    }
    const Vector way = target - place;
    const float length = Length(way);
    const float most = MostOfEdge * std::sqrt(shortest);
    float part = length > most ? most / length : 1.f;
    while (part > LeastPart && this->Shortens(place, place + way * part))
    {
      part *= 0.5f;
    }
    return part > LeastPart ? place + way * part : place;
  }

private:
  /**
   * Whether it would make an edge too short, if the neighbour did the same: two corners of the same
   * objects want to be in one place.
   */
  bool Shortens(const Vector& place, const Vector& target) const
  {
    return std::any_of(this->Neighbours.begin(), this->Neighbours.end(),
      [&](int w)
      {
        const Vector& other = this->Mesh.Position[static_cast<std::size_t>(w)];
        const float before = Length(other - place);
        const float least = 0.5f * (before + std::min(before, this->Shortest));
        return SquaredDistance(other, target) < least * least;
      });
  }

  /** To the middle of its faces, by their areas, without what is across. */
  Vector AlongInterface(int v) const
  {
    const VectorD place(this->Mesh.Position[static_cast<std::size_t>(v)]);
    VectorD normal;
    VectorD sum;
    double areas = 0.;
    this->Mesh.ForFaces(v,
      [&](int f)
      {
        const InterfaceMesh::Face& face = this->Mesh.Faces[static_cast<std::size_t>(f)];
        const VectorD across = this->Mesh.NormalOf(face);
        const double area = Length(across);
        VectorD middle;
        for (const int w : face.Vertex)
        {
          middle += VectorD(this->Mesh.Position[static_cast<std::size_t>(w)]) * (1. / 3.);
        }
        normal += across;
        sum += (middle - place) * area;
        areas += area;
      });
    if (!(areas > 0.))
    {
      return Vector();
    }
    // The middle of faces is two thirds of the way to that of the neighbours.
    const VectorD way = sum * (1.5 / areas);
    const VectorD unit = Normalized(normal);
    return Vector(way - unit * Dot(way, unit));
  }

  /** To the middle of its two neighbours on the line, without what is across. */
  Vector AlongLine(int v) const
  {
    std::array<Vector, 2> ends;
    if (!this->FindEnds(ends))
    {
      return Vector();
    }
    const Vector along = Normalized(ends[1] - ends[0]);
    return along *
      Dot(along, (ends[0] + ends[1]) * 0.5f - this->Mesh.Position[static_cast<std::size_t>(v)]);
  }

  /** From a place to the straight line between the neighbours on the junction line. */
  Vector Straightening(const Vector& place) const
  {
    std::array<Vector, 2> ends;
    if (!this->FindEnds(ends))
    {
      return Vector();
    }
    const Vector along = Normalized(ends[1] - ends[0]);
    const Vector way = (ends[0] + ends[1]) * 0.5f - place;
    return way - along * Dot(along, way);
  }

  /** The two neighbours on its junction line. */
  bool FindEnds(std::array<Vector, 2>& ends) const
  {
    int count = 0;
    for (std::size_t n = 0; n + 2 < this->Neighbours.size(); ++n)
    {
      const int w = this->Neighbours[n];
      const bool isFirst = n == 0 || this->Neighbours[n - 1] != w;
      if (isFirst && this->Neighbours[n + 2] == w && count < 2)
      {
        ends[static_cast<std::size_t>(count++)] = this->Mesh.Position[static_cast<std::size_t>(w)];
      }
    }
    return count == 2;
  }

  /** The least step that makes the fields of all objects about it the same. */
  Vector ToInterfaces(const Vector& place) const
  {
    double matrix[3][3] = { { 0., 0., 0. }, { 0., 0., 0. }, { 0., 0., 0. } };
    VectorD right;
    const InterfaceFields::Sample first = this->Fields.Interpolate(this->Objects.front(), place);
    double slopes = 0.;
    for (std::size_t n = 1; n < this->Objects.size(); ++n)
    {
      const InterfaceFields::Sample other = this->Fields.Interpolate(this->Objects[n], place);
      const VectorD slope(other.Gradient - first.Gradient);
      const double difference = static_cast<double>(other.Value) - first.Value;
      const double s[3] = { slope.X, slope.Y, slope.Z };
      for (int a = 0; a < 3; ++a)
      {
        for (int b = 0; b < 3; ++b)
        {
          matrix[a][b] += s[a] * s[b];
        }
      }
      right -= slope * difference;
      slopes += SquaredLength(slope);
    }
    const double damping = Damping * slopes + 1e-6;
    const VectorD rows[3] = { VectorD(matrix[0][0] + damping, matrix[0][1], matrix[0][2]),
      VectorD(matrix[1][0], matrix[1][1] + damping, matrix[1][2]),
      VectorD(matrix[2][0], matrix[2][1], matrix[2][2] + damping) };
    const VectorD cross = Cross(rows[1], rows[2]);
    const double determinant = Dot(rows[0], cross);
    // Cramer's rule; the matrix is symmetric and positive.
    return Vector(VectorD(Dot(right, cross), Dot(right, Cross(rows[2], rows[0])),
                    Dot(right, Cross(rows[0], rows[1]))) *
      (1. / determinant));
  }

  const InterfaceMesh& Mesh;
  const InterfaceFields& Fields;
  float Share;
  float Shortest;
  std::vector<int> Neighbours;
  std::vector<int> Objects;
};

/** Takes back what is not safe. */
class Verification
{
public:
  Verification(
    InterfaceMesh& mesh, const std::vector<Vector>& before, double tolerance, Executor& executor)
    : Mesh(mesh), Before(before), Clearance(mesh, tolerance), Threads(executor),
      IsBack(mesh.Position.size(), 0)
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
    this->Clearance.Reset(this->Mesh.LongestEdge());
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
    }
  }

  void TakeBackTurned(int f, std::vector<int>& back)
  {
    const InterfaceMesh::Face& face = this->Mesh.Faces[static_cast<std::size_t>(f)];
    const auto at = [&](int k)
    { return VectorD(this->Before[static_cast<std::size_t>(face.Vertex[k])]); };
    const VectorD before = Cross(at(1) - at(0), at(2) - at(0));
    const VectorD after = this->Mesh.NormalOf(face);
    if (Dot(before, after) < LeastTurnCosine * Length(before) * Length(after))
    {
      for (const int v : face.Vertex)
      {
        this->TakeBack(v, back);
      }
    }
  }

  void TakeBackIntersecting(const std::vector<int>& faces, bool isFirst, std::vector<int>& back)
  {
    for (const int v : back)
    {
      this->Clearance.Move(v);
    }
    std::vector<std::vector<std::array<int, 2>>> ofBlocks((faces.size() + BlockSize - 1) / BlockSize);
    ForBlocks(this->Threads, faces.size(), BlockSize,
      [&](std::size_t block, std::size_t begin, std::size_t end)
      {
        InterfaceClearance::Memory memory;
        for (std::size_t n = begin; n < end; ++n)
        {
          const int other =
            this->Clearance.FindIntersecting(faces[n], isFirst ? faces[n] : 0, memory);
          if (other >= 0)
          {
            ofBlocks[block].push_back({ faces[n], other });
          }
        }
      });
    for (const std::array<int, 2>& pair : Joined(this->Threads, ofBlocks))
    {
      for (const int f : pair)
      {
        for (const int v : this->Mesh.Faces[static_cast<std::size_t>(f)].Vertex)
        {
          this->TakeBack(v, back);
        }
      }
    }
    for (const int v : back)
    {
      this->Clearance.Move(v);
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
  const std::vector<Vector>& Before;
  InterfaceClearance Clearance;
  Executor& Threads;
  std::vector<unsigned char> IsBack;
};
}

void MoveInterfaces(InterfaceMesh& mesh, const InterfaceFields& fields, int steps, double share,
  double shortest, double tolerance, Executor& executor)
{
  const std::vector<Vector> before = mesh.Position;
  std::vector<Vector> after = before;
  for (int step = 0; step < steps; ++step)
  {
    ForBlocks(executor, before.size(), BlockSize,
      [&](std::size_t, std::size_t begin, std::size_t end)
      {
        Targets targets(mesh, fields, share, shortest);
        for (std::size_t v = begin; v < end; ++v)
        {
          if (mesh.IsVertex(static_cast<int>(v)))
          {
            after[v] = targets.Of(static_cast<int>(v));
          }
        }
      });
    mesh.Position.swap(after);
  }
  Verification(mesh, before, tolerance, executor).Run();
}
}
