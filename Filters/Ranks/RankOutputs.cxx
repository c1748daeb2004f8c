// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/RankOutputs.h"

#include "Host/WholeInput.h"
#include "Ranks/SurfacePieces.h"

#include <vtkAbstractArray.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkExtentTranslator.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkTable.h>

#include <algorithm>
#include <string>

namespace volumic
{
namespace
{
/** How outputs are cut. */
struct Cut
{
  Dealing Deals;
  int Ghosts;
};

/** Of no voxels where there are more ranks than that gives: null. */
vtkSmartPointer<vtkImageData> PieceOf(vtkImageData* image, int rank, int ranks, int ghosts)
{
  int whole[6];
  image->GetExtent(whole);
  int own[6];
  int extent[6];
  vtkNew<vtkExtentTranslator> translator;
  constexpr int mode = vtkExtentTranslator::BLOCK_MODE;
  if (!translator->PieceToExtentThreadSafe(rank, ranks, 0, whole, own, mode, 0) ||
    !translator->PieceToExtentThreadSafe(rank, ranks, ghosts, whole, extent, mode, 0))
  {
    return nullptr;
  }
  auto piece = vtkSmartPointer<vtkImageData>::New();
  piece->ShallowCopy(image);
  piece->Crop(extent);
  if (ghosts > 0)
  {
    piece->GenerateGhostArray(own);
  }
  return piece;
}

/** The kinds of data that there are in outputs. */
enum class Kind : int
{
  Nothing,
  Surface,
  Image,
  Blocks, ///< Their names and fields; they come one by one.
  Table
};

Kind KindOf(vtkDataObject* data)
{
  return vtkPolyData::SafeDownCast(data)      ? Kind::Surface
    : vtkImageData::SafeDownCast(data)         ? Kind::Image
    : vtkMultiBlockDataSet::SafeDownCast(data) ? Kind::Blocks
    : vtkTable::SafeDownCast(data)             ? Kind::Table
                                               : Kind::Nothing;
}

void PutColumns(RankMessage& message, vtkTable* table)
{
  vtkNew<vtkDataSetAttributes> columns;
  columns->CopyAllOn();
  columns->CopyAllocate(table->GetRowData());
  message.Put(columns.Get());
}

void PutBlocks(RankMessage& message, vtkMultiBlockDataSet* blocks)
{
  message.Words << static_cast<int>(blocks->GetNumberOfBlocks());
  for (unsigned int block = 0; block < blocks->GetNumberOfBlocks(); ++block)
  {
    const char* name = blocks->HasMetaData(block)
      ? blocks->GetMetaData(block)->Get(vtkCompositeDataSet::NAME())
      : nullptr;
    message.Words << std::string(name ? name : "");
  }
  message.Put(blocks->GetFieldData());
}

void TakeBlocks(RankMessage& message, vtkMultiBlockDataSet* blocks)
{
  int count = 0;
  message.Words >> count;
  blocks->SetNumberOfBlocks(static_cast<unsigned int>(count));
  for (unsigned int block = 0; block < blocks->GetNumberOfBlocks(); ++block)
  {
    std::string name;
    message.Words >> name;
    if (!name.empty())
    {
      blocks->GetMetaData(block)->Set(vtkCompositeDataSet::NAME(), name.c_str());
    }
  }
  message.TakeInto(blocks->GetFieldData());
}

/**
 * Gives others their part of an output, or of a block of it (-1: none). @return that of this rank
 */
vtkSmartPointer<vtkDataObject> Deal(
  Ranks& ranks, vtkDataObject* data, int port, int block, const Cut& cut)
{
  const bool isWhole = cut.Deals == Dealing::FirstHasAll;
  auto* surface = vtkPolyData::SafeDownCast(data);
  auto* image = vtkImageData::SafeDownCast(data);
  if (surface && !surface->GetPoints())
  {
    return surface; // There is none on any rank.
  }
  const SurfacePieces pieces(surface, isWhole ? 1 : ranks.Count(), cut.Ghosts);
  for (int rank = 1; rank < ranks.Count(); ++rank)
  {
    RankMessage part;
    part.Words << port << block << static_cast<int>(KindOf(data));
    if (surface)
    {
      part.Put(isWhole ? vtkSmartPointer<vtkPolyData>::New().Get() : pieces.Piece(rank).Get());
    }
    else if (image)
    {
      part.Put(PieceOf(image, rank, ranks.Count(), cut.Ghosts).Get());
    }
    else if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(data))
    {
      PutBlocks(part, blocks);
    }
    else if (auto* table = vtkTable::SafeDownCast(data))
    {
      PutColumns(part, table);
    }
    ranks.Ask(rank, RankQuestion::Output, part);
  }
  if (isWhole || (!surface && !image))
  {
    return data;
  }
  if (image)
  {
    return PieceOf(image, 0, ranks.Count(), cut.Ghosts);
  }
  return pieces.Piece(0);
}

void DealAll(Ranks& ranks, const FilterCall& call, Dealing deals)
{
  const Cut cut{ deals, GhostLevelsAskedOf(call.Request, call.Outputs) };
  for (int port = 0; port < call.Outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject* output = vtkDataObject::GetData(call.Outputs, port);
    const vtkSmartPointer<vtkDataObject> own = Deal(ranks, output, port, -1, cut);
    if (own != output)
    {
      output->ShallowCopy(own);
    }
    auto* blocks = vtkMultiBlockDataSet::SafeDownCast(output);
    for (unsigned int block = 0; blocks && block < blocks->GetNumberOfBlocks(); ++block)
    {
      if (vtkDataObject* data = blocks->GetBlock(block))
      {
        blocks->SetBlock(block, Deal(ranks, data, port, static_cast<int>(block), cut));
      }
    }
  }
}

/** At another rank. */
void TakeOutput(RankMessage& message, vtkInformationVector* outputs)
{
  int port = 0;
  int block = 0;
  int kind = 0;
  message.Words >> port >> block >> kind;
  vtkDataObject* output = vtkDataObject::GetData(outputs, port);
  vtkSmartPointer<vtkDataObject> data;
  switch (static_cast<Kind>(kind))
  {
    case Kind::Surface:
      data = message.TakeSurface();
      break;
    case Kind::Image:
      data = message.TakeImage();
      break;
    case Kind::Blocks:
      TakeBlocks(message, vtkMultiBlockDataSet::SafeDownCast(output));
      return;
    case Kind::Table:
      message.TakeInto(vtkTable::SafeDownCast(output)->GetRowData());
      return;
    case Kind::Nothing:
      return;
  }
  if (block < 0)
  {
    output->ShallowCopy(data);
  }
  else
  {
    vtkMultiBlockDataSet::SafeDownCast(output)->SetBlock(static_cast<unsigned int>(block), data);
  }
}
}

AlgorithmError RunOnRanks(Ranks& ranks, const FilterCall& call,
  const std::function<std::string()>& aboutMemory, const RankWork& work)
{
  const AlgorithmError error = RunAlgorithm(call.Outputs, aboutMemory,
    [&]
    {
      if (!ranks.IsFirst())
      {
        ranks.Serve(
          [&](RankQuestion question, RankMessage& message)
          {
            if (question == RankQuestion::Own || question == RankQuestion::OwnProgress)
            {
              return work.OfOthers(question, message);
            }
            if (question != RankQuestion::Output)
            {
              return AnswerForInputs(question, message, call);
            }
            TakeOutput(message, call.Outputs);
            return RankMessage();
          },
          aboutMemory);
        return;
      }
      work.OfFirst();
      if (ranks.AreMany())
      {
        DealAll(ranks, call, work.Deals);
        ranks.End();
      }
    });
  if (error.Code != 0)
  {
    ranks.Fail(error);
  }
  return error;
}
}
