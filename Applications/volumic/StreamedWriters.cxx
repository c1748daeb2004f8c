// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StreamedWriters.h"

#include "FileBuffer.h"
#include "RunWriter.h"

#include <vtkCellType.h>
#include <vtkCellTypes.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkPolyDataWriter.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPolyDataWriter.h>

#include <locale>
#include <memory>
#include <ostream>
#include <sstream>

namespace tool
{
namespace
{
template <class Object>
Object* NewObject()
{
  auto* object = new Object;
  object->InitializeObjectBase();
  return object;
}

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

vtkSmartPointer<vtkPolyData> AsTriangles(vtkPolyData* surface)
{
  auto triangles = vtkSmartPointer<TriangleData>::New();
  triangles->ShallowCopy(surface);
  return triangles;
}

void WriteVtp(vtkPolyData* surface, const std::string& path, ProgressLine& line)
{
  vtkNew<XmlStreamWriter<vtkXMLPolyDataWriter>> writer;
  WriteInline(writer.Get(), AsTriangles(surface), path, line);
}

void WriteLegacy(vtkPolyData* surface, const std::string& path, ProgressLine& line)
{
  FileBuffer file(path);
  vtkNew<LegacyStreamWriter> writer;
  writer->Buffer = &file;
  writer->SetInputData(surface);
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
}
