// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What is computed four at a time: the same bits as one at a time.
#include "Core/Common/Lanes.h"
#include "Core/Surface/NormalCone.h"
#include "Core/Surface/StarShape.h"
#include "Core/Surface/SurfaceState.h"
#include "CoreTestTools.h"

using namespace volumic;

namespace
{
/** Numbers in [-1, 1), the same in each run. */
class Numbers
{
public:
  float Next()
  {
    this->State = this->State * 1664525u + 1013904223u;
    return static_cast<float>(this->State >> 8) / (1 << 23) - 1.f;
  }
  Vector NextVector()
  {
    const float x = this->Next();
    const float y = this->Next();
    return Vector(x, y, this->Next());
  }

private:
  std::uint32_t State = 1;
};

float LaneOf(const Lanes& lanes, int i)
{
  float four[Lanes::Count];
  lanes.Store(four);
  return four[i];
}

void ExpectSame(const Vector& a, const Vector& b)
{
  EXPECT_EQ(a.X, b.X);
  EXPECT_EQ(a.Y, b.Y);
  EXPECT_EQ(a.Z, b.Z);
}

/** A sphere that is shaken: stars of all shapes, folded ones among them. */
SurfaceMesh ShakenSphere(float by)
{
  SurfaceMesh mesh;
  mesh.Append(DividedIcosahedron({ 100, 10, 10 }, 6, 1.6));
  Numbers numbers;
  for (Vector& p : mesh.Position)
  {
    p += numbers.NextVector() * by;
  }
  return mesh;
}
}

TEST(Lanes, ComputeWhatOneFloatDoes)
{
  Numbers numbers;
  for (int round = 0; round < 100; ++round)
  {
    float a[4];
    float b[4];
    for (int i = 0; i < 4; ++i)
    {
      a[i] = numbers.Next();
      b[i] = i == round % 7 ? a[i] : numbers.Next();
    }
    const Lanes x = Lanes::Load(a);
    const Lanes y = Lanes::Load(b);
    const unsigned less = LessBits(x, y);
    for (int i = 0; i < 4; ++i)
    {
      EXPECT_EQ(LaneOf(x + y, i), a[i] + b[i]);
      EXPECT_EQ(LaneOf(x - y, i), a[i] - b[i]);
      EXPECT_EQ(LaneOf(x * y, i), a[i] * b[i]);
      EXPECT_EQ(LaneOf(x / y, i), a[i] / b[i]);
      EXPECT_EQ(LaneOf(Minimum(x, y), i), std::min(a[i], b[i]));
      EXPECT_EQ(LaneOf(Maximum(x, y), i), std::max(a[i], b[i]));
      EXPECT_EQ(LaneOf(SquareRoot(x * x), i), std::sqrt(a[i] * a[i]));
      EXPECT_EQ(LaneOf(WhereLess(x, y, x), i), a[i] < b[i] ? a[i] : 0.f);
      EXPECT_EQ(less >> i & 1, a[i] < b[i] ? 1u : 0u);
    }
    EXPECT_EQ(LeastOf(x), *std::min_element(a, a + 4));
    EXPECT_EQ(GreatestOf(x), *std::max_element(a, a + 4));
  }
}

TEST(StarShape, IsWhatItsEdgesAndFacesAre)
{
  const SurfaceMesh mesh = ShakenSphere(0.6f);
  int valences = 0; // Of different remainders.
  int delaunay = 0;
  for (int v = 0; v < mesh.Size(); ++v)
  {
    const Ring& ring = mesh.Rings[v];
    valences |= 1 << ring.Count % Lanes::Count;
    const StarShape star(mesh, v);
    const StarFaces faces(mesh, v);
    Vector sum;
    bool isDelaunay = true;
    for (int i = 0; i < ring.Count; ++i)
    {
      const Vector& p = mesh.Position[v];
      const Vector edge = mesh.Position[ring.Item[i]] - p;
      const Vector next = mesh.Position[ring.Next(i)] - p;
      const Vector before = mesh.Position[ring.Previous(i)] - p;
      const Vector normal = Cross(edge, next);
      ExpectSame(star.Edge[i], edge);
      EXPECT_EQ(star.Length[i], Length(edge));
      ExpectSame(star.Normal[i], normal);
      EXPECT_EQ(star.Size[i], Length(normal));
      ExpectSame(faces.Normal[i], Normalized(normal));
      EXPECT_EQ(faces.Low[i].X,
        std::min({ p.X, mesh.Position[ring.Item[i]].X, mesh.Position[ring.Next(i)].X }));
      EXPECT_EQ(faces.High[i].Z,
        std::max({ p.Z, mesh.Position[ring.Item[i]].Z, mesh.Position[ring.Next(i)].Z }));
      sum += normal;
      const float a = Length(before) * Length(before) - Dot(before, edge);
      const float b = Length(next) * Length(next) - Dot(next, edge);
      const float sizeA = Length(Cross(before, edge));
      const float sizeB = Length(normal);
      isDelaunay =
        isDelaunay && !(a * sizeB + b * sizeA < LeastCotangentSum * sizeB * sizeA);
    }
    const Vector axis = Normalized(sum);
    float cosine = 1;
    for (int i = 0; i < ring.Count; ++i)
    {
      cosine = std::min(cosine, Dot(star.Normal[i], axis) / star.Size[i]);
    }
    ExpectSame(star.Cone().Axis(), axis);
    EXPECT_EQ(star.Cone().Cosine, cosine);
    EXPECT_EQ(star.IsDelaunay(), isDelaunay) << v;
    delaunay += isDelaunay ? 1 : 0;
  }
  EXPECT_EQ(valences, 6); // 5 and 6.
  EXPECT_GT(delaunay, 20);
  EXPECT_LT(delaunay, mesh.Size() - 20);
}
