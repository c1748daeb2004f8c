// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelInterfaces_h
#define volumicLabelInterfaces_h

#include "Core/Evolution/SurfaceResult.h"
#include "Core/Image/VoxelBox.h"
#include "Core/Interfaces/InterfaceFields.h"
#include "Core/Interfaces/InterfaceMesh.h"
#include "Core/Interfaces/MakeInterfaces.h"
#include "Core/Labels/LabelBricks.h"
#include "Core/Labels/LabelMap.h"
#include "Host/HostThreads.h"
#include "Input/ComputationalSpace.h"
#include "Labels/LabelSettings.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

class vtkImageData;
class vtkPolyData;

namespace volumic
{
/** The surface of one object of a label map. */
struct LabelSurface
{
  vtkSmartPointer<vtkPolyData> Surface; ///< null: the run was stopped earlier
  vtkIdType MisclassifiedVoxels = 0;
  vtkIdType MissedVoxels = 0; ///< misclassified voxels farther from the surface than the tolerances
  double VolumeError = 0.0;   ///< enclosed volume divided by the volume of the voxels, minus 1
  vtkIdType Parts = 0;        ///< parts of voxels joined by faces, edges or corners
  vtkIdType MisclassifiedParts = 0; ///< parts whose volume differs by more than a quarter
  bool IsFinished = false;          ///< The run was not stopped.
};

/** Computes one mesh of all objects of a label map, and the surfaces of the selected ones. */
class LabelInterfaceMaker
{
public:
  /** Called with the finished fraction on the calling thread. Return false to stop. */
  using Progress = std::function<bool(double fraction, const std::string& text)>;

  /**
   * @param map      map with all objects, so that surfaces do not depend on the selection
   * @param selected objects that get surfaces, sorted
   * @param image    geometry of the map
   * @param settings settings, which must outlive this object
   * @throws InvalidArgument with periodic BoxFaces, if the map is not periodic or too short
   */
  LabelInterfaceMaker(LabelMap map, std::vector<int> selected, vtkImageData* image,
    const LabelSettings& settings, HostThreads& threads);

  /** Compute the mesh. It remains unfinished if `progress` returns false. */
  void Make(HostThreads& threads, const Progress& progress);

  /** Return a surface per selected object. `GlobalIds` are the points of Interfaces(). */
  std::vector<LabelSurface> Surfaces(HostThreads& threads) const;

  /**
   * Return the interfaces of selected objects, each once, and the junction lines, with the arrays
   * that vtkLabelsToSurfaces documents.
   * @param labels  labels of the selected objects
   * @param outside label of all other objects
   */
  vtkSmartPointer<vtkPolyData> Interfaces(const std::vector<int>& labels, int outside) const;

private:
  /** @throws InvalidArgument if the map is not periodic, or too short */
  void CheckPeriod() const;
  InterfaceOptions Options() const;
  /** Return the index of an object in Selected, or -1. */
  int SelectionOf(int object) const;
  bool IsShown(const InterfaceMesh::Face& face) const
  {
    return this->SelectionOf(face.Behind) >= 0 || this->SelectionOf(face.Front) >= 0;
  }
  /** Return the mean edge length in computational space. */
  double EdgeLength() const;
  /** Return the edges of junction lines with faces in Interfaces(). */
  std::vector<std::array<int, 2>> ShownLines() const;
  void AddLineFields(const std::vector<std::array<int, 2>>& lines, vtkPolyData* interfaces) const;
  LabelSurface SurfaceOf(int object, const std::vector<int>& faces) const;
  SurfaceResult ResultOf(int object, const std::vector<int>& faces, const IndexedSurface& ofMesh,
    const std::vector<int>& vertices) const;
  void CountVoxels(HostThreads& threads);
  /** Return the distance of a vertex of an object from the interface in its fields, world units. */
  float ResidualAt(int v, int object) const;
  /** Return the position of a vertex in computational space, exact in flat faces of the box. */
  Point PositionOf(int v) const;
  /** Return the side of the image that a face lies in, 1 to 6: x-min, x-max ...; 0: none. */
  unsigned char BoxFaceOf(const InterfaceMesh::Face& face) const
  {
    return static_cast<unsigned char>(
      this->Mesh.IsSide(face.Front) ? face.Front - this->Mesh.FirstSide + 1 : 0);
  }

  const LabelSettings& Settings;
  std::vector<int> Selected;              ///< objects, sorted
  std::array<int, 3> First = { 0, 0, 0 }; ///< first voxel of Map in the image
  LabelMap Map;                           ///< the box of all objects, with a margin
  LabelMap WholeMap; ///< with the parts that KeepComponents removes from Map; empty if none
  VoxelBox Image;    ///< the image, in voxels of Map
  VoxelBox InImage;  ///< the part of Map inside the image
  ComputationalSpace Space;
  std::optional<LabelBricks> Bricks;
  std::optional<LabelBricks> WholeBricks; ///< bricks of WholeMap
  std::optional<InterfaceFields> Fields;
  InterfaceMesh Mesh;
  std::vector<LabelSurface> Counts; ///< counts of each object, without a surface
  std::vector<int> IdOf;            ///< the point of each vertex in Interfaces(), or -1
  bool IsFinished = false;
};
}

#endif
