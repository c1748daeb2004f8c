// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankOutputs_h
#define volumicRankOutputs_h

#include "Core/Common/Communicator.h"

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <map>

class vtkInformation;
class vtkInformationVector;

namespace volumic
{
/** Of some levels what a rank has of the surface, but for field data. */
using PiecesOfLevels = std::map<int, vtkSmartPointer<vtkPolyData>>;

/**
 * Brings each rank its part of the outputs of vtkDeformableSurface that rank 0 has filled: of each
 * surface a piece (SurfacePieces), with all field data, also where the piece is empty; blocks of
 * the same names; of the history the columns, whose rows stay at rank 0. With one rank nothing
 * changes. All ranks call it.
 * @param request, outputs as RequestData has them: how many ghost levels are asked for
 * @param pieces what another rank has of the surfaces of which rank 0 has but a piece, too
 *        (`GlobalIds`): their field data come from rank 0
 */
void ScatterOutputs(Communicator& ranks, vtkInformation* request, vtkInformationVector* outputs,
  const PiecesOfLevels& pieces);
}

#endif
