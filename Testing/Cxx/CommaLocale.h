// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCommaLocale_h
#define volumicCommaLocale_h

#include <locale>
#include <string>

namespace volumic
{
/** Set a global locale that formats 1234.5 as 1.234,5 until destruction. */
class CommaLocale
{
public:
  CommaLocale() : Former(std::locale::global(std::locale(std::locale::classic(), new Comma))) {}
  ~CommaLocale() { std::locale::global(this->Former); }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;

private:
  struct Comma : std::numpunct<char>
  {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };

  std::locale Former;
};
}

#endif
