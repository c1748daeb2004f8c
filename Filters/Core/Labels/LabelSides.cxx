// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/LabelSides.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace volumic
{
void LabelSides::CopyMembership(int i, int j, int k, int count, float* values) const
{
  std::fill(values, values + count, this->Object == 0 ? 1.f : 0.f); // Outside the map all is 0.
  const VoxelBox row{ { i, j, k }, { i + count, j + 1, k + 1 } };
  this->Map->ForParts(row.CommonWith(VoxelBox::Of(this->Map->Size())),
    [&](const VoxelBox& part, LabelMap::Number object)
    {
      std::fill(values + (part.First[0] - i), values + (part.End[0] - i),
        object == this->Object ? 1.f : 0.f);
    });
}

bool LabelSides::IsRight(const LabelField& field, int i, int j, int k) const
{
  return !field.Box.Contains({ i, j, k }) ||
    this->Of(i, j, k) * field.Values[static_cast<std::size_t>(field.Box.NumberOf(i, j, k))] > 0.f;
}

bool LabelSides::IsLost(const LabelField& field, int i, int j, int k) const
{
  if (this->IsRight(field, i, j, k))
  {
    return false;
  }
  const bool side = this->IsObject(i, j, k);
  const auto isRight = [&](int a, int b, int c)
  { return this->IsObject(a, b, c) == side && this->IsRight(field, a, b, c); };
  return !isRight(i - 1, j, k) && !isRight(i + 1, j, k) && !isRight(i, j - 1, k) &&
    !isRight(i, j + 1, k) && !isRight(i, j, k - 1) && !isRight(i, j, k + 1);
}

bool LabelSides::IsThin(int i, int j, int k) const
{
  const bool side = this->IsObject(i, j, k);
  return (this->IsObject(i - 1, j, k) != side && this->IsObject(i + 1, j, k) != side) ||
    (this->IsObject(i, j - 1, k) != side && this->IsObject(i, j + 1, k) != side) ||
    (this->IsObject(i, j, k - 1) != side && this->IsObject(i, j, k + 1) != side);
}
}
