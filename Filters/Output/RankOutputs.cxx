// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Output/RankOutputs.h"

#include "Input/SurfaceFile.h"
#include "Output/SurfacePieces.h"

#include <vtkAbstractArray.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTable.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

namespace volumic
{
namespace
{
/** What scattering needs to know. */
struct Scattering
{
  Communicator& Ranks;
  int GhostLevels;
  const PiecesOfLevels& Pieces; ///< see ScatterOutputs()
};

/** The piece that each rank has of a level, with the field data of rank 0's. */
vtkSmartPointer<vtkPolyData> WithFacts(const Scattering& about, vtkPolyData* surface)
{
  const bool isFirst = about.Ranks.Rank() == 0;
  vtkNew<vtkPolyData> facts;
  facts->SetPoints(vtkNew<vtkPoints>());
  Message message;
  if (isFirst)
  {
    facts->SetFieldData(surface->GetFieldData());
    message = MessageOf(facts);
  }
  facts->SetFieldData(SurfaceFrom(about.Ranks.Broadcast(std::move(message)))->GetFieldData());
  const int level =
    static_cast<int>(facts->GetFieldData()->GetArray("Level")->GetComponent(0, 0));
  auto own = vtkSmartPointer<vtkPolyData>::New();
  own->ShallowCopy(isFirst ? surface : about.Pieces.at(level).Get());
  own->SetFieldData(facts->GetFieldData());
  return own;
}

/** @param surface at rank 0 all of it, or its piece @return the piece of this rank */
vtkSmartPointer<vtkPolyData> ScatterSurface(const Scattering& about, vtkPolyData* surface)
{
  Communicator& ranks = about.Ranks;
  const bool isFirst = ranks.Rank() == 0;
  const bool isPiece =
    BroadcastValue(ranks, isFirst && surface->GetPointData()->GetGlobalIds() != nullptr);
  vtkSmartPointer<vtkPolyData> whole = surface;
  if (isPiece)
  {
    const auto own = WithFacts(about, surface);
    if (about.GhostLevels <= 0)
    {
      return own;
    }
    whole = JoinPieces(ranks.Gather(MessageOf(own)));
  }
  if (!isFirst)
  {
    return SurfaceFrom(ranks.Pass(0, ranks.Rank()));
  }
  const SurfacePieces pieces(whole, ranks.NumberOfRanks(), about.GhostLevels);
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

void ScatterBlocks(const Scattering& about, vtkMultiBlockDataSet* blocks)
{
  Communicator& ranks = about.Ranks;
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
      piece = ScatterSurface(about, ranks.Rank() == 0 ? SurfaceOf(blocks, block) : nullptr);
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

void ScatterOutputs(Communicator& ranks, vtkInformation* request, vtkInformationVector* outputs,
  const PiecesOfLevels& pieces)
{
  if (ranks.NumberOfRanks() == 1)
  {
    return;
  }
  const int port = std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT()));
  const int ghostLevels = BroadcastValue(ranks,
    outputs->GetInformationObject(port)->Get(
      vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_GHOST_LEVELS()));
  const Scattering about{ ranks, ghostLevels, pieces };
  vtkPolyData* surface = vtkPolyData::GetData(outputs, 0);
  const bool isThere = BroadcastValue(ranks, surface->GetPoints() != nullptr);
  if (isThere)
  {
    surface->ShallowCopy(ScatterSurface(about, surface));
  }
  ScatterBlocks(about, vtkMultiBlockDataSet::GetData(outputs, 1));
  ScatterColumns(ranks, vtkTable::GetData(outputs, 2));
  ScatterBlocks(about, vtkMultiBlockDataSet::GetData(outputs, 3));
}
}
