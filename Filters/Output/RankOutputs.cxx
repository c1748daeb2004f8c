// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Output/RankOutputs.h"

#include "Input/SurfaceFile.h"
#include "Output/SurfacePieces.h"

#include <vtkAbstractArray.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataObject.h>
#include <vtkExecutive.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTable.h>

#include <algorithm>
#include <cstddef>
#include <string>

namespace volumic
{
namespace
{
/** @param whole at rank 0 @return the piece of this rank */
vtkSmartPointer<vtkPolyData> ScatterSurface(
  Communicator& ranks, vtkPolyData* whole, int ghostLevels)
{
  if (ranks.Rank() != 0)
  {
    return SurfaceFrom(ranks.Pass(0, ranks.Rank()));
  }
  const SurfacePieces pieces(whole, ranks.NumberOfRanks(), ghostLevels);
  for (int rank = 1; rank < ranks.NumberOfRanks(); ++rank)
  {
    ranks.Pass(0, rank, MessageOf(pieces.Piece(rank)));
  }
  return pieces.Piece(0);
}

vtkPolyData* SurfaceOf(vtkMultiBlockDataSet* blocks, unsigned int block)
{
  return vtkPolyData::SafeDownCast(blocks->GetBlock(block));
}

/** A line per block: `1` where there is a surface, `0` else, and the name. */
std::string Describe(vtkMultiBlockDataSet* blocks)
{
  std::string text;
  for (unsigned int block = 0; block < blocks->GetNumberOfBlocks(); ++block)
  {
    text += SurfaceOf(blocks, block) ? '1' : '0';
    text += blocks->GetMetaData(block)->Get(vtkCompositeDataSet::NAME());
    text += '\n';
  }
  return text;
}

void ScatterBlocks(Communicator& ranks, vtkMultiBlockDataSet* blocks, int ghostLevels)
{
  const std::string own = ranks.Rank() == 0 ? Describe(blocks) : "";
  const Message all = ranks.Broadcast(Message(own.begin(), own.end()));
  const std::string text(all.begin(), all.end());
  unsigned int block = 0;
  for (std::size_t begin = 0; begin < text.size(); ++block)
  {
    const std::size_t end = text.find('\n', begin);
    const bool isThere = text[begin] == '1';
    vtkSmartPointer<vtkPolyData> piece;
    if (isThere)
    {
      vtkPolyData* whole = ranks.Rank() == 0 ? SurfaceOf(blocks, block) : nullptr;
      piece = ScatterSurface(ranks, whole, ghostLevels);
    }
    blocks->SetBlock(block, piece);
    blocks->GetMetaData(block)->Set(
      vtkCompositeDataSet::NAME(), text.substr(begin + 1, end - begin - 1).c_str());
    begin = end + 1;
  }
}

/** A line per column: its type and its name. */
void ScatterColumns(Communicator& ranks, vtkTable* table)
{
  MessageWriter columns;
  for (vtkIdType c = 0; ranks.Rank() == 0 && c < table->GetNumberOfColumns(); ++c)
  {
    columns.Add(table->GetColumn(c)->GetDataType());
    columns.AddArray(std::string(table->GetColumn(c)->GetName()));
  }
  const Message all = ranks.Broadcast(columns.Take());
  MessageReader reader(all);
  while (ranks.Rank() != 0 && !reader.IsAtEnd())
  {
    auto column = vtkSmartPointer<vtkAbstractArray>::Take(
      vtkAbstractArray::CreateArray(reader.Take<int>()));
    std::string name;
    reader.TakeArray(name);
    column->SetName(name.c_str());
    table->AddColumn(column);
  }
}
}

void ScatterOutputs(Communicator& ranks, vtkInformation* request, vtkInformationVector* outputs)
{
  if (ranks.NumberOfRanks() == 1)
  {
    return;
  }
  const int port = std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT()));
  const int ghostLevels = BroadcastValue(ranks,
    outputs->GetInformationObject(port)->Get(
      vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_GHOST_LEVELS()));
  vtkPolyData* surface = vtkPolyData::GetData(outputs, 0);
  const bool isThere = BroadcastValue(ranks, surface->GetPoints() != nullptr);
  if (isThere)
  {
    surface->ShallowCopy(ScatterSurface(ranks, surface, ghostLevels));
  }
  ScatterBlocks(ranks, vtkMultiBlockDataSet::GetData(outputs, 1), ghostLevels);
  ScatterColumns(ranks, vtkTable::GetData(outputs, 2));
  ScatterBlocks(ranks, vtkMultiBlockDataSet::GetData(outputs, 3), ghostLevels);
}
}
