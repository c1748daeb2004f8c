// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicXmlMeter_h
#define volumicXmlMeter_h

#include "BinaryFile.h"
#include "ToolErrors.h"

#include <vtkXMLParser.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace tool
{
/** An array, as its element tells of it. */
struct XmlArray
{
  std::string Name;
  std::int64_t Place = 0; ///< of its element; of an appended one behind the first byte of all
  bool IsAppended = false;
  bool IsText = false;
  bool IsOfCorners = false;            ///< the points of polygons, however many there are
  std::uint64_t Bytes = 0;             ///< of a number; 0: they are texts, or bits
  std::optional<std::uint64_t> Values; ///< that there must be, if that is known
};

/** Reads what VTK's readers do, by the same parser, and keeps next to nothing. */
class XmlMeter : public vtkXMLParser
{
public:
  static XmlMeter* New();
  vtkTypeMacro(XmlMeter, vtkXMLParser);

  bool IsTooDeep = false;
  bool IsPacked = false;
  bool IsBig = false;
  bool IsRaw = false;         ///< what is appended; else in base64
  std::size_t WordBytes = 4;  ///< of numbers before arrays
  std::int64_t Appended = -1; ///< where the element begins
  std::vector<XmlArray> Arrays;

protected:
  void StartElement(const char* name, const char** attributes) override
  {
    constexpr int deepest = 100;
    this->IsTooDeep = this->IsTooDeep || ++this->Depth > deepest;
    const auto text = [attributes](const char* key)
    {
      const char** each = attributes;
      for (; *each && std::strcmp(*each, key) != 0; each += 2)
      {
      }
      return std::string(*each ? each[1] : "");
    };
    const std::string kind = name;
    if (kind == "VTKFile")
    {
      this->IsPacked = !text("compressor").empty();
      this->IsBig = text("byte_order") == "BigEndian";
      this->WordBytes = text("header_type") == "UInt64" ? 8 : 4;
    }
    else if (kind == "AppendedData" && this->Appended < 0)
    {
      this->Appended = static_cast<std::int64_t>(this->GetXMLByteIndex());
      this->IsRaw = text("encoding") == "raw";
    }
    else if (kind == "DataArray" || kind == "Array")
    {
      this->AddArray(text);
    }
    else if (!text("WholeExtent").empty())
    {
      this->Whole = ExtentOf(text("WholeExtent"));
    }
    else if (kind == "Piece")
    {
      this->CountPiece(text);
    }
    else
    {
      this->Section = kind;
    }
  }
  void EndElement(const char*) override { --this->Depth; }
  /** What is appended is no XML. */
  int ParsingComplete() override { return this->IsTooDeep || this->Appended >= 0 ? 1 : 0; }
  void ReportXmlParseError() override {} // VTK's reader tells of it.

private:
  using Extent = std::array<std::int64_t, 6>;

  static Extent ExtentOf(const std::string& text)
  {
    Extent e = { 0, -1, 0, -1, 0, -1 };
    std::istringstream(text) >> e[0] >> e[1] >> e[2] >> e[3] >> e[4] >> e[5];
    return e;
  }

  static std::uint64_t Number(const std::string& text)
  {
    return std::strtoull(text.c_str(), nullptr, 10);
  }

  /** How many values arrays of the sections of this piece have. */
  template <class Text>
  void CountPiece(const Text& text)
  {
    this->Counts.clear();
    if (text("Extent").empty())
    {
      this->Counts["PointData"] = this->Counts["Points"] = Number(text("NumberOfPoints"));
      for (const char* cells : { "Verts", "Lines", "Strips", "Polys" })
      {
        this->Counts[cells] = Number(text((std::string("NumberOf") + cells).c_str()));
        this->Counts["CellData"] += this->Counts[cells];
      }
      return;
    }
    const Extent extent = ExtentOf(text("Extent"));
    this->Counts["PointData"] = this->Counts["CellData"] = 1;
    for (std::size_t a = 0; a < 6; a += 2)
    {
      const auto steps =
        static_cast<std::uint64_t>(std::max<std::int64_t>(extent[a + 1] - extent[a], 0));
      const bool isFlat = this->Whole[a] == this->Whole[a + 1]; // with a layer of cells
      this->Counts["PointData"] = Times(this->Counts["PointData"], steps + 1);
      this->Counts["CellData"] = Times(this->Counts["CellData"], isFlat ? 1 : steps);
    }
  }

  template <class Text>
  void AddArray(const Text& text)
  {
    static const std::map<std::string, std::uint64_t> bytes = { { "Int8", 1 }, { "UInt8", 1 },
      { "Int16", 2 }, { "UInt16", 2 }, { "Int32", 4 }, { "UInt32", 4 }, { "Int64", 8 },
      { "UInt64", 8 }, { "Float32", 4 }, { "Float64", 8 } };
    XmlArray array;
    array.Name = text("Name");
    array.Bytes = EntryOr(bytes, text("type"), 0);
    const std::string offset = text("offset"); // whatever the format
    array.IsAppended = !offset.empty();
    array.IsText = !array.IsAppended && text("format") != "binary";
    array.Place = array.IsAppended ? std::atoll(offset.c_str())
                                   : static_cast<std::int64_t>(this->GetXMLByteIndex());
    const auto counted = this->Counts.find(this->Section);
    const std::string components = text("NumberOfComponents");
    const std::uint64_t each = components.empty() ? 1 : Number(components);
    array.IsOfCorners = array.Name == "connectivity" && counted != this->Counts.end();
    if (this->Section == "FieldData" && !text("NumberOfTuples").empty())
    {
      array.Values = Times(Number(text("NumberOfTuples")), each);
    }
    else if (counted != this->Counts.end() && !array.IsOfCorners)
    {
      array.Values = Times(counted->second, each);
    }
    this->Arrays.push_back(array);
  }

  int Depth = 0;
  Extent Whole = { 0, -1, 0, -1, 0, -1 };
  std::string Section; ///< the last element that is none of an array
  std::map<std::string, std::uint64_t> Counts;
};
}

#endif
