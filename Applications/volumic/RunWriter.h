// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRunWriter_h
#define volumicRunWriter_h

#include "ProgressLine.h"

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

class vtkAlgorithm;

namespace tool
{
/**
 * Have a writer of VTK, whose input and file are set, do its work: `write` calls its Write, which is
 * no method of what they have in common. What it tells of its progress is shown. It cannot be
 * interrupted: what there is of an interrupted run is to be written.
 * @throws Failure, without the name of the file, if it reports an error.
 */
void RunWriter(vtkAlgorithm* writer, const std::function<void()>& write, ProgressLine& line);

template <class Writer>
void RunWriter(Writer* writer, ProgressLine& line)
{
  RunWriter(writer, [writer] { writer->Write(); }, line);
}

// ---- How a file grows ---------------------------------------------------------------------------

/**
 * As long as it is there, shows how a file grows to the size that it will have: for writers that do
 * not tell how far they are.
 */
class FileGrowth
{
public:
  FileGrowth(const std::string& path, std::uint64_t bytes, ProgressLine& line);
  ~FileGrowth();
  FileGrowth(const FileGrowth&) = delete;
  FileGrowth& operator=(const FileGrowth&) = delete;

private:
  void Watch(const std::string& path, std::uint64_t bytes, ProgressLine& line);

  std::mutex Mutex;
  std::condition_variable Changed;
  bool IsOver = false;
  std::thread Watcher;
};

// ---- What the disk took -------------------------------------------------------------------------

// Most of VTK's writers don't look whether the disk took what they wrote. All throw a Failure,
// without the name of the file, if something is missing.

/** The file has this many bytes. */
void CheckSize(const std::string& path, std::uint64_t bytes);

/** The file ends with a complete line, and has no fewer than this many. */
void CheckLines(const std::string& path, std::uint64_t lines);

/** The file, or each one of a folder, ends as VTK's XML files do. */
void CheckXml(const std::string& path);
}

#endif
