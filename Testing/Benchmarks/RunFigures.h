// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** What was measured in one run: numbers and texts by name. */

#ifndef volumicRunFigures_h
#define volumicRunFigures_h

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace volumic::bench
{

/** Names hold no blanks; texts hold no line feeds. */
class RunFigures
{
public:
  void Set(const std::string& name, double value) { this->Numbers[name] = value; }
  void SetText(const std::string& name, const std::string& text) { this->Texts[name] = text; }

  /** NaN, "" where there is none. */
  double Get(const std::string& name) const;
  std::string GetText(const std::string& name) const;
  bool Has(const std::string& name) const { return this->Numbers.count(name) > 0; }

  /** A line per figure that begins with a mark, so that bench_tables.py finds it among whatever
     else the libraries may write. Numbers come back as they were, to the bit. */
  void Write(std::ostream& stream) const;

  /** Name of a figure of one level, or of another number of things. */
  static std::string Indexed(const char* what, int index, const std::string& name)
  {
    return std::string(what) + "." + std::to_string(index) + "." + name;
  }

private:
  std::map<std::string, double> Numbers;
  std::map<std::string, std::string> Texts;
};

} // namespace volumic::bench

#endif
