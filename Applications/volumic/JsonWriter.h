// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicJsonWriter_h
#define volumicJsonWriter_h

#include <ostream>
#include <string>

namespace tool
{
/** Writes JSON (RFC 8259) as it is told, one value per line. */
class JsonWriter
{
public:
  explicit JsonWriter(std::ostream& out) : Out(out) {}

  void BeginObject() { this->Begin('{'); }
  void EndObject() { this->End('}'); }
  void BeginArray() { this->Begin('['); }
  void EndArray() { this->End(']'); }

  /** The name of the value that comes next. */
  void Name(const std::string& name);

  void Value(const std::string& text);
  void Value(const char* text) { this->Value(std::string(text)); }
  void Value(bool value);
  /** Whole numbers without a point; null for NaN and infinities, which JSON has not. */
  void Value(double value);
  void Value(int value) { this->Value(static_cast<double>(value)); }

  template <class T>
  void Member(const std::string& name, const T& value)
  {
    this->Name(name);
    this->Value(value);
  }
  /** An array of numbers on one line. */
  void Numbers(const std::string& name, const double* values, int count);

private:
  void Begin(char bracket);
  void End(char bracket);
  void Separate();

  std::ostream& Out;
  int Depth = 0;
  bool IsFirst = true; ///< nothing in this object or array yet
  bool AfterName = false;
};
}

#endif
