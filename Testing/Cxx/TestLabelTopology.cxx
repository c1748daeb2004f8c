// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Guarantees of vtkLabelsToSurfaces: the mesh has the topology of the voxels, the volumes of labels
// and their parts are preserved, and no triangles intersect.

#include "LabelImages.h"
#include "SurfaceTestTools.h"
#include "VoxelScenes.h"

#include <vtkCell.h>

using namespace volumic;

namespace
{
using Configure = std::function<void(vtkLabelsToSurfaces*)>;

struct LabelScene
{
  std::string Name;
  VoxelScene Voxels;
  Configure Settings = [](vtkLabelsToSurfaces*) {};
  double Excess = 1.;         ///< factor of the volume error bound
  int MisclassifiedParts = 0; ///< maximum number of parts with wrong volumes
};

vtkSmartPointer<vtkImageData> ImageOf(const VoxelScene& scene)
{
  const auto& [nx, ny, nz] = scene.Size;
  const auto image = LabelImageOf(
    nx - 2, ny - 2, nz - 2, [&](int i, int j, int k) { return scene.At(i + 1, j + 1, k + 1); });
  image->SetSpacing(scene.Spacing.data());
  return image;
}

/** Return all interfaces of a filter without selected labels; objects are labels. */
InterfaceMesh MeshOf(vtkLabelsToSurfaces* filter)
{
  vtkPolyData* interfaces = filter->GetInterfaces();
  vtkDataArray* labels = interfaces->GetCellData()->GetArray("BoundaryLabels");
  LargeVector<Vector> positions;
  for (vtkIdType p = 0; p < interfaces->GetNumberOfPoints(); ++p)
  {
    const double* at = interfaces->GetPoint(p);
    positions.emplace_back(
      static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2]));
  }
  LargeVector<InterfaceMesh::Face> faces;
  for (vtkIdType c = interfaces->GetNumberOfLines(); c < interfaces->GetNumberOfCells(); ++c)
  {
    InterfaceMesh::Face face;
    for (int k = 0; k < 3; ++k)
    {
      face.Vertex[k] = static_cast<int>(interfaces->GetCell(c)->GetPointId(k));
    }
    face.Behind = static_cast<LabelMap::Number>(labels->GetComponent(c, 0));
    face.Front = static_cast<LabelMap::Number>(labels->GetComponent(c, 1));
    faces.push_back(face);
  }
  InterfaceMesh mesh;
  mesh.Assign(std::move(positions), std::move(faces));
  return mesh;
}

/** Expect that labels share triangles only if their voxels share faces. */
void ExpectContactsOfVoxels(const VoxelScene& scene, const InterfaceMesh& mesh)
{
  std::set<std::pair<int, int>> contacts;
  ForBox({ 1, 1, 1 }, scene.Size,
    [&](int i, int j, int k)
    {
      for (const int other :
        { scene.At(i - 1, j, k), scene.At(i, j - 1, k), scene.At(i, j, k - 1) })
      {
        contacts.insert(std::minmax(other, scene.At(i, j, k)));
      }
    });
  for (const InterfaceMesh::Face& face : mesh.Faces)
  {
    const std::pair<int, int> labels = std::minmax(int(face.Behind), int(face.Front));
    ASSERT_TRUE(labels.first == 0 || contacts.count(labels) > 0)
      << labels.first << " and " << labels.second;
  }
}

void ExpectVolumes(vtkLabelsToSurfaces* filter, const LabelScene& scene)
{
  for (unsigned int block = 0; block < filter->GetOutput()->GetNumberOfBlocks(); ++block)
  {
    vtkPolyData* surface = BlockOf(filter, block);
    SCOPED_TRACE(FieldOf(surface, "Label"));
    const double voxels = FieldOf(surface, "LabelVoxels");
    const double bound = voxels >= 60. ? 0.01 : voxels >= 8. ? 0.05 : 0.25;
    EXPECT_NEAR(FieldOf(surface, "VolumeError"), 0., scene.Excess * bound) << voxels;
    EXPECT_LE(FieldOf(surface, "WrongParts"), scene.MisclassifiedParts);
  }
}

/** Return a scene with labels in a box and 0 elsewhere. */
VoxelScene SceneOf(const Voxel& size, const std::array<double, 3>& spacing,
  const std::function<int(int, int, int)>& labelAt, bool isInBox = false)
{
  VoxelScene scene(size, labelAt);
  if (isInBox)
  {
    scene = VoxelScene(size, labelAt, scene.NumberOfLabels());
  }
  scene.Spacing = spacing;
  return scene;
}

constexpr std::array<double, 3> Cubes = { 1., 1., 1. };

double FarFrom(double at, int i, int j, int k)
{
  return std::hypot(i - at, j - at, k - at);
}

void Flat(vtkLabelsToSurfaces* filter)
{
  filter->SetBoxFacesToFlat();
}

