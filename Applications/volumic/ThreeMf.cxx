// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// 3MF (3MF Consortium: Core Specification 1.3), a zip of three texts.
#include "GltfScene.h"

#include "SurfaceFacts.h"
#include "ToolErrors.h"
#include "VtkWriters.h"

#include <vtkFieldData.h>
#include <vtkStringArray.h>

#include <archive.h>
#include <archive_entry.h>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <map>
#include <memory>

namespace tool
{
namespace
{
/** A new zip, its files one after the other, each in parts. */
class Zip
{
public:
  explicit Zip(const std::string& path)
    : File(path), Writer(archive_write_new(), archive_write_free)
  {
    const auto write = [](archive*, void* file, const void* bytes, std::size_t count) -> la_ssize_t
    { return static_cast<FileBuffer*>(file)->sputn(static_cast<const char*>(bytes), static_cast<std::streamsize>(count)); };
    this->Need(archive_write_set_format_zip(this->Writer.get()));
    this->Need(archive_write_set_bytes_in_last_block(this->Writer.get(), 1));
    this->Need(archive_write_open(this->Writer.get(), &this->File, nullptr, write, nullptr));
  }

  void Begin(const std::string& name)
  {
    const std::unique_ptr<archive_entry, void (*)(archive_entry*)> head(
      archive_entry_new(), archive_entry_free);
    archive_entry_set_pathname(head.get(), name.c_str());
    archive_entry_set_filetype(head.get(), AE_IFREG);
    archive_entry_set_perm(head.get(), 0644);
    const std::time_t start = 315619200; // 1980, zip's first day: the same bytes in each run
    archive_entry_set_mtime(head.get(), start, 0);
    this->Need(archive_write_header(this->Writer.get(), head.get()));
  }

  void Add(const std::string& text)
  {
    this->Text += text;
    if (this->Text.size() > 1 << 16)
    {
      this->Empty();
    }
  }

  void End()
  {
    this->Empty();
    this->Need(archive_write_finish_entry(this->Writer.get()));
  }

  void Close()
  {
    this->Need(archive_write_close(this->Writer.get()));
    this->File.Finish();
  }

private:
  void Need(la_ssize_t result)
  {
    const char* reason = result < 0 ? archive_error_string(this->Writer.get()) : nullptr;
    FailIf(result < 0, "cannot be written (" + std::string(reason ? reason : "libarchive fails") + ")");
  }

  void Empty()
  {
    this->Need(archive_write_data(this->Writer.get(), this->Text.data(), this->Text.size()));
    this->Text.clear();
  }

