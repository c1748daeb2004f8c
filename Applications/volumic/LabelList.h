// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelList_h
#define volumicLabelList_h

#include "LabelChoice.h"
#include "VolumePart.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace tool
{
/** What --list-labels tells; names in it are those of LabelReport where it has them. */
struct LabelList
{
  std::string VolumeName;
  VolumeFacts Volume;
  int Layers = 1;
  std::vector<KnownLabel> Labels = {};
  std::vector<std::string> Warnings = {};
};

/** As a table for the eye, a line for each label below a heading. */
void WriteTable(std::ostream& out, const LabelList& list);

/** As JSON, `labels` with an object for each. */
std::string ReportText(const LabelList& list);
}

#endif