void Periodic(vtkLabelsToSurfaces* filter)
{
  filter->SetBoxFacesToPeriodic();
}

/** A ball of label 2 in a matrix, far from its sides. */
std::vector<LabelScene> Inclusions()
{
  std::vector<LabelScene> scenes;
  for (const int radius : { 2, 3, 4 })
  {
    const auto ball = [=](int i, int j, int k) { return FarFrom(12., i, j, k) <= radius ? 2 : 1; };
    const std::string name = "Inclusion" + std::to_string(radius);
    scenes.push_back({ name, SceneOf({ 24, 24, 24 }, Cubes, ball) });
    scenes.push_back({ name + "Flat", SceneOf({ 24, 24, 24 }, Cubes, ball, true), Flat });
    scenes.push_back({ name + "Periodic", SceneOf({ 24, 24, 24 }, Cubes, ball, true), Periodic });
  }
  return scenes;
}

/** Shapes in 2 x 2 x 2 voxels, and boxes of 1 to 32 voxels, each with its own label. */
std::vector<LabelScene> SmallLabels()
{
  const std::array<int, 4> left = { 0xff, 0x7f, 0xd7, 0xee }; // bit x + 2 y + 4 z per voxel
  const auto corners = [=](int i, int j, int k)
  {
    const int x = i % 20 - 9;
    const bool isThere = std::min({ x, j - 9, k - 9 }) >= 0 && std::max({ x, j - 9, k - 9 }) < 2 &&
      (left[static_cast<std::size_t>(i / 20)] >> (x + 2 * (j - 9) + 4 * (k - 9)) & 1) != 0;
    return isThere ? 1 + i / 20 : 0;
  };
  const std::array<Voxel, 8> sizes = { Voxel{ 2, 1, 1 }, Voxel{ 2, 2, 1 }, Voxel{ 2, 2, 2 },
    Voxel{ 3, 2, 2 }, Voxel{ 4, 2, 2 }, Voxel{ 3, 3, 1 }, Voxel{ 3, 3, 3 }, Voxel{ 4, 4, 2 } };
  const auto boxes = [=](int i, int j, int k)
  {
    const Voxel& size = sizes[static_cast<std::size_t>(j / 24)];
    const Voxel at = { i - 8, j % 24 - 8, k - 8 };
    const bool isIn = std::min({ at[0], at[1], at[2] }) >= 0 && at[0] < size[0] &&
      at[1] < size[1] && at[2] < size[2];
    return isIn ? 1 + j / 24 : 0;
  };
  const auto thick = [](int i, int j, int k)
  {
    const bool isFour = (i == 29 || i == 30) && (j == 9 || j == 10) && (k == 5 || k == 6);
    return i == 10 && j == 10 && k == 6 ? 1 : isFour ? 2 : 0;
  };
  return { { "Corners", SceneOf({ 80, 20, 20 }, Cubes, corners) },
    { "Boxes", SceneOf({ 24, 192, 24 }, Cubes, boxes) },
    { "Thick", SceneOf({ 40, 20, 12 }, { 1., 1., 3. }, thick) } };
}

/** Sheets that are one voxel thick. */
std::vector<LabelScene> Sheets()
{
  const auto tilted = [](int i, int j, int k)
  {
    const double height = std::abs(.3 * (i - 23.5) + .1 * (j - 23.5) + k - 23.5) / std::sqrt(1.1);
    const bool isIn = std::min({ i, j, k }) > 5 && std::max({ i, j, k }) < 42;
    return isIn && height < .75 ? 1 : 0;
  };
  const auto skin = [](int i, int j, int k)
  {
    const double radius = std::hypot(i - 8., j - 7., k - 6.);
    return radius < 4.2 ? 1 : radius < 4.7 ? 2 : radius > 6.6 && radius < 7.6 ? 3 : 0;
  };
  const auto laminate = [](int i, int, int) { return i % 6; };
  std::vector<LabelScene> scenes = { { "TiltedSheet", SceneOf({ 48, 48, 48 }, Cubes, tilted) },
    { "Skin", SceneOf({ 16, 14, 12 }, Cubes, skin) },
    { "Laminate", SceneOf({ 18, 9, 13 }, Cubes, laminate), {}, 3. },
    { "LaminateFlat", SceneOf({ 18, 9, 13 }, Cubes, laminate, true), Flat } };
  for (const double spacing : { 1.5, 3., 8., 20. }) // stepped labels with one slice between them
  {
    const auto apart = [](int i, int j, int k)
    {
      const int slice = k + (i + 2 * j) / 16;
      const bool isIn = std::min(i, j) > 1 && std::max(i, j) < 22 && slice > 3 && slice < 11;
      return isIn && slice != 7 ? 1 + slice / 8 : 0;
    };
    scenes.push_back({ "Apart" + std::to_string(static_cast<int>(10. * spacing)),
      SceneOf({ 24, 24, 14 }, { 1., 1., spacing }, apart) });
  }
  return scenes;
}

