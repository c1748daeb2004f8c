// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicAnnouncer_h
#define volumicAnnouncer_h

#include "RunFilter.h"
#include "ToolOptions.h"

#include <iostream>
#include <string>
#include <unistd.h>

namespace tool
{
/** What is told on stderr, unless --quiet. */
class Announcer
{
public:
  explicit Announcer(const ToolOptions& options) : IsQuiet(options.Quiet)
  {
    const bool isTerminal = isatty(STDERR_FILENO) != 0;
    this->Style = options.Quiet ? ProgressStyle::None
      : isTerminal              ? ProgressStyle::OneLine
      : options.Progress        ? ProgressStyle::Lines
                                : ProgressStyle::None;
  }

  void Say(const std::string& text) const
  {
    if (!this->IsQuiet)
    {
      std::cerr << "volumic: " << text << "\n";
    }
  }

  ProgressStyle Style;

private:
  bool IsQuiet;
};
}

#endif
