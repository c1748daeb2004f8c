// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/VertexTargets.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
/** Least fraction of a step; a vertex does not move otherwise. */
constexpr float LeastFraction = 0.1f;
/** Fraction of the straightening step of junction lines, which reduces the voxel staircase. */
constexpr float LineSmoothing = 0.8f;
/** Damping of the Newton step, relative to the sum of the squared slopes. */
constexpr double Damping = 0.02;
}

Vector VertexTargets::TargetOf(int v)
{
  const Vector position = this->Mesh.Position[static_cast<std::size_t>(v)];
  this->Mesh.FindNeighbours(v, this->Neighbours);
  float shortest = SquaredDistance(
    position, this->Mesh.Position[static_cast<std::size_t>(this->Neighbours.front())]);
  for (const int w : this->Neighbours)
  {
    shortest = std::min(
      shortest, SquaredDistance(position, this->Mesh.Position[static_cast<std::size_t>(w)]));
  }
  this->FindObjects(v);
  this->FindEnds();
  const bool isOnLine = !this->Ends.empty();
  const Vector along = isOnLine ? this->AlongLine(v) : this->AlongInterface(v);
  Vector target = position + Vector(this->AlongSides(VectorD(along))) * this->Relaxation;
  target += this->ToInterfaces(target);
  if (isOnLine)
  {
    target += Vector(this->AlongSides(VectorD(this->Straightening(target))));
  }
  const Vector step = this->Mesh.ProjectToSides(v, target) - position;
  const float length = Length(step);
  const float most = this->Most * std::sqrt(shortest);
  float fraction = length > most ? most / length : 1.f;
  while (fraction > LeastFraction && this->Shortens(position, position + step * fraction))
  {
    fraction *= 0.5f;
  }
  return fraction > LeastFraction ? position + step * fraction : position;
}

void VertexTargets::FindObjects(int v)
{
  this->Mesh.FindObjects(v, this->Objects);
  this->Free = { 1., 1., 1. };
  while (this->Mesh.IsSide(this->Objects.back()))
  {
    this->Free[static_cast<std::size_t>(this->Mesh.AxisOf(this->Objects.back()))] = 0.;
    this->Objects.pop_back();
  }
}

bool VertexTargets::Shortens(const Vector& position, const Vector& target) const
{
  return std::any_of(this->Neighbours.begin(), this->Neighbours.end(),
    [&](int w)
    {
      const Vector& other = this->Mesh.Position[static_cast<std::size_t>(w)];
      const float before = Length(other - position);
      const float least = 0.5f * (before + std::min(before, this->Shortest));
      return SquaredDistance(other, target) < least * least;
    });
}

Vector VertexTargets::AlongInterface(int v) const
{
  const VectorD position(this->Mesh.Position[static_cast<std::size_t>(v)]);
  VectorD normal;
  VectorD sum;
  double areas = 0.;
  this->Mesh.ForFaces(v,
    [&](int f)
    {
      const InterfaceMesh::Face& face = this->Mesh.Faces[static_cast<std::size_t>(f)];
      const VectorD across = this->Mesh.NormalOf(face);
      double size = 0.;
      VectorD middle;
      for (const int w : face.Vertex)
      {
        size += this->Mesh.Size[static_cast<std::size_t>(w)] * (1. / 3.);
        middle += VectorD(this->Mesh.Position[static_cast<std::size_t>(w)]) * (1. / 3.);
      }
      // Divide by the size: large faces must not attract vertices from regions of small faces.
      const double area = Length(across) / (size * size);
      normal += across;
      sum += (middle - position) * area;
      areas += area;
    });
  if (!(areas > 0.))
  {
    return Vector();
  }
  // The mean of the face centres is at 2/3 of the distance to the mean of the neighbours.
  const VectorD step = sum * (1.5 / areas);
  const VectorD unit = Normalized(normal);
  return Vector(step - unit * Dot(step, unit));
}

Vector VertexTargets::AlongLine(int v) const
{
  if (this->Ends.size() != 2)
  {
    return Vector();
  }
  const Vector along = Normalized(this->Ends[1] - this->Ends[0]);
  return along *
    Dot(along, this->MiddleOfEnds() - this->Mesh.Position[static_cast<std::size_t>(v)]);
}

Vector VertexTargets::Straightening(const Vector& position) const
{
  Vector step = this->MiddleOfEnds() - position;
  if (this->Ends.size() == 2)
  {
    const Vector along = Normalized(this->Ends[1] - this->Ends[0]);
    step -= along * Dot(along, step);
  }
  const float length = Length(step);
  return length * LineSmoothing > this->Straightest ? step * (this->Straightest / length)
                                                    : step * LineSmoothing;
}

Vector VertexTargets::MiddleOfEnds() const
{
  Vector sum;
  for (const Vector& end : this->Ends)
  {
    sum += end;
  }
  return sum * (1.f / static_cast<float>(this->Ends.size()));
}

void VertexTargets::FindEnds()
{
  this->Ends.clear();
  InterfaceMesh::ForLineNeighbours(this->Neighbours,
    [this](int w) { this->Ends.push_back(this->Mesh.Position[static_cast<std::size_t>(w)]); });
}

Vector VertexTargets::ToInterfaces(const Vector& position) const
{
  double matrix[3][3] = { { 0., 0., 0. }, { 0., 0., 0. }, { 0., 0., 0. } };
  VectorD right;
  const InterfaceFields::Sample first = this->Fields.Interpolate(this->Objects.front(), position);
  double slopes = 0.;
  for (std::size_t n = 1; n < this->Objects.size(); ++n)
  {
    const InterfaceFields::Sample other = this->Fields.Interpolate(this->Objects[n], position);
    const VectorD slope = this->AlongSides(VectorD(other.Gradient - first.Gradient));
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
}
