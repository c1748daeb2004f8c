// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankInputs_h
#define volumicRankInputs_h

#include "Ranks/Ranks.h"

#include <vtkSmartPointer.h>

class vtkAlgorithm;
class vtkDataObject;
class vtkInformation;
class vtkInformationVector;
class vtkPolyData;

namespace volumic
{
/** What RequestData and RequestUpdateExtent of a filter are given. */
struct FilterCall
{
  vtkAlgorithm* Filter;
  vtkInformation* Request;
  vtkInformationVector** Inputs;
  vtkInformationVector* Outputs;
};

/**
 * In RequestUpdateExtent: where ranks work together each asks all inputs for its piece, as sources
 * that cannot give pieces give the first one all; else the first process asks for the whole.
 * @return whether they work together
 */
bool AskForInputs(vtkMultiProcessController* controller, const FilterCall& call);

/**
 * At the first rank: the images at an input port of which ranks have pieces, whole, in memory that
 * may be scratch memory; of a pyramid's levels all. What this rank has all of is as it came.
 * @throws std::invalid_argument if they don't lie in one image, or leave voxels out; where one has
 *         something else.
 */
vtkSmartPointer<vtkDataObject> TakeImages(Ranks& ranks, const FilterCall& call, int port);

/** Likewise, of a surface, or of points (Pieces.h). Null where nobody has any. */
vtkSmartPointer<vtkPolyData> TakePoints(Ranks& ranks, const FilterCall& call, int port);

/** At the others: gives what these ask for. */
RankMessage AnswerForInputs(RankQuestion question, RankMessage& message, const FilterCall& call);
}

#endif
