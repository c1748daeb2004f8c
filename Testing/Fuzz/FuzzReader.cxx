// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// One program for each format that `volumic` reads, by VOLUMIC_FUZZED_SUFFIX: libFuzzer makes up
// files of it, and each must be read or refused by a Failure. Whatever else ends the program, or
// takes too long or too much memory, is an error of the reader. How to run them is told in
// Documentation/development.md.

#include "LabelNames.h"
#include "ReadStart.h"
#include "ReadVolume.h"
#include "ToolErrors.h"

#include <vtkAlgorithm.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

namespace
{
namespace fs = std::filesystem;

/** A folder that this process has for itself, in memory where there is such a place. */
const fs::path& Folder()
{
  static const fs::path folder = []
  {
    const fs::path parent =
      fs::exists("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path();
    const fs::path own = parent / ("volumic-fuzz-" + std::to_string(getpid()));
    fs::create_directories(own / "volume");
    fs::create_directories(own / "scratch");
    return own;
  }();
  return folder;
}

/** The readers say that they throw Failures alone. */
template <class Read>
void Try(const Read& read)
{
  try
  {
    read();
  }
  catch (const tool::Failure&)
  {
    // Refused.
  }
}

bool Is(const std::string& suffix)
{
  return suffix == VOLUMIC_FUZZED_SUFFIX;
}

void ReadAll(const std::string& name)
{
  if (Is(".json") || Is(".txt"))
  {
    Try([&] { tool::ReadLabelNames(name); });
    return;
  }
  const bool isMesh = Is(".ply") || Is(".stl") || Is(".vtp") || Is(".obj") || Is(".csv");
  if (isMesh || Is(".vtk"))
  {
    Try([&] { tool::ReadSurface(name); });
    Try([&] { tool::ReadSeeds(name); });
    Try([&] { tool::ReadAttractingPoints(name); });
  }
  if (isMesh)
  {
    return;
  }
  tool::ReadNamesWithin(name);
  Try([&] { tool::ReadVolume(name); });
  Try(
    [&]
    {
      // What is wrong with the voxels is an error of the source, which prints it.
      const auto opened = tool::OpenVolume(name, "", (Folder() / "scratch").string());
      vtkObject::GlobalWarningDisplayOff();
      opened.Source->Update();
      vtkObject::GlobalWarningDisplayOn();
    });
}
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  const std::string name =
    (Folder() / "volume" / (std::string("a") + VOLUMIC_FUZZED_SUFFIX)).string();
  std::ofstream(name, std::ios::binary)
    .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  ReadAll(name);
  return 0;
}
