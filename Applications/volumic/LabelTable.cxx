// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Names of labels in lines: what ITK-SNAP, 3D Slicer, FreeSurfer, MRIcron, BIDS and people write.
#include "LabelNames.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <sstream>
#include <utility>

namespace tool
{
namespace
{
struct Row
{
  int Line = 0; ///< counted from 1
  std::vector<std::string> Words;
};

/** @throws Failure that names the line if it is so. */
void RefuseLineIf(bool isSo, int line, const std::string& reason)
{
  FailIf(isSo, "line " + std::to_string(line) + ": " + reason);
}

/** Words between separators, or blanks if that is ' '; quotes hold together, two stand for one. */
std::vector<std::string> SplitLine(const std::string& text, char separator, int line)
{
  std::vector<std::string> words;
  std::string word;
  bool isQuoted = false;
  bool hasWord = false;
  bool isBlank = true; // so far
  const auto end = [&]
  {
    if (separator != ' ' || hasWord)
    {
      words.push_back(Trimmed(word));
    }
    word.clear();
    hasWord = false;
    isBlank = true;
  };
  for (std::size_t at = 0; at < text.size(); ++at)
  {
    const char c = text[at];
    if (c == '"' && isQuoted && at + 1 < text.size() && text[at + 1] == '"')
    {
      word += text[at++];
      isBlank = false;
    }
    else if (c == '"' && (isQuoted || isBlank))
    {
      isQuoted = !isQuoted;
      hasWord = true;
    }
    else if (!isQuoted && (separator == ' ' ? c == ' ' || c == '\t' : c == separator))
    {
      end();
    }
    else
    {
      word += c;
      hasWord = true;
      isBlank = isBlank && (c == ' ' || c == '\t' || c == '\r' || c == '\n');
    }
  }
  RefuseLineIf(isQuoted, line, "a quote does not end");
  end();
  return words;
}

/** The lines that say something, with their numbers. */
std::vector<std::pair<int, std::string>> LinesOf(std::string text)
{
  // A line may end by \r\n, by \n or, as on old machines, by \r.
  char before = '\0';
  const auto isSecond = [&before](char c) { return std::exchange(before, c) == '\r' && c == '\n'; };
  text.erase(std::remove_if(text.begin(), text.end(), isSecond), text.end());
  std::replace(text.begin(), text.end(), '\r', '\n');
  std::istringstream stream(text);
  std::vector<std::pair<int, std::string>> lines;
  int number = 0;
  for (std::string line; std::getline(stream, line);)
  {
    ++number;
    const bool isComment = Trimmed(line).empty() || line[0] == '#' || line.compare(0, 2, "//") == 0;
    if (!isComment)
    {
      lines.emplace_back(number, line);
    }
  }
  return lines;
}

/** What the first line and most of the others have between their words; ' ': any blanks. */
char SeparatorOf(const std::vector<std::pair<int, std::string>>& lines)
{
  for (const char separator : { '\t', ';', ',' })
  {
    const auto has = [&](const auto& line)
    { return line.second.find(separator) != std::string::npos; };
    const auto count = std::count_if(lines.begin(), lines.end(), has);
    if (!lines.empty() && has(lines.front()) && 2 * static_cast<std::size_t>(count) >= lines.size())
    {
      return separator;
    }
  }
  return ' ';
}

/** A column's name without what people write differently: "Label Value", label_value. */
std::string ColumnKey(const std::string& text)
{
  std::string plain;
  for (const char c : Lower(text))
  {
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))
    {
      plain += c;
    }
  }
  return plain;
}

/** Places of columns; -1: there is none. */
struct Columns
{
  int Label = -1;
  int Name = -1;
  int Colors[3] = { -1, -1, -1 }; ///< or the first alone, for "#rrggbb"
};

int FindColumn(const Row& head, const std::vector<std::string>& names, int taken = -1)
{
  for (const std::string& name : names)
  {
    for (int i = 0; i < static_cast<int>(head.Words.size()); ++i)
    {
      if (i != taken && ColumnKey(head.Words[i]) == name)
      {
        return i;
      }
    }
  }
  return -1;
}

Columns ColumnsOf(const Row& head)
{
  Columns columns;
  columns.Name = FindColumn(head,
    { "name", "labelname", "segmentname", "structure", "structurename", "region", "regionname",
      "organ", "segment", "description" });
  columns.Label = FindColumn(head,
    { "labelvalue", "value", "index", "labelid", "labelindex", "id", "idx", "number", "no", "key",
      "roi", "label" },
    columns.Name);
  if (columns.Name < 0)
  {
    columns.Name = FindColumn(head, { "label", "text", "class" }, columns.Label);
  }
  RefuseLineIf(columns.Label < 0 || columns.Name < 0, head.Line,
    "neither a label and its name, nor names of columns such as 'label' and 'name'");
  const std::vector<std::string> colors[3] = { { "r", "red", "colorr" }, { "g", "green", "colorg" },
    { "b", "blue", "colorb" } };
  std::transform(std::begin(colors), std::end(colors), columns.Colors,
    [&](const auto& names) { return FindColumn(head, names); });
  if (columns.Colors[0] < 0)
  {
    columns.Colors[0] = FindColumn(head, { "color", "colour" });
  }
  return columns;
}

