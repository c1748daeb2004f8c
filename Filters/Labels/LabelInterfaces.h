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
  vtkSmartPointer<vtkPolyData> Surface; ///< null: the run was stopped before there was one
  vtkIdType MisclassifiedVoxels = 0;    ///< misclassified voxels
  vtkIdType MissedVoxels = 0; ///< misclassified voxels further from the surface than the tolerances
  double VolumeError = 0.0;   ///< enclosed volume over the voxels' volume, less 1
  vtkIdType Parts = 0;        ///< of voxels joined by faces, edges or corners
  vtkIdType MisclassifiedParts = 0; ///< those whose volume is off by more than a quarter
  bool IsFinished = false;          ///< The run was not stopped.
};

/** Makes one mesh of all objects of a label map, and the surfaces of those that are selected. */
class LabelInterfaceMaker
{
public:
  /** Called with the share that is done, on the calling thread; false requests to stop. */
  using Progress = std::function<bool(double share, const std::string& text)>;

  /**
   * @param map      with all objects, so that a surface does not depend on which are selected
   * @param selected the objects that get surfaces, sorted
   * @param image    its geometry is the map's
   * Settings must outlive it.
   * @throws std::invalid_argument if BoxFaces are periodic, and the map is not, or is too short.
   */
  LabelInterfaceMaker(LabelMap map, std::vector<int> selected, vtkImageData* image,
    const LabelSettings& settings, HostThreads& threads);

  /** After progress has returned false the mesh is what there is by then, and not finished. */
  void Make(HostThreads& threads, const Progress& progress);

  /** Return a surface per selected object, whose `GlobalIds` are points of Interfaces(). */
  std::vector<LabelSurface> Surfaces(HostThreads& threads) const;

  /**
   * Return the interfaces with a selected object on a side, each once, and the lines where they
   * meet, with the arrays that vtkLabelsToSurfaces documents.
   * @param labels  of the selected objects
   * @param outside the value of all else
   */
  vtkSmartPointer<vtkPolyData> Interfaces(const std::vector<int>& labels, int outside) const;

private:
  /** @throws std::invalid_argument if the map is not periodic, or too short. */
  void CheckPeriod() const;
  InterfaceOptions Options() const;
  /** Return the place of an object among those that are selected; -1: it is not. */
  int SelectionOf(int object) const;
  bool IsShown(const InterfaceMesh::Face& face) const
  {
    return this->SelectionOf(face.Behind) >= 0 || this->SelectionOf(face.Front) >= 0;
  }
  /** Return the mean edge length in the workspace. */
  double EdgeLength() const;
  /** Return the edges of junction lines at which there are faces of Interfaces(). */
  std::vector<std::array<int, 2>> ShownLines() const;
  /** Add the field data of junction lines, if there are any. */
  void AddLineFields(const std::vector<std::array<int, 2>>& lines, vtkPolyData* interfaces) const;
  LabelSurface SurfaceOf(int object, const std::vector<int>& faces) const;
  SurfaceResult ResultOf(int object, const std::vector<int>& faces, const IndexedSurface& ofMesh,
    const std::vector<int>& vertices) const;
  /** Compare all objects with their voxels. */
  void CountVoxels(HostThreads& threads);
  /** Return how far the fields have the interface from a vertex of an object, world units. */
  float ResidualAt(int v, int object) const;
  /** Return the position of a vertex in the workspace, exact in flat faces of the box. */
  Point PositionOf(int v) const;
  /** Return the side of the image that a face lies in, 1 to 6: x-min, x-max ...; 0: none. */
  unsigned char BoxFaceOf(const InterfaceMesh::Face& face) const
  {
    return static_cast<unsigned char>(
      this->Mesh.IsSide(face.Front) ? face.Front - this->Mesh.FirstSide + 1 : 0);
  }

  const LabelSettings& Settings;
  std::vector<int> Selected;              ///< objects, sorted
  std::array<int, 3> First = { 0, 0, 0 }; ///< voxel of the image that is that of Map
  LabelMap Map;                           ///< of the box, with its margin
  LabelMap WholeMap; ///< the same with the parts that Keep Components leaves out, if it does
  VoxelBox InImage;  ///< of Map what is in the image
  ComputationalSpace Space;
  std::optional<LabelBricks> Bricks;
  std::optional<LabelBricks> WholeBricks; ///< of WholeMap
  std::optional<InterfaceFields> Fields;
  InterfaceMesh Mesh;
  std::vector<LabelSurface> Counts; ///< numbers of each object, parts aside, without a surface
  std::vector<int> IdOf;            ///< of each vertex its point in Interfaces(), -1: it has none
  bool IsFinished = false;
};
}

#endif
