// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTetrahedra_h
#define volumicTetrahedra_h

#include <vtkSmartPointer.h>
#include <vtkType.h>
#include <vtkUnstructuredGrid.h>

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

class vtkPolyData;

namespace tool
{
class ProgressLine;

/** Tetrahedra that fill a surface, or the interfaces of labels, each within one label. */
struct Solid
{
  /** Its triangles and first points are those of the surface; cell array `Label`, field data as the
   * surface's. */
  vtkSmartPointer<vtkUnstructuredGrid> Grid;
  std::map<int, std::string> Names; ///< of the labels, by the numbers in the grid
  std::string Mesher;               ///< the program that made it

  // What the tetrahedra are like, in degrees: the least angle between two faces, and that under
  // which 1 % of them have one.
  double LeastAngle = 0.0;
  double PercentAngle = 0.0;

  struct Region
  {
    vtkIdType Tetrahedra = 0;
    double Volume = 0.0; ///< world units cubed
  };
  std::map<int, Region> Regions; ///< by the numbers in the grid

  /** At flat faces of a box, by BoxFace less 1, the nodes; those of edges and corners are in
   * several. */
  std::array<std::set<vtkIdType>, 6> BoxNodes;
};

/** How solids are made of surfaces. */
struct SolidChoice
{
  std::string Mesher;         ///< "tetgen" or "gmsh"; empty: the first one that is installed
  double MaximumVolume = 0.0; ///< of a tetrahedron, world units cubed, gmsh: about; 0: none
};

/** @return the mesher that will be run. @throws Failure that says what to install if there is none
 */
std::string FindMesher(const SolidChoice& choice);

/** Whether a file of this name holds tetrahedra: .vtu and .inp do, .msh where a mesher is chosen.
 */
bool NeedsMesher(const std::string& name, const SolidChoice& choice);

/**
 * Makes solids of surfaces by TetGen or gmsh, which are run as programs, as their licences are not
 * ours. Keeps the last one, for the next file of the same surface.
 */
class SolidMaker
{
public:
  /** @param isInterrupted asked while the program runs; may be null */
  explicit SolidMaker(const SolidChoice& choice, bool (*isInterrupted)() = nullptr)
    : Choice(choice), IsInterrupted(isInterrupted)
  {
  }

  const SolidChoice Choice;
  bool (*const IsInterrupted)();

  /**
   * @param beside a file, in whose folder the program gets one for its own files, while it runs
   * @throws Failure without the name of a file: what the program says where it fails, or that there
   * was an interrupt
   */
  const Solid& Make(vtkPolyData* surface, const std::string& beside, ProgressLine& line);

  /** What was made; its Grid is null where nothing was. */
  const Solid& Last() const { return this->Made; }

private:
  Solid Made;
  vtkSmartPointer<vtkPolyData> Surface; ///< of which it was made
};

// ---- Files --------------------------------------------------------------------------------------

/**
 * MSH 2.2 of gmsh, as text, which all solvers' importers read: the tetrahedra and the triangles
 * between two labels, or a label and the outside, in named physical groups.
 */
void WriteSolidMsh(const Solid& solid, const std::string& path, const std::string& remark);

/**
 * Abaqus's and CalculiX's .inp: nodes, elements C3D4, for each label a set of elements and one of
 * nodes, for each two labels that touch, or one and the outside, an element surface and a set of
 * nodes, and one for each flat face of a box, x_min and so on. Names are letters, digits and
 * underscores. Materials and steps are the user's.
 */
void WriteInp(const Solid& solid, const std::string& path, const std::string& remark);
}

#endif
