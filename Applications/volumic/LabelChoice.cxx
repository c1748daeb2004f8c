// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelChoice.h"

#include "Texts.h"
#include "ToolErrors.h"

#include <vtkDataArray.h>
#include <vtkIntArray.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <algorithm>
#include <fnmatch.h>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace tool
{
namespace
{
/** "7-9", also of negative numbers: "-9--7". */
std::optional<std::pair<int, int>> AsRange(const std::string& text)
{
  const std::size_t dash = text.find('-', 1);
  if (dash == std::string::npos)
  {
    return std::nullopt;
  }
  const std::optional<int> first = AsNumber<int>(text.substr(0, dash));
  const std::optional<int> last = AsNumber<int>(text.substr(dash + 1));
  return first && last ? std::optional(std::pair(*first, *last)) : std::nullopt;
}

using Test = std::function<bool(const KnownLabel&)>;

/** Places of the labels that pass. */
std::vector<std::size_t> Find(const std::vector<KnownLabel>& known, const Test& passes)
{
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < known.size(); ++i)
  {
    if (passes(known[i]))
    {
      found.push_back(i);
    }
  }
  return found;
}

/** Whether it has a name, and not only a number. */
bool IsNamed(const KnownLabel& label)
{
  return label.Name != "Label " + std::to_string(label.Label);
}

/** By the name, of other case if there is none of this; else by the names that a pattern means. */
std::vector<std::size_t> FindNamed(
  const std::string& text, const std::vector<KnownLabel>& known, int background)
{
  std::vector<std::size_t> same =
    Find(known, [&](const KnownLabel& label) { return label.Name == text; });
  if (same.empty())
  {
    same = Find(known, [&](const KnownLabel& label) { return Lower(label.Name) == Lower(text); });
  }
  if (!same.empty() || text.find('*') == std::string::npos)
  {
    return same;
  }
  // Brackets and so on are letters of names.
  std::string pattern;
  for (const char c : Lower(text))
  {
    pattern += (c == '*' ? "" : "\\") + std::string(1, c);
  }
  return Find(known,
    [&](const KnownLabel& label)
    {
      return IsNamed(label) && label.Label != background &&
        fnmatch(pattern.c_str(), Lower(label.Name).c_str(), 0) == 0;
    });
}

/** What one text asks for; empty if there is no such label. */
std::vector<std::size_t> FindText(
  const std::string& text, const std::vector<KnownLabel>& known, int background)
{
  if (const std::optional<int> value = AsNumber<int>(text))
  {
    return Find(known, [&](const KnownLabel& label) { return label.Label == *value; });
  }
  const std::vector<std::size_t> named = FindNamed(text, known, background);
  if (!named.empty())
  {
    return named;
  }
  if (Lower(text) == "all")
  {
    return Find(known, [&](const KnownLabel& label) { return label.Label != background; });
  }
  if (const auto range = AsRange(text))
  {
    return Find(known,
      [&](const KnownLabel& label)
      {
        return label.Label >= range->first && label.Label <= range->second &&
          label.Label != background;
      });
  }
  return {};
}

/** The labels for a message, not all if there are many. */
std::string ListOf(const std::vector<KnownLabel>& known)
{
  constexpr std::size_t most = 20;
  std::string list;
  for (std::size_t i = 0; i < std::min(known.size(), most); ++i)
  {
    list += (i > 0 ? ", " : "") + std::to_string(known[i].Label) +
      (IsNamed(known[i]) ? " " + known[i].Name : "");
  }
  return list +
    (known.size() > most ? " and " + std::to_string(known.size() - most) + " more" : "");
}
}

std::vector<KnownLabel> LabelsOf(vtkTable* table, int layer)
{
  std::vector<KnownLabel> labels;
  auto* colors = vtkDataArray::SafeDownCast(table->GetColumnByName("Color"));
  auto* extents = vtkIntArray::SafeDownCast(table->GetColumnByName("Extent"));
  for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
  {
    KnownLabel label;
    label.Label = table->GetValueByName(row, "Label").ToInt();
    label.Name = table->GetValueByName(row, "Name").ToString();
    label.Voxels = table->GetValueByName(row, "Voxels").ToTypeInt64();
    colors->GetTuple(row, label.Color.data());
    extents->GetTypedTuple(row, label.Box.data());
    label.Layer = layer;
    labels.push_back(label);
  }
  return labels;
}

std::vector<std::size_t> ChooseLabels(const std::vector<std::string>& texts,
  const std::vector<KnownLabel>& known, int background)
{
  std::set<std::size_t> chosen;
  for (const std::string& text : texts)
  {
    // A name may have commas.
    const bool isName = !FindNamed(text, known, background).empty();
    for (const std::string& part :
      isName ? std::vector<std::string>{ text } : SplitAtCommas(text))
    {
      const std::vector<std::size_t> found = FindText(part, known, background);
      FailIf(found.empty() && Lower(part) != "all",
        "there is no label '" + part + "' (--labels); there are " +
          (known.empty() ? "none" : ListOf(known)));
      chosen.insert(found.begin(), found.end());
    }
  }
  return { chosen.begin(), chosen.end() };
}

std::vector<KnownLabel> NumberedLabels(
  const std::vector<std::string>& texts, const LabelNames& names)
{
  std::map<int, KnownLabel> labels;
  for (const std::string& text : texts)
  {
    for (const std::string& part : SplitAtCommas(text))
    {
      const std::optional<int> value = AsNumber<int>(part);
      if (!value)
      {
        return {};
      }
      labels[*value] = { *value, "Label " + std::to_string(*value) };
      for (const LabelName& name : names)
      {
        if (name.Label == *value && !name.Name.empty())
        {
          labels[*value].Name = name.Name;
        }
      }
    }
  }
  std::vector<KnownLabel> known;
  for (const auto& entry : labels)
  {
    known.push_back(entry.second);
  }
  return known;
}

std::vector<std::string> FileNamesOf(const std::vector<KnownLabel>& known)
{
  std::vector<std::string> names;
  std::map<std::string, int> uses;
  for (const KnownLabel& label : known)
  {
    const std::string safe = IsNamed(label) ? SafeName(label.Name) : "";
    names.push_back(safe.empty() ? "label-" + std::to_string(label.Label) : safe);
    ++uses[Lower(names.back())];
  }
  std::set<std::string> taken;
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    const bool isShared = uses[Lower(names[i])] > 1;
    const std::string start =
      isShared ? names[i] + "-" + std::to_string(known[i].Label) : names[i];
    names[i] = start;
    for (int more = 2; !taken.insert(Lower(names[i])).second; ++more)
    {
      names[i] = start + "-" + std::to_string(more);
    }
  }
  return names;
}
}