/** Rods and dots, also diagonal ones, labels of several parts, and noise. */
std::vector<LabelScene> ScatteredLabels()
{
  const auto rods = [](int i, int j, int k)
  {
    return i == 21 && j >= 6 && j <= 12 && k == 18 - j   ? 1
      : (i == 15 || i == 16) && j >= 19 && k / 2 == 4    ? 2
      : i == 23 && j == 1 && k == 12                     ? 3
      : i == 18 && j >= 6 && j <= 9 && k == j + 5        ? 5
      : j == 13 && i >= 17 && i <= 22 && k == 31 - i - 1 ? 6
                                                         : 0;
  };
  const auto parts = [](int i, int j, int k)
  {
    const Voxel offset = { i % 10 - 2, j % 10 - 2, k % 10 - 2 };
    const auto [x, y, z] = offset;
    const int length = std::max({ x, y, z });
    const bool isIn = std::min({ x, y, z }) >= 0 && length < 7;
    const int kind = (k / 10) % 4;
    const bool isOfPart = kind == 0 ? x == y && y == z
      : kind == 1                   ? x == y && z == 0
      : kind == 2                   ? length < 2
                                    : y == 0 && z == 0;
    return FarFrom(19.5, i, j, k) < 9. || (isIn && isOfPart && i / 10 % 3 == 0) ? 1 : 0;
  };
  const auto lesions = [](int i, int j, int k)
  {
    const bool isAtSide = std::min(k, 63 - k) < 8;
    const int away = std::abs(i % 8 - 4) + std::abs(j % 8 - 4) + std::abs(k % 8 - 4);
    return FarFrom(31.5, i, j, k) < 17. || (isAtSide && away < 2) ? 1 : 0;
  };
  return { { "Rods", SceneOf({ 24, 21, 15 }, Cubes, rods),
             [](vtkLabelsToSurfaces* f) { f->SetVoxelTolerance(1.); } },
    { "Parts", SceneOf({ 40, 40, 40 }, Cubes, parts), {}, 2., 8 }, // 8 are joined by corners
    { "Lesions", SceneOf({ 64, 64, 64 }, Cubes, lesions),
      [](vtkLabelsToSurfaces* f) { f->SetSmoothing(1.); } },
    { "Noise", NoiseScene(12, 11, 4), {}, 4. } };
}

class LabelTopology : public testing::TestWithParam<LabelScene>
{
};
}

TEST_P(LabelTopology, EqualsVoxelTopologyAndVolumes)
{
  const VoxelScene& scene = GetParam().Voxels;
  const auto filter = LabelSurfacesOf(ImageOf(scene), GetParam().Settings);
  const InterfaceMesh mesh = MeshOf(filter);
  ExpectSound(scene, mesh);
  ExpectContactsOfVoxels(scene, mesh);
  ExpectVolumes(filter, GetParam());
}

const auto NameOf = [](const testing::TestParamInfo<LabelScene>& info) { return info.param.Name; };
INSTANTIATE_TEST_SUITE_P(Inclusions, LabelTopology, testing::ValuesIn(Inclusions()), NameOf);
INSTANTIATE_TEST_SUITE_P(Small, LabelTopology, testing::ValuesIn(SmallLabels()), NameOf);
INSTANTIATE_TEST_SUITE_P(Sheets, LabelTopology, testing::ValuesIn(Sheets()), NameOf);
INSTANTIATE_TEST_SUITE_P(Scattered, LabelTopology, testing::ValuesIn(ScatteredLabels()), NameOf);

TEST(LabelParts, AreReported)
{
  const auto pieces = [](int i, int j, int k)
  {
    const bool isDot = i % 12 == 4 && j == 4 && k == 4;
    return FarFrom(18., i, j, k) < 7. ? 1 : isDot ? 1 + i / 24 : 0;
  };
  const auto filter = LabelSurfacesOf(LabelImageOf(48, 36, 36, pieces));
  for (unsigned int block = 0; block < 2; ++block)
  {
    EXPECT_EQ(FieldOf(BlockOf(filter, block), "Parts"), block == 0 ? 3. : 2.);
    EXPECT_EQ(FieldOf(BlockOf(filter, block), "WrongParts"), 2.) << "single voxels are too small";
  }
  vtkAbstractArray* missed = filter->GetOutput()->GetFieldData()->GetAbstractArray("LostLabels");
  ASSERT_TRUE(missed);
  EXPECT_EQ(vtkStringArray::SafeDownCast(missed)->GetValue(0),
    "The enclosed volume of parts differs from their voxels for Label 1 (2 of 3), Label 2 (2 of "
    "2). "
    "They are too small, scattered, or too thin for the triangles.");
}