  FileBuffer File;
  std::unique_ptr<archive, int (*)(archive*)> Writer;
  std::string Text;
};

/** Text as XML has it. */
std::string Escaped(const std::string& text)
{
  static const std::map<char, std::string> signs = { { '&', "&amp;" }, { '<', "&lt;" },
    { '>', "&gt;" }, { '"', "&quot;" } };
  std::string escaped;
  for (const char sign : text)
  {
    const bool isControl = static_cast<unsigned char>(sign) < ' ';
    escaped += isControl ? " " : EntryOr(signs, sign, std::string(1, sign));
  }
  return escaped;
}

std::string UnitOf(vtkPolyData* surface)
{
  static const std::map<std::string, std::string> units = { { "", "millimeter" },
    { "mm", "millimeter" }, { "cm", "centimeter" }, { "m", "meter" }, { "um", "micron" } };
  auto* text =
    vtkStringArray::SafeDownCast(surface->GetFieldData()->GetAbstractArray("LengthUnit"));
  const std::string unit = text ? text->GetValue(0) : "";
  return EntryOf(units, unit, "3MF has no unit " + unit + "; --unit mm converts");
}

std::string ColorText(const Vector3& color)
{
  char text[16];
  std::snprintf(text, sizeof(text), "#%02lX%02lX%02lX", std::lround(255.0 * color[0]),
    std::lround(255.0 * color[1]), std::lround(255.0 * color[2]));
  return text;
}

/** Vertices, and triangles, each with the number of its label's material where there are several. */
void AddMesh(
  Zip& zip, vtkPolyData* surface, const std::vector<SurfaceLabel>& labels, ProgressLine& line)
{
  char text[128];
  zip.Add("<mesh><vertices>\n");
  for (vtkIdType point = 0; point < surface->GetNumberOfPoints(); ++point)
  {
    const Floats at = AsFloats(surface->GetPoint(point));
    std::snprintf(text, sizeof(text), "<vertex x=\"%.9g\" y=\"%.9g\" z=\"%.9g\"/>\n", at[0], at[1],
      at[2]);
    zip.Add(text);
  }
  zip.Add("</vertices><triangles>\n");
  std::map<int, int> materials;
  for (const SurfaceLabel& label : labels)
  {
    materials.emplace(label.Label, static_cast<int>(materials.size()));
  }
  const int* own = materials.size() > 1 ? TriangleLabels(surface) : nullptr;
  ForEachPolygon(surface,
    [&](vtkIdType triangle, const vtkIdType* corners, vtkIdType count)
    {
      FailIf(count != 3, "cannot be written (3MF has triangles only)");
      line.Show(
        static_cast<double>(triangle) / static_cast<double>(surface->GetNumberOfPolys()), "");
      std::snprintf(text, sizeof(text), "<triangle v1=\"%lld\" v2=\"%lld\" v3=\"%lld\"",
        static_cast<long long>(corners[0]), static_cast<long long>(corners[1]),
        static_cast<long long>(corners[2]));
      zip.Add(text);
      zip.Add((own ? " p1=\"" + std::to_string(EntryOr(materials, own[triangle], 0)) + "\"" : "") +
        "/>\n");
    });
  zip.Add("</triangles></mesh>");
}
}

void WriteThreeMf(
  const std::vector<SceneObject>& objects, const std::string& path, ProgressLine& line)
{
  const char* const head = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  std::string items;
  int id = 0;
  Zip zip(path);
  zip.Begin("[Content_Types].xml");
  zip.Add(std::string(head) +
    "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
    "<Default Extension=\"rels\" "
    "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
    "<Default Extension=\"model\" "
    "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>\n");
  zip.End();
  zip.Begin("_rels/.rels");
  zip.Add(std::string(head) +
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
    "<Relationship Id=\"model\" Target=\"/3D/3dmodel.model\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n");
  zip.End();
  zip.Begin("3D/3dmodel.model");
  for (const SceneObject& object : objects)
  {
    if (object.Surface->GetNumberOfPoints() == 0)
    {
      continue;
    }
    if (id == 0)
    {
      zip.Add(std::string(head) + "<model unit=\"" + UnitOf(object.Surface) +
        "\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n"
        "<metadata name=\"Application\">volumic " VOLUMIC_VERSION "</metadata>\n<resources>\n");
    }
    std::vector<SurfaceLabel> labels = LabelsOf(object.Surface);
    if (labels.empty())
    {
      labels.push_back({ 0, object.Name, { 0.9, 0.9, 0.9 } });
    }
    zip.Add("<basematerials id=\"" + std::to_string(++id) + "\">");
    for (const SurfaceLabel& label : labels)
    {
      zip.Add("<base name=\"" + Escaped(label.Name) + "\" displaycolor=\"" +
        ColorText(label.Color) + "\"/>");
    }
    zip.Add("</basematerials>\n<object id=\"" + std::to_string(id + 1) +
      "\" type=\"model\" name=\"" + Escaped(object.Name) + "\" pid=\"" + std::to_string(id) +
      "\" pindex=\"0\">");
    AddMesh(zip, object.Surface, labels, line);
    zip.Add("</object>\n");
    items += "<item objectid=\"" + std::to_string(++id) + "\"/>";
  }
  FailIf(id == 0, "cannot be written (there is no surface)");
  zip.Add("</resources>\n<build>" + items + "</build>\n</model>\n");
  zip.End();
  zip.Close();
}
}
