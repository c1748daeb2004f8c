// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Names of labels in JSON: what nnU-Net, TotalSegmentator, 3D Slicer and people write.
#include "JsonReader.h"
#include "LabelNames.h"
#include "ParseNumbers.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tool
{
namespace
{
using Kind = JsonValue::Kind;

std::optional<int> AsLabel(const JsonValue& value)
{
  if (value.Form == Kind::Text)
  {
    return AsNumber<int>(value.Text);
  }
  const bool isLabel = value.Form == Kind::Number && value.Number == std::floor(value.Number) &&
    std::abs(value.Number) <= std::numeric_limits<int>::max();
  return isLabel ? std::optional<int>(static_cast<int>(value.Number)) : std::nullopt;
}

std::optional<Vector3> ColorOf(const JsonValue& segment)
{
  for (const char* key : { "color", "colour", "rgb", "recommendedDisplayRGBValue" })
  {
    const JsonValue* color = segment.Find(key);
    if (color && color->Form == Kind::Text)
    {
      return ParseHexColor(color->Text);
    }
    const bool isOne = color && color->Items.size() >= 3 &&
      std::all_of(color->Items.begin(), color->Items.end(),
        [](const JsonValue& item) { return item.Form == Kind::Number; });
    if (isOne)
    {
      return Vector3{ color->Items[0].Number, color->Items[1].Number, color->Items[2].Number };
    }
  }
  return std::nullopt;
}

/** The text of the first of these members that there is. */
std::optional<std::string> NameOf(const JsonValue& segment)
{
  for (const char* key : { "name", "labelName", "SegmentLabel", "SegmentDescription", "structure",
         "label", "text", "description" })
  {
    const JsonValue* name = segment.Find(key);
    if (name && name->Form == Kind::Text)
    {
      return name->Text;
    }
  }
  return std::nullopt;
}

/** {"1": "liver"}, or {"1": {"name": "liver"}}; nothing if the object is something else. */
LabelNames NamesByLabel(const JsonValue& object)
{
  LabelNames names;
  for (const auto& [key, value] : object.Members)
  {
    JsonValue label;
    label.Form = Kind::Text;
    label.Text = key;
    const std::optional<std::string> name =
      value.Form == Kind::Text ? std::optional<std::string>(value.Text) : NameOf(value);
    if (!AsLabel(label) || !name)
    {
      return {};
    }
    names.push_back({ *AsLabel(label), *name, ColorOf(value) });
  }
  return names;
}

/** {"liver": 1}. Several labels under one name (nnU-Net's regions) are the name of none of them. */
LabelNames LabelsByName(const JsonValue& object)
{
  LabelNames names;
  for (const auto& [key, value] : object.Members)
  {
    const bool isRegion = value.Form == Kind::Array && !value.Items.empty() &&
      std::all_of(value.Items.begin(), value.Items.end(),
        [](const JsonValue& item) { return item.Form == Kind::Number; });
    const JsonValue& label = isRegion && value.Items.size() == 1 ? value.Items[0] : value;
    if (AsLabel(label))
    {
      names.push_back({ *AsLabel(label), key, std::nullopt });
    }
    else if (!isRegion)
    {
      return {};
    }
  }
  return names;
}

/** [{"label": 1, "name": "liver"}, ...], also in lists within the list. */
LabelNames NamesInList(const JsonValue& list)
{
  LabelNames names;
  for (const JsonValue& segment : list.Items)
  {
    if (segment.Form == Kind::Array)
    {
      const LabelNames more = NamesInList(segment);
      names.insert(names.end(), more.begin(), more.end());
      continue;
    }
    std::optional<int> label;
    for (const char* key : { "labelValue", "labelID", "label_value", "label_id", "value", "label",
           "index", "id", "number", "key" })
    {
      const JsonValue* value = segment.Find(key);
      label = !label && value ? AsLabel(*value) : label;
    }
    const std::optional<std::string> name = NameOf(segment);
    if (!label || !name)
    {
      return {};
    }
    names.push_back({ *label, *name, ColorOf(segment) });
  }
  return names;
}

LabelNames NamesIn(const JsonValue& value)
{
  LabelNames names = NamesByLabel(value);
  names = names.empty() ? LabelsByName(value) : names;
  return names.empty() && value.Form == Kind::Array ? NamesInList(value) : names;
}

bool IsUsualKey(const std::string& key)
{
  static const std::vector<std::string> keys = { "labels", "label_names", "names", "segments",
    "segmentattributes", "class_map", "classes", "structures", "organs" };
  return std::find(keys.begin(), keys.end(), Lower(key)) != keys.end();
}

/** What is found first: in the value itself, in members that are called so, in all others. */
LabelNames FindNames(const JsonValue& value)
{
  LabelNames names = NamesIn(value);
  for (const bool isUsual : { true, false })
  {
    for (const auto& [key, member] : value.Members)
    {
      names = names.empty() && IsUsualKey(key) == isUsual ? FindNames(member) : names;
    }
  }
  for (const JsonValue& item : value.Items)
  {
    names = names.empty() ? FindNames(item) : names;
  }
  return names;
}
}

LabelNames ParseLabelJson(const std::string& text)
{
  const JsonValue value = ParseJson(text);
  const LabelNames names = FindNames(value);
  if (names.empty())
  {
    throw Failure("there are no labels in it such as {\"1\": \"liver\"} or {\"liver\": 1}");
  }
  return names;
}
}
