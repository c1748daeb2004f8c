// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVolumeImage_h
#define volumicVolumeImage_h

#include <vtkSmartPointer.h>

#include <array>
#include <cstddef>
#include <string>

class vtkDataArray;
class vtkDataObject;
class vtkImageData;

namespace tool
{
using Vector3 = std::array<double, 3>;

/** Where a voxel image lies in the world. */
struct VolumePlacement
{
  Vector3 Spacing = { 1.0, 1.0, 1.0 }; ///< world units
  Vector3 Origin = { 0.0, 0.0, 0.0 };  ///< the first voxel's centre, world units
  /** The unit vectors of the index axes x, y, z in the world. */
  std::array<Vector3, 3> Axes = { { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };

  /** The steps from voxel to voxel, and the place of the first one. */
  std::array<double, 12> Numbers() const;
  std::string Text() const; ///< of these

  /** Whether of so many voxels each lies at the same place, to a tenth of a voxel. */
  bool IsLike(const VolumePlacement& other, const int* size) const;

  /** Whether spacings are positive, and the axes unit vectors of which none lies along others. */
  bool IsSpace() const;

  /** Whether the axes are unit vectors at right angles, but for the digits of headers. */
  bool HasRightAngles() const;

  /** Have an index axis point the other way, the first voxel staying where it is, if it is so. */
  void Turn(std::size_t axis, bool isSo)
  {
    for (double& along : this->Axes[axis])
    {
      along *= isSo ? -1.0 : 1.0;
    }
  }

  /** Split vectors from voxel to voxel into Spacing and Axes. */
  void SetSteps(const std::array<Vector3, 3>& steps);
};

/**
 * Give the image its place.
 * @throws Failure if spacings are not positive or axes are not at right angles.
 */
void PlaceImage(vtkImageData* image, const VolumePlacement& placement);

/**
 * Tell which side of the body the world axes x, y, z point to, as the field data `Axes`: three
 * letters of L R, A P, S I (left, right, anterior, posterior, superior, inferior). DICOM has "LPS",
 * NIfTI "RAS". Images of files that don't tell have none.
 */
void SetWorldAxes(vtkImageData* image, const std::string& axes);

/** Where the voxels of an image lie, from that of index 0 on. */
VolumePlacement PlacementOf(vtkImageData* image);

/** Other field data that are a text, and what there is: "" for nothing. */
void SetFact(vtkDataObject* data, const std::string& name, const std::string& text);
std::string GetFact(vtkDataObject* data, const std::string& name);

/** Turn values that are as a file has them, big-endian or not, into those of this machine. */
void ToNativeOrder(vtkDataArray* values, bool isBig);

/** An array of float: slope times value plus shift. */
vtkSmartPointer<vtkDataArray> Rescaled(vtkDataArray* values, double slope, double shift);

/**
 * The smallest and the largest of a component, or, for -1, of the magnitude; of a component that is
 * not there the first of both is the larger one.
 */
std::array<double, 2> RangeOf(vtkDataArray* values, int component);

double Dot(const Vector3& a, const Vector3& b);
Vector3 Cross(const Vector3& a, const Vector3& b);
}

#endif
