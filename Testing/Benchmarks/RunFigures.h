// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** What was measured in one run: numbers and texts by name, and their way from one process to
   another and into CSV. */

#ifndef volumicRunFigures_h
#define volumicRunFigures_h

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace volumic
{
namespace bench
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

  /** A line per figure that begins with a mark, so that Read finds it among whatever else the
     libraries may write. Numbers come back as they were, to the bit. */
  void Write(std::ostream& stream) const;
  void Read(std::istream& stream);

  /** Name of a figure of one level, or of another number of things. */
  static std::string Indexed(const char* what, int index, const std::string& name)
  {
    return std::string(what) + "." + std::to_string(index) + "." + name;
  }

private:
  std::map<std::string, double> Numbers;
  std::map<std::string, std::string> Texts;
};

/** Rows of a CSV file; the first is its heading. Fields with commas or quotes are quoted. Throws
   std::runtime_error where the file can't be written. */
void WriteCsv(const std::string& file, const std::vector<std::vector<std::string>>& rows);

/** FILE-what.csv for FILE.csv. */
std::string CsvNameOf(const std::string& file, const std::string& what);

/** As many digits as tell two values apart, empty for NaN. For CSV. */
std::string ExactText(double value);

/** For people: `digits` significant ones, no exponent up to 1e15, `-` for NaN. */
std::string ShortText(double value, int digits = 3);

} // namespace bench
} // namespace volumic

#endif
