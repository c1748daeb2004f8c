// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RunWriter.h"

#include "ToolErrors.h"
#include "VtkMessages.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkNew.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

namespace tool
{
void RunWriter(vtkAlgorithm* writer, const std::function<void()>& write, ProgressLine& line)
{
  VtkMessages messages;
  messages.ListenTo(writer);
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(&line);
  observer->SetCallback([](vtkObject* caller, unsigned long, void* to, void*)
    { static_cast<ProgressLine*>(to)->Show(static_cast<vtkAlgorithm*>(caller)->GetProgress(), ""); });
  writer->AddObserver(vtkCommand::ProgressEvent, observer);
  messages.Catch(write);
  if (!messages.Errors.empty() || writer->GetErrorCode() != 0)
  {
    const std::string reason = messages.JoinedErrors();
    throw Failure("cannot be written (" + (reason.empty() ? "is the disk full?" : reason) + ")");
  }
}

// ---- How a file grows ---------------------------------------------------------------------------

FileGrowth::FileGrowth(const std::string& path, std::uint64_t bytes, ProgressLine& line)
{
  if (!line.IsShown())
  {
    return;
  }
  try
  {
    this->Watcher = std::thread([this, path, bytes, &line] { this->Watch(path, bytes, line); });
  }
  catch (const std::system_error&)
  {
    // No thread can be had: the file is written all the same.
  }
}

FileGrowth::~FileGrowth()
{
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->IsOver = true;
  }
  this->Changed.notify_all();
  if (this->Watcher.joinable())
  {
    this->Watcher.join();
  }
}

void FileGrowth::Watch(const std::string& path, std::uint64_t bytes, ProgressLine& line)
{
  std::unique_lock<std::mutex> lock(this->Mutex);
  const std::chrono::milliseconds pause(100);
  while (!this->Changed.wait_for(lock, pause, [this] { return this->IsOver; }))
  {
    std::error_code failed;
    const std::uintmax_t size = std::filesystem::file_size(path, failed);
    if (!failed && bytes > 0)
    {
      line.Show(static_cast<double>(size) / static_cast<double>(bytes), "");
    }
  }
}

// ---- What the disk took -------------------------------------------------------------------------

namespace
{
namespace fs = std::filesystem;

void Refuse(const std::string& reason)
{
  throw Failure("cannot be written (" + reason + "; is the disk full?)");
}

std::uint64_t SizeOf(const std::string& path)
{
  std::error_code failed;
  const std::uintmax_t size = fs::file_size(path, failed);
  return failed ? 0 : size;
}
}

void CheckSize(const std::string& path, std::uint64_t bytes)
{
  const std::uint64_t size = SizeOf(path);
  if (size != bytes)
  {
    Refuse(std::to_string(size) + " of " + std::to_string(bytes) + " bytes were");
  }
}

void CheckLines(const std::string& path, std::uint64_t lines)
{
  std::ifstream file(path, std::ios::binary);
  std::vector<char> piece(1 << 16);
  std::uint64_t found = 0;
  char last = ' ';
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())), file.gcount() > 0)
  {
    const auto end = piece.begin() + file.gcount();
    found += static_cast<std::uint64_t>(std::count(piece.begin(), end, '\n'));
    last = *(end - 1);
  }
  if (found < lines || last != '\n')
  {
    Refuse(std::to_string(found) + " of " + std::to_string(lines) + " lines were");
  }
}

void CheckXml(const std::string& path)
{
  if (fs::is_directory(path))
  {
    for (const auto& entry : fs::directory_iterator(path))
    {
      CheckXml(entry.path().string());
    }
    return;
  }
  const std::string end = "</VTKFile>";
  const std::uint64_t size = SizeOf(path);
  const std::uint64_t tail = std::min<std::uint64_t>(size, end.size() + 2);
  std::string found(tail, ' ');
  std::ifstream file(path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(size - tail));
  file.read(found.data(), static_cast<std::streamsize>(tail));
  if (found.find(end) == std::string::npos)
  {
    Refuse("only " + std::to_string(size) + " bytes of it were");
  }
}
}
