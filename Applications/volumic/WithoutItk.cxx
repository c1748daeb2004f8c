// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// In the place of what reads by ITK, where it was not found.
#include "SlabReader.h"

namespace tool
{
namespace
{
[[noreturn]] void Refuse()
{
  throw Failure("of a format that is read by ITK, without which this program was built (Debian: "
                "libinsighttoolkit5-dev)");
}
}

std::unique_ptr<SlabReader> OpenDicom(
  const std::vector<std::string>&, const std::string&, const Opening&)
{
  Refuse();
}

std::unique_ptr<SlabReader> OpenGipl(const std::string&, const Opening&)
{
  Refuse();
}

std::unique_ptr<SlabReader> OpenMinc2(const std::string&, const Opening&)
{
  Refuse();
}

std::vector<std::string> ListSeries(const std::string&)
{
  Refuse();
}
}
