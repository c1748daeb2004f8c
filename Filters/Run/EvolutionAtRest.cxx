// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/EvolutionAtRest.h"

#include "Core/Common/ScratchMemory.h"

#include <new>

namespace volumic
{
namespace
{
/** Does what a run can do without. @return whether the memory has sufficed for it. */
template <typename Work>
bool HasRoomFor(const Work& work)
{
  try
  {
    work();
    return true;
  }
  catch (const std::bad_alloc&)
  {
    return false;
  }
  catch (const ScratchFull&)
  {
    return false;
  }
}
}

bool EvolutionAtRest::Keep(const SurfaceEvolution& evolution)
{
  this->Drop();
  const bool isKept = HasRoomFor(
    [&]
    {
      CheckedWriter file(this->File);
      evolution.Save(file);
      file.Commit();
    });
  if (!isKept)
  {
    this->Drop();
  }
  return isKept;
}

bool EvolutionAtRest::GiveTo(SurfaceEvolution& evolution)
{
  const bool hasRoom = HasRoomFor(
    [&]
    {
      CheckedReader file(this->File);
      evolution.Load(file);
    });
  this->Drop();
  return hasRoom;
}
}
