// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicProgressLine_h
#define volumicProgressLine_h

#include <chrono>
#include <string>

namespace tool
{
/** How the progress is shown on stderr. */
enum class ProgressStyle
{
  None,
  OneLine, ///< one line that is drawn anew: a terminal
  Lines    ///< a line for each tenth
};

/** The progress of one piece of work, on stderr. The line of a terminal goes with it. */
class ProgressLine
{
public:
  ProgressLine(const std::string& title, ProgressStyle style);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /** `share` of the work is done, 0 to 1. */
  void Show(double share, const std::string& text);

private:
  void Redraw(double share, const std::string& text);

  std::string Title;
  ProgressStyle Style;
  bool IsDrawn = false;
  std::chrono::steady_clock::time_point DrawnAt;
  double NextShare = 0.0;
};
}

#endif
