// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The table of labels that TotalSegmentator and Connectome Workbench put behind the header of NIfTI,
// in XML:
//   <Label Key="1" Red="1" Green="0" Blue="0.5" Alpha="1"><![CDATA[spleen]]></Label>
#include "ByteBudget.h"
#include "LabelNames.h"
#include "NiftiHeader.h"
#include "ParseNumbers.h"
#include "Unpack.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>

namespace tool
{
namespace
{
/** The bytes up to the voxels, if any lie between these and the header. */
std::string Extensions(const std::string& name)
{
  const NiftiHeader header(HeadOf(name, 540));
  return header.Start() <= header.Length()
    ? ""
    : HeadOf(name, std::min(header.Start(), LargestNames));
}

/** What stands for a text in XML. */
std::string TextOf(const std::string& content)
{
  static const std::string begin = "<![CDATA[";
  static const std::string end = "]]>";
  const std::size_t at = content.find(begin);
  if (at != std::string::npos)
  {
    const std::size_t start = at + begin.size();
    return content.substr(start, content.find(end, start) - start);
  }
  static const std::pair<const char*, const char*> entities[] = { { "&lt;", "<" }, { "&gt;", ">" },
    { "&quot;", "\"" }, { "&apos;", "'" }, { "&amp;", "&" } };
  std::string text;
  for (std::size_t next = 0; next < content.size();)
  {
    const auto found = std::find_if(std::begin(entities), std::end(entities),
      [&](const auto& each)
      { return content.compare(next, std::strlen(each.first), each.first) == 0; });
    const bool isEntity = found != std::end(entities);
    text += isEntity ? found->second : std::string(1, content[next]);
    next += isEntity ? std::strlen(found->first) : 1;
  }
  return text;
}

/** The number that an attribute of an element is; nothing if it has none. */
std::optional<double> AttributeOf(const std::string& element, const std::string& name)
{
  const std::string begin = " " + name + "=\"";
  const std::size_t at = element.find(begin);
  const std::size_t start = at == std::string::npos ? element.size() : at + begin.size();
  const std::size_t end = element.find('"', start);
  return end == std::string::npos ? std::nullopt
                                  : AsNumber<double>(element.substr(start, end - start));
}
}

LabelNames NamesInNifti(const std::string& name)
{
  const std::string text = Extensions(name);
  LabelNames names;
  const std::string begin = "<Label ";
  const std::string end = "</Label>";
  // Behind each element the next one is looked for: no byte is looked at twice.
  std::size_t behind = 0;
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, behind))
  {
    const std::size_t open = text.find('>', at);
    const std::size_t close = text.find(end, at);
    if (open == std::string::npos || close == std::string::npos || open > close)
    {
      break;
    }
    behind = close;
    const std::string element = text.substr(at, open - at);
    const std::optional<double> key = AttributeOf(element, "Key");
    if (!key || *key != std::floor(*key) || std::abs(*key) > std::numeric_limits<int>::max())
    {
      continue;
    }
    LabelName label;
    label.Label = static_cast<int>(*key);
    label.Name = PlainName(TextOf(text.substr(open + 1, close - open - 1)));
    const std::optional<double> red = AttributeOf(element, "Red");
    const std::optional<double> green = AttributeOf(element, "Green");
    const std::optional<double> blue = AttributeOf(element, "Blue");
    if (red && green && blue)
    {
      label.Color = Vector3{ *red, *green, *blue };
    }
    names.push_back(label);
  }
  return names;
}
}
