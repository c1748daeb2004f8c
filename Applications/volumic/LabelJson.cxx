// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Names of labels in JSON: what nnU-Net, TotalSegmentator, 3D Slicer and people write.
#include "Json.h"
#include "LabelNames.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <algorithm>
#include <initializer_list>
#include <limits>

namespace tool
{
namespace
{
/** @throws Failure, which names the line if the text is no JSON, or if it is too deep or large. */
Json ParseJson(const std::string& text)
{
  constexpr std::size_t most = 30000; // Each new member is looked for among those before it.
  std::size_t members = 0;
  try
  {
    return Json::parse(text,
      [&members](int depth, Json::parse_event_t event, Json&)
      {
        members += event == Json::parse_event_t::key ? 1 : 0;
        if (members > most)
        {
          throw Failure("the JSON has more than " + std::to_string(most) + " members");
        }
        return depth <= 64 ? true : throw Failure("the JSON is nested too deeply");
      });
  }
  catch (const Json::exception& error)
  {
    const std::string reason = error.what(); // "[json.exception.parse_error.101] parse error ..."
    throw Failure("it is no JSON: " + AsUtf8(reason.substr(reason.find("] ") + 2, 200)));
  }
}

/** The member of this name, of any case; null where there is none, or this is no object. */
const Json* Find(const Json& object, const std::string& name)
{
  if (object.is_object())
  {
    for (const auto& member : object.items())
    {
      if (Lower(member.key()) == Lower(name))
      {
        return &member.value();
      }
    }
  }
  return nullptr;
}

std::optional<int> AsLabel(const Json& value)
{
  if (value.is_string())
  {
    return AsNumber<int>(value.get<std::string>());
  }
  const double number = value.is_number() ? value.get<double>() : 0.5;
  const bool isLabel =
    number == std::floor(number) && std::abs(number) <= std::numeric_limits<int>::max();
  return isLabel ? std::optional<int>(static_cast<int>(number)) : std::nullopt;
}

bool AreNumbers(const Json& list)
{
  return list.is_array() && !list.empty() &&
    std::all_of(list.begin(), list.end(), [](const Json& item) { return item.is_number(); });
}

/** The first of these members that there is and that passes; null: none does. */
const Json* FindFirst(
  const Json& segment, std::initializer_list<const char*> keys, bool (*passes)(const Json&))
{
  for (const char* key : keys)
  {
    const Json* value = Find(segment, key);
    if (value && passes(*value))
    {
      return value;
    }
  }
  return nullptr;
}

std::optional<Vector3> ColorOf(const Json& segment)
{
  const Json* color = FindFirst(segment, { "color", "colour", "rgb", "recommendedDisplayRGBValue" },
    [](const Json& value)
    { return value.is_string() || (AreNumbers(value) && value.size() >= 3); });
  if (!color || color->is_string())
  {
    return color ? ParseHexColor(color->get<std::string>()) : std::nullopt;
  }
  return Vector3{ color->at(0).get<double>(), color->at(1).get<double>(),
    color->at(2).get<double>() };
}

/** The text of the first of these members that there is. */
std::optional<std::string> NameOf(const Json& segment)
{
  const Json* name = FindFirst(segment,
    { "name", "labelName", "SegmentLabel", "SegmentDescription", "structure", "label", "text",
      "description" },
    [](const Json& value) { return value.is_string(); });
  return name ? std::optional<std::string>(name->get<std::string>()) : std::nullopt;
}

/** {"1": "liver"}, or {"1": {"name": "liver"}}; nothing if the object is something else. */
LabelNames NamesByLabel(const Json& object)
{
  LabelNames names;
  for (const auto& member : object.items())
  {
    const std::optional<int> label = AsNumber<int>(member.key());
    const Json& value = member.value();
    const std::optional<std::string> name =
      value.is_string() ? value.get<std::string>() : NameOf(value);
    if (!label || !name)
    {
      return {};
    }
    names.push_back({ *label, *name, ColorOf(value) });
  }
  return names;
}

/** {"liver": 1}. Several labels under one name (nnU-Net's regions) are the name of none of them. */
LabelNames LabelsByName(const Json& object)
{
  LabelNames names;
  for (const auto& member : object.items())
  {
    const Json& value = member.value();
    const bool isRegion = AreNumbers(value);
    const Json& label = isRegion && value.size() == 1 ? value[0] : value;
    if (AsLabel(label))
    {
      names.push_back({ *AsLabel(label), member.key(), std::nullopt });
    }
    else if (!isRegion)
    {
      return {};
    }
  }
  return names;
}

/** [{"label": 1, "name": "liver"}, ...], also in lists within the list. */
LabelNames NamesInList(const Json& list)
{
  LabelNames names;
  for (const Json& segment : list)
  {
    if (segment.is_array())
    {
      const LabelNames more = NamesInList(segment);
      names.insert(names.end(), more.begin(), more.end());
      continue;
    }
    const Json* label = FindFirst(segment,
      { "labelValue", "labelID", "label_value", "label_id", "value", "label", "index", "id",
        "number", "key" },
      [](const Json& value) { return AsLabel(value).has_value(); });
    const std::optional<std::string> name = NameOf(segment);
    if (!label || !name)
    {
      return {};
    }
    names.push_back({ *AsLabel(*label), *name, ColorOf(segment) });
  }
  return names;
}

LabelNames NamesIn(const Json& value)
{
  if (!value.is_object())
  {
    return value.is_array() ? NamesInList(value) : LabelNames();
  }
  const LabelNames names = NamesByLabel(value);
  return names.empty() ? LabelsByName(value) : names;
}

bool IsUsualKey(const std::string& key)
{
  static const std::vector<std::string> keys = { "labels", "label_names", "names", "segments",
    "segmentattributes", "class_map", "classes", "structures", "organs" };
  return std::find(keys.begin(), keys.end(), Lower(key)) != keys.end();
}

/** What is found first: in the value itself, in members that are called so, in all others. */
LabelNames FindNames(const Json& value)
{
  LabelNames names = NamesIn(value);
  if (!names.empty() || !value.is_structured())
  {
    return names;
  }
  for (const bool isUsual : { true, false })
  {
    for (const auto& member : value.items())
    {
      if (names.empty() && IsUsualKey(member.key()) == isUsual)
      {
        names = FindNames(member.value());
      }
    }
  }
  return names;
}
}

LabelNames ParseLabelJson(const std::string& text)
{
  const LabelNames names = FindNames(ParseJson(text));
  FailIf(names.empty(), "there are no labels in it such as {\"1\": \"liver\"} or {\"liver\": 1}");
  return names;
}
}
