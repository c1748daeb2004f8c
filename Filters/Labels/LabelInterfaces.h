// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelInterfaces_h
#define volumicLabelInterfaces_h

#include "Core/Image/VoxelBox.h"
#include "Core/Interfaces/InterfaceFields.h"
#include "Core/Interfaces/InterfaceMesh.h"
#include "Core/Interfaces/MakeInterfaces.h"
#include "Core/Labels/LabelBricks.h"
#include "Core/Labels/LabelMap.h"
#include "Host/HostThreads.h"
#include "Input/Workspace.h"
#include "Labels/LabelSettings.h"
#include "Labels/LabelSurface.h"

#include <vtkSmartPointer.h>

#include <array>
#include <optional>
#include <vector>

class vtkImageData;
class vtkPolyData;

namespace volumic
{
/** Makes the surfaces of all labels with what they share, as one mesh. */
class LabelInterfaceMaker
{
public:
  /**
   * @param map     objects up to `objects` are the labels', others are outside
   * @param image   its geometry is the map's
   * Settings must outlive it.
   * @throws std::invalid_argument as LabelSurfaceMaker.
   */
  LabelInterfaceMaker(LabelMap map, int objects, vtkImageData* image, const LabelSettings& settings,
    HostThreads& threads);

  /** @param progress as LabelSurfaceMaker's; after false what there is is not finished. */
  void Make(HostThreads& threads, const LabelSurfaceMaker::Progress& progress);

  /** A surface per label, whose points are those of the interfaces: `GlobalIds`. */
  std::vector<LabelSurface> Surfaces(HostThreads& threads) const;

  /**
   * All interfaces, each once, with `BoundaryLabels` and `Junction`, with a tolerance `EdgeSize`,
   * with flat faces of the box `BoxFace`, and the lines where they meet, with `WorstAngle`
   * and `SmallContacts`.
   * @param labels of the objects, from 1 on
   * @param outside the value outside
   */
  vtkSmartPointer<vtkPolyData> Interfaces(const std::vector<int>& labels, int outside) const;

private:
  /** What is about all objects, from the first voxel of a brick on. */
  static VoxelBox BoxOf(const LabelMap& map, int objects);
  /** That part of the map with a margin, and 0 for all that is no object of a label. */
  static LabelMap Padded(const LabelMap& map, int objects, const VoxelBox& box, int margin);
  /** @throws std::invalid_argument where the map is not periodic, or too short. */
  void CheckPeriod() const;
  InterfaceOptions Options() const; ///< as the settings ask for
  /** What voxels are counted in. */
  const LabelBricks& Counted() const
  {
    return this->WholeBricks ? *this->WholeBricks : *this->Bricks;
  }
  /** Adds the field data of lines, where there are some. */
  void TellOfLines(vtkPolyData* interfaces) const;
  LabelSurface SurfaceOf(int object, const std::vector<int>& faces) const;
  Point InWorkspace(const Vector& place) const;
  /** Of a vertex in the workspace, at flat faces of the box to the last bit. */
  Point PlaceOf(int v) const;
  /** At which side of the image a face is, 1 to 6: x-min, x-max, y-min ...; 0: none. */
  unsigned char BoxFaceOf(const InterfaceMesh::Face& face) const
  {
    return static_cast<unsigned char>(
      this->Mesh.IsSide(face.Front) ? face.Front - this->Mesh.FirstSide + 1 : 0);
  }

  const LabelSettings& Settings;
  std::array<int, 3> First = { 0, 0, 0 }; ///< voxel of the image that is that of Map
  LabelMap Map;                           ///< of the box, with its margin
  LabelMap WholeMap; ///< the same with the parts that Keep Components leaves out, if it does
  VoxelBox InImage;  ///< of Map what is in the image
  Workspace Space;
  std::optional<LabelBricks> Bricks;
  std::optional<LabelBricks> WholeBricks; ///< of WholeMap
  std::optional<InterfaceFields> Fields;
  InterfaceMesh Mesh;
  bool IsFinished = false;
};
}

#endif
