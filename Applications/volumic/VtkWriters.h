// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVtkWriters_h
#define volumicVtkWriters_h

#include "Descriptor.h"
#include "Messages.h"

#include <vtkSmartPointer.h>

#include <cstdint>
#include <functional>
#include <streambuf>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkImageData;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace tool
{
/**
 * Have a writer of VTK, whose input and file are set, do its work: `write` calls its Write, which
 * is no method of what they have in common. What it tells of its progress is shown. It cannot be
 * interrupted: what there is of an interrupted run is to be written.
 * @throws Failure, without the name of the file, if it reports an error.
 */
void RunWriter(vtkAlgorithm* writer, const std::function<void()>& write, ProgressLine& line);

template <class Writer>
void RunWriter(Writer* writer, ProgressLine& line)
{
  RunWriter(
    writer, [writer] { writer->Write(); }, line);
}

// ---- What the disk took -------------------------------------------------------------------------

// Most of VTK's writers don't look whether the disk took what they wrote. All throw a Failure,
// without the name of the file, if something is missing.

/** The file ends with a complete line, and has no fewer than this many. */
void CheckLines(const std::string& path, std::uint64_t lines);

// ---- VTK's own formats --------------------------------------------------------------------------

// The writers of VTK's own formats, with a full disk told (see FileBuffer) and no memory but some
// megabytes, whatever the size of what they write. All throw a Failure without the file's name.

/** The surface as .vtp; its cells are triangles, or lines too. */
void WriteVtp(vtkPolyData* surface, const std::string& path, ProgressLine& line);

/** The surface in VTK's legacy format, binary. @param head of which the file has a line */
void WriteLegacy(
  vtkPolyData* surface, const std::string& path, const std::string& head, ProgressLine& line);

/** Tetrahedra as .vtu. */
void WriteVtu(vtkUnstructuredGrid* grid, const std::string& path, ProgressLine& line);

/** The volume as .vti. */
void WriteVti(vtkImageData* volume, const std::string& path, ProgressLine& line);

/**
 * A new file for the stream of a writer of VTK. On a full disk such writers end the program, or
 * destroy memory; so this takes all that they write, keeps the first error of the system to itself,
 * and tells it at the end.
 */
class FileBuffer : public std::streambuf
{
public:
  explicit FileBuffer(const std::string& path);

  /** To call when all is written. @throws Failure with the system's reason, without the name. */
  void Finish();

private:
  int_type overflow(int_type character) override;
  int sync() override;
  pos_type seekoff(
    off_type distance, std::ios_base::seekdir from, std::ios_base::openmode which) override;
  pos_type seekpos(pos_type place, std::ios_base::openmode which) override;

  /** Hand the buffer to the file. */
  void Empty();
  void KeepError(bool isWell);

  Descriptor File;
  std::vector<char> Buffer;
  off_type Start = 0; ///< of the buffer, in the file
  off_type End = 0;   ///< of the file
  int Error = 0;      ///< errno of what failed first
};
}

#endif
