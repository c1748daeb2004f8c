// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankOutputs_h
#define volumicRankOutputs_h

#include "Core/Common/Communicator.h"

class vtkInformation;
class vtkInformationVector;
class vtkPolyData;

namespace volumic
{
/**
 * Brings each rank its part of the outputs of vtkDeformableSurface that rank 0 has filled: of each
 * surface a piece (SurfacePieces), with all field data, also where the piece is empty; blocks of
 * the same names; of the history the columns, whose rows stay at rank 0. With one rank nothing
 * changes. All ranks call it.
 * @param request, outputs as RequestData has them: how many ghost levels are asked for
 * @param piece what another rank has of the one surface of which rank 0 has but a piece, too
 *        (`GlobalIds`): its field data come from rank 0
 */
void ScatterOutputs(Communicator& ranks, vtkInformation* request, vtkInformationVector* outputs,
  vtkPolyData* piece);
}

#endif
