// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ProgressLine.h"

#include <algorithm>
#include <cstdio>
#include <sys/ioctl.h>
#include <unistd.h>

namespace tool
{
namespace
{
/** Columns of the terminal behind stderr. */
std::size_t TerminalWidth()
{
  winsize size{};
  const bool isKnown = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return isKnown ? size.ws_col : 80;
}
}

ProgressLine::ProgressLine(const std::string& title, ProgressStyle style)
  : Title(title), Style(style)
{
}

ProgressLine::~ProgressLine()
{
  if (this->IsDrawn)
  {
    std::fprintf(stderr, "\r%*s\r", static_cast<int>(TerminalWidth() - 1), "");
  }
}

void ProgressLine::Show(double share, const std::string& text)
{
  share = std::clamp(share, 0.0, 1.0);
  if (this->Style == ProgressStyle::OneLine)
  {
    this->Redraw(share, text);
  }
  else if (this->Style == ProgressStyle::Lines && share >= this->NextShare)
  {
    const std::string more = text.empty() ? "" : "  " + text;
    std::fprintf(stderr, "%s: %3.0f %%%s\n", this->Title.c_str(), 100.0 * share, more.c_str());
    this->NextShare = share + 0.1;
  }
}

void ProgressLine::Redraw(double share, const std::string& text)
{
  const auto now = std::chrono::steady_clock::now();
  if (this->IsDrawn && now - this->DrawnAt < std::chrono::milliseconds(100))
  {
    return;
  }
  this->IsDrawn = true;
  this->DrawnAt = now;
  const std::size_t barWidth = 24;
  const auto filled = static_cast<std::size_t>(share * barWidth);
  char percent[16];
  std::snprintf(percent, sizeof(percent), "%3.0f %% ", 100.0 * share);
  std::string line = this->Title + " [" + std::string(filled, '#') +
    std::string(barWidth - filled, '.') + "] " + percent + text;
  line.resize(TerminalWidth() - 1, ' '); // a longer one would leave its rests
  std::fprintf(stderr, "\r%s", line.c_str());
  std::fflush(stderr);
}
}
