// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicJsonReader_h
#define volumicJsonReader_h

#include <string>
#include <utility>
#include <vector>

namespace tool
{
/** A value of JSON (RFC 8259), with all that is in it. */
struct JsonValue
{
  enum class Kind
  {
    Null,
    Boolean, ///< which of both is not kept
    Number,
    Text,
    Array,
    Object
  };
  Kind Form = Kind::Null;
  double Number = 0.0;
  std::string Text;                                        ///< UTF-8
  std::vector<JsonValue> Items;                            ///< of an array
  std::vector<std::pair<std::string, JsonValue>> Members; ///< of an object, in the file's order

  /** The member of this name, of any case; null where there is none, or this is no object. */
  const JsonValue* Find(const std::string& name) const;
};

/** @throws Failure that names the line, if the text is no JSON or is nested too deeply. */
JsonValue ParseJson(const std::string& text);
}

#endif
