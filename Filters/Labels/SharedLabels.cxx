// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Labels/SharedLabels.h"

#include "Input/ImagePieces.h"

#include <vtkImageData.h>

#include <algorithm>
#include <cstddef>

namespace volumic
{
void SharedLabels::Share(Communicator& ranks)
{
  if (ranks.NumberOfRanks() == 1)
  {
    return;
  }
  const bool isFirst = ranks.Rank() == 0;
  this->Frame = ImagePieces(ranks, isFirst ? this->Frame.Get() : nullptr).Frame();
  MessageWriter writer;
  writer.Add(this->Map.Size);
  writer.Add(this->Map.Spacing);
  writer.Add(this->Map.NumberOfObjects);
  for (const std::string& name : this->Names)
  {
    writer.AddArray(name);
  }
  const Message message = ranks.Broadcast(writer.Take());
  MessageReader reader(message);
  this->Map.Size = reader.Take<std::array<int, 3>>();
  this->Map.Spacing = reader.Take<std::array<double, 3>>();
  this->Map.NumberOfObjects = reader.Take<int>();
  this->Names.clear();
  while (!reader.IsAtEnd())
  {
    reader.TakeArray(this->Names.emplace_back());
  }
  // Slice by slice: the map may be larger than the room for a copy of it.
  const VoxelBox all = VoxelBox::Of(this->Map.Size);
  this->Map.Voxels.resize(static_cast<std::size_t>(all.Count()));
  const auto slice = static_cast<std::size_t>(all.NumberOf(0, 0, 1));
  for (std::size_t first = 0; first < this->Map.Voxels.size(); first += slice)
  {
    char* begin = reinterpret_cast<char*>(this->Map.Voxels.data() + first);
    char* end = begin + slice * sizeof(LabelMap::Number);
    const Message of = ranks.Broadcast(isFirst ? Message(begin, end) : Message());
    std::copy(of.begin(), of.end(), begin);
  }
}
}
