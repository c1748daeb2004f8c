// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "RunFigures.h"

#include <limits>
#include <ostream>

namespace volumic::bench
{
double RunFigures::Get(const std::string& name) const
{
  const auto found = this->Numbers.find(name);
  return found == this->Numbers.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

std::string RunFigures::GetText(const std::string& name) const
{
  const auto found = this->Texts.find(name);
  return found == this->Texts.end() ? std::string() : found->second;
}

void RunFigures::Write(std::ostream& stream) const
{
  stream.precision(17);
  for (const auto& [name, value] : this->Numbers)
  {
    stream << "@number " << name << ' ' << value << '\n';
  }
  for (const auto& [name, text] : this->Texts)
  {
    stream << "@text " << name << ' ' << text << '\n';
  }
  stream.flush();
}

} // namespace volumic::bench
