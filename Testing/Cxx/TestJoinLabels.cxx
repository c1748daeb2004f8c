// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/JoinLabels.h"
#include "TestPrelude.h"

using namespace volumic;

TEST(JoinLabels, NumbersSetsByTheirSmallestElementsHoweverTheyAreCut)
{
  // Elements 0 to 9: {0, 1, 7}, {2, 3, 4}, {5, 9}, {8}.
  const JoinedSets whole = JoinLabels({ { 0, 3 }, { 2, 3 }, { 5, 2 }, { 8, 1 } }, {});
  EXPECT_EQ(whole.LabelOf, std::vector<int>({ 0, 1, 2, 3 }));
  const JoinedSets cut = JoinLabels({ { 9, 1 }, { 7, 1 }, { 8, 1 }, { 2, 3 }, { 5, 1 }, { 0, 2 } },
    { { 1, 5 }, { 4, 0 }, { 0, 4 } });
  EXPECT_EQ(cut.LabelOf, std::vector<int>({ 2, 0, 3, 1, 2, 0 }));
  ASSERT_EQ(cut.Labels.size(), whole.Labels.size());
  for (std::size_t i = 0; i < whole.Labels.size(); ++i)
  {
    EXPECT_EQ(cut.Labels[i].First, whole.Labels[i].First);
    EXPECT_EQ(cut.Labels[i].Size, whole.Labels[i].Size);
  }
}

TEST(JoinLabels, LeavesOutSetsThatAreTooSmallAsAWhole)
{
  const JoinedSets sets = JoinLabels({ { 4, 2 }, { 0, 3 }, { 9, 2 } }, { { 0, 2 } }, 4);
  EXPECT_EQ(sets.LabelOf, std::vector<int>({ 0, JoinedSets::None, 0 }));
  ASSERT_EQ(sets.Labels.size(), 1u);
  EXPECT_EQ(sets.Labels[0].Size, 4);
}
