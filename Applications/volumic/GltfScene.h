// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicGltfScene_h
#define volumicGltfScene_h

#include "Messages.h"

#include <string>
#include <vector>

class vtkPolyData;

namespace tool
{
/** A surface of a scene. */
struct SceneObject
{
  std::string Name;
  vtkPolyData* Surface;
};

/**
 * Write surfaces as a scene of glTF 2.0, binary (.glb): a node and a mesh for each, with normals,
 * and a material of its colour for each label. VTK's writers of glTF know no names, or need a
 * window.
 *
 * Lengths are those of the world. All vertices are told from the middle of the scene, as single
 * precision, so that those that surfaces share stay the same; a node about all moves them back, and
 * turns the world's z upwards, which is y in glTF.
 * @throws Failure without the name of the file
 */
void WriteGlb(const std::vector<SceneObject>& objects, const std::string& path, ProgressLine& line);

/**
 * Write surfaces as .3mf, for printers: an object for each, with its name, and a material of its
 * colour for each label. Lengths have the surfaces' unit, millimetres where that is not told.
 * @throws Failure without the name of the file
 */
void WriteThreeMf(
  const std::vector<SceneObject>& objects, const std::string& path, ProgressLine& line);
}

#endif
