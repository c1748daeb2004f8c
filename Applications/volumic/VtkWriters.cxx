// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "VtkWriters.h"

#include "ToolErrors.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkCellType.h>
#include <vtkCellTypes.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkPolyDataWriter.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <locale>
#include <memory>
#include <ostream>
#include <sstream>
#include <system_error>

namespace tool
{
void RunWriter(vtkAlgorithm* writer, const std::function<void()>& write, ProgressLine& line)
{
  VtkMessages messages;
  messages.ListenTo(writer);
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(&line);
  observer->SetCallback(
    [](vtkObject* caller, unsigned long, void* to, void*) {
      static_cast<ProgressLine*>(to)->Show(static_cast<vtkAlgorithm*>(caller)->GetProgress(), "");
    });
  writer->AddObserver(vtkCommand::ProgressEvent, observer);
  messages.Catch(write);
  if (!messages.Errors.empty() || writer->GetErrorCode() != 0)
  {
    const std::string reason = messages.JoinedErrors();
    const bool isTold = !reason.empty() && reason != VtkMessages::Untold;
    throw Failure("cannot be written (" + (isTold ? reason : "is the disk full?") + ")");
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

// ---- VTK's own formats --------------------------------------------------------------------------

namespace
{
template <class Object>
Object* NewObject()
{
  auto* object = new Object;
  object->InitializeObjectBase();
  return object;
}

/**
 * A surface that knows that its cells are triangles: VTK's writers make a table of the types of the
 * cells of others, eight bytes each.
 */
class TriangleData : public vtkPolyData
{
public:
  static TriangleData* New() { return NewObject<TriangleData>(); }

  // VTK 9.6 asks by the second name; no `override`, as each version has one that others lack.
  virtual void GetCellTypes(vtkCellTypes* types) { this->GetDistinctCellTypes(types); }
  virtual void GetDistinctCellTypes(vtkCellTypes* types)
  {
    types->Reset();
    if (this->GetNumberOfCells() > 0)
    {
      types->InsertNextType(VTK_TRIANGLE);
    }
  }
};

/** A writer of XML files that writes to a stream of ours. */
template <class Writer>
class XmlStreamWriter : public Writer
{
public:
  static XmlStreamWriter* New() { return NewObject<XmlStreamWriter>(); }

  void SetStream(std::ostream* stream) { this->Stream = stream; }
};

/** As XmlStreamWriter; the superclass deletes its stream, but not the buffer. */
class LegacyStreamWriter : public vtkPolyDataWriter
{
public:
  static LegacyStreamWriter* New() { return NewObject<LegacyStreamWriter>(); }

  std::streambuf* Buffer = nullptr;

protected:
  std::ostream* OpenVTKFile() override
  {
    this->WriteToOutputStringOn(); // it opens a text then, and writes the head into it
    const std::unique_ptr<std::ostream> head(this->vtkPolyDataWriter::OpenVTKFile());
    this->WriteToOutputStringOff();
    const auto* text = dynamic_cast<std::ostringstream*>(head.get());
    auto stream = std::make_unique<std::ostream>(this->Buffer);
    stream->imbue(std::locale::classic());
    *stream << (text ? text->str() : std::string());
    return stream.release();
  }
};

/**
 * With the data inline: ParaView 5.11's readers, with an expat of 2024 or later, take what is
 * appended for damaged.
 */
template <class Writer>
void WriteInline(
  XmlStreamWriter<Writer>* writer, vtkDataObject* data, const std::string& path, ProgressLine& line)
{
  FileBuffer file(path);
  std::ostream stream(&file);
  writer->SetInputData(data);
  writer->SetDataModeToBinary();
  writer->SetStream(&stream);
  RunWriter(writer, line);
  file.Finish();
}
}

void WriteVtp(vtkPolyData* surface, const std::string& path, ProgressLine& line)
{
  vtkNew<XmlStreamWriter<vtkXMLPolyDataWriter>> writer;
  vtkSmartPointer<vtkPolyData> written = surface;
  if (surface->GetNumberOfLines() == 0)
  {
    written = vtkSmartPointer<TriangleData>::New();
    written->ShallowCopy(surface);
  }
  writer->SetCompressorTypeToLZ4(); // nine times as fast as zlib, at 1.6 times the size
  WriteInline(writer.Get(), written, path, line);
}

void WriteVtu(vtkUnstructuredGrid* grid, const std::string& path, ProgressLine& line)
{
  vtkNew<XmlStreamWriter<vtkXMLUnstructuredGridWriter>> writer;
  writer->SetCompressorTypeToLZ4();
  WriteInline(writer.Get(), grid, path, line);
}

void WriteLegacy(
  vtkPolyData* surface, const std::string& path, const std::string& head, ProgressLine& line)
{
  FileBuffer file(path);
  vtkNew<LegacyStreamWriter> writer;
  writer->Buffer = &file;
  writer->SetInputData(surface);
  writer->SetHeader(head.substr(0, 255).c_str()); // All that readers take.
  writer->SetFileTypeToBinary();
  RunWriter(writer.Get(), line);
  file.Finish();
}

void WriteVti(vtkImageData* volume, const std::string& path, ProgressLine& line)
{
  vtkNew<XmlStreamWriter<vtkXMLImageDataWriter>> writer;
  writer->SetCompressorTypeToLZ4(); // four times as fast as zlib, at 1.5 times the size (a CT)
  WriteInline(writer.Get(), volume, path, line);
}

FileBuffer::FileBuffer(const std::string& path)
  : File(path, O_WRONLY | O_CREAT | O_TRUNC), Buffer(1 << 20)
{
  this->KeepError(this->File.IsOpen());
  this->setp(this->Buffer.data(), this->Buffer.data() + this->Buffer.size());
}

void FileBuffer::Finish()
{
  this->Empty();
  this->KeepError(this->File.Close());
  if (this->Error != 0)
  {
    throw Failure("cannot be written (" + SystemReason(this->Error) + ")");
  }
}

FileBuffer::int_type FileBuffer::overflow(int_type character)
{
  this->Empty();
  if (!traits_type::eq_int_type(character, traits_type::eof()))
  {
    *this->pptr() = traits_type::to_char_type(character);
    this->pbump(1);
  }
  return traits_type::not_eof(character);
}

int FileBuffer::sync()
{
  this->Empty();
  return 0;
}

FileBuffer::pos_type FileBuffer::seekoff(
  off_type distance, std::ios_base::seekdir from, std::ios_base::openmode)
{
  const off_type here = this->Start + (this->pptr() - this->pbase());
  if (from == std::ios_base::cur && distance == 0) // where are we: nothing moves
  {
    return here;
  }
  this->Empty();
  this->Start = distance +
    (from == std::ios_base::cur      ? here
        : from == std::ios_base::end ? this->End
                                     : 0);
  if (this->Error == 0)
  {
    this->KeepError(this->File.Seek(this->Start));
  }
  return this->Start;
}

FileBuffer::pos_type FileBuffer::seekpos(pos_type place, std::ios_base::openmode which)
{
  return this->seekoff(place, std::ios_base::beg, which);
}

void FileBuffer::Empty()
{
  const off_type count = this->pptr() - this->pbase();
  if (this->Error == 0)
  {
    this->KeepError(this->File.Write(this->pbase(), static_cast<std::size_t>(count)));
  }
  this->Start += count;
  this->End = std::max(this->End, this->Start);
  this->setp(this->Buffer.data(), this->Buffer.data() + this->Buffer.size());
}

void FileBuffer::KeepError(bool isWell)
{
  if (!isWell && this->Error == 0)
  {
    this->Error = errno;
  }
}
}
