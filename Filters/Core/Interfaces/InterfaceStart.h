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
 * Create the initial interfaces of a label map from its voxels (MakeDualMesh). Of two objects that
 * meet across a voxel edge, the one with fewer voxels is connected, then the one with the lower
 * number. Object 0 has the highest rank.
 *
 * Objects that end at a box end at the outer faces of its voxels. In a periodic box, each layer of
 * voxels at a side is halved. On both opposite sides, the outer half gets the object with the
 * largest field between the first and the last voxel.
 */
InterfaceMesh StartInterfaces(const InterfaceFields& fields, Executor& executor);
}

#endif
