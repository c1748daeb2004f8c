// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInterfaceStart_h
#define volumicInterfaceStart_h

#include "Core/Common/Executor.h"
#include "Core/Interfaces/InterfaceFields.h"
#include "Core/Interfaces/InterfaceMesh.h"

namespace volumic
{
/**
 * The first interfaces of the objects of a label map: those of their voxels (MakeDualMesh). Of two
 * objects that meet across a voxel edge that of fewer voxels holds together, then that of the lower
 * number; object 0 is the last one.
 *
 * Objects that end at a box end at the outer faces of its voxels. In a periodic one the layer of
 * voxels at a side is halved: the outer half has, at both of two opposite sides, the object whose
 * field is the largest between the first voxel and the last one.
 */
InterfaceMesh StartInterfaces(const InterfaceFields& fields, Executor& executor);
}

#endif
