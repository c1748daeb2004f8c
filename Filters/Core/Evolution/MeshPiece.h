// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicMeshPiece_h
#define volumicMeshPiece_h

#include "Core/Common/Communicator.h"
#include "Core/Common/Executor.h"
#include "Core/Mesh/Division.h"
#include "Core/Mesh/SurfaceMesh.h"

#include <vector>

namespace volumic
{
/**
 * What a rank has of a mesh that is about to be divided. It is numbered as one rank would number
 * the whole, along a curve, without free places. One rank alone has the whole.
 */
struct MeshPiece
{
  SurfaceMesh Mesh;        ///< As long as the whole. Own vertices, and two rings of others.
  std::vector<int> Own;    ///< In order.
  std::vector<int> Others;
};

/** A mesh that is whole, by the one rank that has it. */
MeshPiece RenumberWhole(SurfaceMesh mesh, double cell, Executor& executor);

/**
 * By all ranks. @param own vertices of this rank, in order; three rings about them are there, too
 * @param cell side of the cells of the curve, see SpaceFillingOrder()
 */
MeshPiece RenumberOnRanks(Communicator& ranks, const SurfaceMesh& mesh,
  const std::vector<int>& own, double cell, Executor& executor);

/**
 * By all ranks, with the mesh as each of them has it: rank 0 gets the whole, the others none. Its
 * vertices keep their places. @param own vertices of this rank, in order
 */
SurfaceMesh GatherMesh(Communicator& ranks, SurfaceMesh mesh, const std::vector<int>& own);

/** By all ranks: the numbers that this one's part of a division asks for. */
DivisionNumbers NumberForDivision(Communicator& ranks, const MeshPiece& piece,
  const KeptEdges* kept, Executor& executor);

/** The vertices that Divide() makes of this rank's piece. */
std::vector<int> DividedOf(
  const MeshPiece& piece, const DivisionNumbers& numbers, const KeptEdges* kept);
}

#endif