/** The colour of three words, if they are numbers, or of the first, if it is one as "#rrggbb". */
std::optional<Vector3> ColorOf(const Row& row, const int* columns)
{
  const auto word = [&](int column)
  {
    const bool isThere = column >= 0 && column < static_cast<int>(row.Words.size());
    return isThere ? row.Words[static_cast<std::size_t>(column)] : std::string();
  };
  Vector3 color;
  for (int i = 0; i < 3; ++i)
  {
    const std::optional<double> part = AsNumber<double>(word(columns[i]));
    if (!part)
    {
      return ParseHexColor(word(columns[0]));
    }
    color[static_cast<std::size_t>(i)] = *part;
  }
  return color;
}

/** Rows whose cells are in columns. */
LabelNames NamesInColumns(const std::vector<Row>& rows, std::size_t first, const Columns& columns)
{
  LabelNames names;
  for (std::size_t i = first; i < rows.size(); ++i)
  {
    const Row& row = rows[i];
    RefuseLineIf(static_cast<int>(row.Words.size()) <= std::max(columns.Label, columns.Name),
      row.Line, "it has fewer columns than the first one");
    const std::string& label = row.Words[static_cast<std::size_t>(columns.Label)];
    const std::optional<int> value = AsNumber<int>(label);
    RefuseLineIf(!value, row.Line, "'" + label.substr(0, 40) + "' is no label: a whole number is");
    names.push_back(
      { *value, row.Words[static_cast<std::size_t>(columns.Name)], ColorOf(row, columns.Colors) });
  }
  return names;
}

/** Numbers at the end of a row, of what is behind the label and one word. */
int NumbersAtEnd(const Row& row)
{
  int count = 0;
  for (std::size_t i = row.Words.size(); i > 2 && AsNumber<double>(row.Words[i - 1]); --i)
  {
    ++count;
  }
  return count;
}

/** "label red green blue alpha visible mesh name", as ITK-SNAP writes it. */
bool IsOfItkSnap(const Row& row)
{
  return row.Words.size() == 8 && !AsNumber<double>(row.Words[7]) &&
    std::all_of(row.Words.begin(), row.Words.end() - 1,
      [](const std::string& word) { return AsNumber<double>(word).has_value(); });
}

/** Rows of a label, words of a name, and numbers. */
LabelNames NamesBetweenNumbers(const std::vector<Row>& rows)
{
  LabelNames names;
  int numbers = 4;
  bool haveThreeWords = true;
  for (const Row& row : rows)
  {
    numbers = std::min(numbers, NumbersAtEnd(row));
    haveThreeWords = haveThreeWords && row.Words.size() == 3;
  }
  // A number at the end of some names is part of them.
  numbers = numbers >= 3 || (numbers == 1 && haveThreeWords) ? numbers : 0;
  for (const Row& row : rows)
  {
    const std::optional<int> label = AsNumber<int>(row.Words[0]);
    RefuseLineIf(!label || row.Words.size() < 2, row.Line,
      "a label, which is a whole number, and a name are wanted");
    LabelName name;
    name.Label = *label;
    const int end = static_cast<int>(row.Words.size()) - numbers;
    for (int i = 1; i < end; ++i)
    {
      name.Name += (i > 1 ? " " : "") + row.Words[static_cast<std::size_t>(i)];
    }
    const int colors[] = { end, end + 1, end + 2 };
    name.Color = numbers >= 3 ? ColorOf(row, colors) : std::nullopt;
    RefuseLineIf(AsNumber<double>(name.Name).has_value(), row.Line,
      "'" + name.Name + "' is a number, no name");
    names.push_back(name);
  }
  return names;
}
}

LabelNames ParseLabelTable(const std::string& text)
{
  const std::vector<std::pair<int, std::string>> lines = LinesOf(text);
  const char separator = SeparatorOf(lines);
  std::vector<Row> rows;
  for (const auto& [number, line] : lines)
  {
    rows.push_back({ number, SplitLine(line, separator, number) });
  }
  if (rows.empty())
  {
    return {};
  }
  const auto begins = [&](std::size_t column)
  {
    return std::all_of(rows.begin(), rows.end(),
      [&](const Row& row)
      { return row.Words.size() > column && AsNumber<int>(row.Words[column]).has_value(); });
  };
  if (std::all_of(rows.begin(), rows.end(), IsOfItkSnap))
  {
    Columns columns;
    columns.Label = 0;
    columns.Name = 7;
    std::iota(std::begin(columns.Colors), std::end(columns.Colors), 1);
    return NamesInColumns(rows, 0, columns);
  }
  const bool hasHead = std::none_of(rows[0].Words.begin(), rows[0].Words.end(),
    [](const std::string& word) { return AsNumber<double>(word).has_value(); });
  if (hasHead)
  {
    return NamesInColumns(rows, 1, ColumnsOf(rows[0]));
  }
  if (separator == ' ')
  {
    return NamesBetweenNumbers(rows);
  }
  Columns columns;
  columns.Label = begins(0) || !begins(1) ? 0 : 1;
  columns.Name = 1 - columns.Label;
  std::iota(std::begin(columns.Colors), std::end(columns.Colors), 2);
  for (const Row& row : rows)
  {
    if (row.Words.size() > 1)
    {
      const std::string& name = row.Words[static_cast<std::size_t>(columns.Name)];
      RefuseLineIf(AsNumber<double>(name).has_value(), row.Line,
        "'" + row.Words[1] + "' is a number, no name");
    }
  }
  return NamesInColumns(rows, 0, columns);
}
}
