// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Writes volumes of any size, slab by slab, in some megabytes of memory: what surfaces larger than
 * memory are measured on.
 *
 *     MakeVolume resample SIZE FILE.vti OUTPUT.vti
 *     MakeVolume foam SIZE OUTPUT.vti
 *     MakeVolume body SIZE LABELS OUTPUT.vti
 *
 * `resample`: another volume on SIZE^3 voxels of its own type, linearly interpolated, the voxels at
 * the border where they were. `foam`: one sheet that fills space, a gyroid whose cells are about 17
 * voxels wide and vary; at the iso-value 0.5, which no voxel equals, .1 vertex a voxel. `body`: the
 * label map of LabelShapes.h, at once.
 * Outputs are .vti with their data appended and raw, of which readers can take any part.
 */

#include "LabelShapes.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkImageResize.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLImageDataReader.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

/** A cube of voxels, handed over layer by layer along the third axis. */
class VolumeFile
{
public:
  /** `geometry`: attributes of the .vti, its spacing and more. `type`: VTK's name, as "Int16". */
  VolumeFile(const std::string& name, int size, const std::string& geometry,
    const std::string& type, int bytesOfVoxel)
    : Name(name), File(name, std::ios::binary)
  {
    const std::uint64_t bytes = static_cast<std::uint64_t>(size) * size * size * bytesOfVoxel;
    const std::uint16_t one = 1;
    const bool isLittle = *reinterpret_cast<const char*>(&one) == 1;
    std::ostringstream extent;
    extent << "0 " << size - 1 << " 0 " << size - 1 << " 0 " << size - 1;
    this->File << "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\""
               << (isLittle ? "LittleEndian" : "BigEndian") << "\" header_type=\"UInt64\">\n"
               << "  <ImageData WholeExtent=\"" << extent.str() << "\" " << geometry << ">\n"
               << "    <Piece Extent=\"" << extent.str() << "\">\n"
               << "      <PointData Scalars=\"Voxels\">\n        <DataArray type=\"" << type
               << "\" Name=\"Voxels\" format=\"appended\" offset=\"0\"/>\n      </PointData>\n"
               << "    </Piece>\n  </ImageData>\n  <AppendedData encoding=\"raw\">\n_";
    this->Append(&bytes, sizeof bytes);
  }

  void Append(const void* bytes, std::size_t count)
  {
    this->File.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(count));
    this->Check();
  }

  void Finish()
  {
    this->File << "\n  </AppendedData>\n</VTKFile>\n";
    this->File.close();
    this->Check();
  }

private:
  void Check() const
  {
    if (!this->File)
    {
      throw std::runtime_error(this->Name + ": can't be written; is the disk full?");
    }
  }

  std::string Name;
  std::ofstream File;
};

std::string Joined(const double* values, int count)
{
  std::ostringstream text;
  text.precision(17);
  for (int i = 0; i < count; ++i)
  {
    text << (i > 0 ? " " : "") << values[i];
  }
  return text.str();
}

std::string GeometryOf(vtkImageData* image)
{
  return "Origin=\"" + Joined(image->GetOrigin(), 3) + "\" Spacing=\"" +
    Joined(image->GetSpacing(), 3) + "\" Direction=\"" +
    Joined(image->GetDirectionMatrix()->GetData(), 9) + "\"";
}

/** As it is called in .vti files. */
std::string TypeName(vtkDataArray* array)
{
  const bool isFloat = array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE;
  const std::string kind = isFloat ? "Float" : array->GetDataTypeMin() < 0.0 ? "Int" : "UInt";
  return kind + std::to_string(8 * array->GetDataTypeSize());
}

vtkDataArray* ScalarsOf(vtkImageData* image, const std::string& source)
{
  vtkDataArray* voxels = image->GetPointData()->GetScalars();
  if (!voxels || voxels->GetNumberOfComponents() != 1)
  {
    throw std::runtime_error(source + ": has no point scalars of one component");
  }
  return voxels;
}

void Resample(int size, const std::string& source, const std::string& name)
{
  vtkNew<vtkXMLImageDataReader> reader;
  if (!reader->CanReadFile(source.c_str()))
  {
    throw std::runtime_error(source + ": not a readable .vti file");
  }
  reader->SetFileName(source.c_str());
  reader->Update();
  const std::string type = TypeName(ScalarsOf(reader->GetOutput(), source));
  vtkNew<vtkImageResize> resize;
  resize->SetInputConnection(reader->GetOutputPort());
  resize->SetResizeMethodToOutputDimensions();
  resize->SetOutputDimensions(size, size, size);
  std::unique_ptr<VolumeFile> file;
  const int layers = 8;
  for (int first = 0; first < size; first += layers)
  {
    const int last = std::min(size, first + layers) - 1;
    const int slab[] = { 0, size - 1, 0, size - 1, first, last };
    resize->UpdateExtent(slab);
    vtkImageData* image = resize->GetOutput();
    vtkDataArray* voxels = ScalarsOf(image, source);
    if (!std::equal(slab, slab + 6, image->GetExtent()))
    {
      throw std::runtime_error("VTK made another slab than it was asked for");
    }
    if (!file)
    {
      file = std::make_unique<VolumeFile>(
        name, size, GeometryOf(image), type, voxels->GetDataTypeSize());
    }
    file->Append(voxels->GetVoidPointer(0),
      static_cast<std::size_t>(voxels->GetNumberOfValues()) * voxels->GetDataTypeSize());
  }
  file->Finish();
}

//------------------------------------------------------------------------------
/**
 * sin x cos y + sin y cos z + sin z cos x, where x, y, z grow with the voxels along the axes, now
 * faster and now slower, so that no two cells are the same.
 */
void MakeFoam(int size, const std::string& name)
{
  const double width = 17.0; // voxels of a cell
  const double turn = 6.283185307179586;
  std::array<std::vector<double>, 3> sines, cosines;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int i = 0; i < size; ++i)
    {
      const double cell = i / width;
      const double angle = turn * (cell + 0.1 * std::sin(turn * cell / (5.3 + 0.9 * axis)));
      sines[axis].push_back(std::sin(angle));
      cosines[axis].push_back(std::cos(angle));
    }
  }
  const auto& [sinX, sinY, sinZ] = sines;
  const auto& [cosX, cosY, cosZ] = cosines;
  VolumeFile file(name, size, "Origin=\"0 0 0\" Spacing=\"1 1 1\"", "Int16", 2);
  std::vector<std::int16_t> row(static_cast<std::size_t>(size));
  for (int k = 0; k < size; ++k)
  {
    for (int j = 0; j < size; ++j)
    {
      for (int i = 0; i < size; ++i)
      {
        const double value = sinX[i] * cosY[j] + sinY[j] * cosZ[k] + sinZ[k] * cosX[i];
        row[i] = static_cast<std::int16_t>(std::floor(1000.0 * value + 0.5));
      }
      file.Append(row.data(), sizeof(std::int16_t) * row.size());
    }
  }
  file.Finish();
}

void MakeBody(int size, int labels, const std::string& name)
{
  const volumic::support::LabelMap map = volumic::support::MakeBodyMap({ size, size, size }, labels);
  VolumeFile file(name, size,
    "Origin=\"0 0 0\" Spacing=\"" + Joined(map.Spacing.data(), 3) + "\"", "Int16", 2);
  file.Append(map.Values.data(), sizeof(std::int16_t) * map.Values.size());
  file.Finish();
}

const char* const Usage = "Usage: MakeVolume resample SIZE FILE.vti OUTPUT.vti\n"
                          "       MakeVolume foam SIZE OUTPUT.vti\n"
                          "       MakeVolume body SIZE LABELS OUTPUT.vti\n"
                          "Writes a volume of SIZE^3 voxels, whatever the memory: another one\n"
                          "resampled, or a foam, of .1 vertex a voxel at an iso-value of 0.5; or\n"
                          "a map of so many labels, ellipsoids and tubes.\n";

/** 0 if it is none. */
int ToSize(const std::string& text)
{
  const bool isNumber = !text.empty() && text.size() < 6 &&
    text.find_first_not_of("0123456789") == std::string::npos;
  const int size = isNumber ? std::stoi(text) : 0;
  return size >= 2 ? size : 0;
}

} // namespace

int main(int argc, char** argv)
{
  const std::vector<std::string> words(argv + 1, argv + argc);
  const int size = words.size() > 1 ? ToSize(words[1]) : 0;
  const bool isFoam = words.size() == 3 && words[0] == "foam";
  const bool isResampled = words.size() == 4 && words[0] == "resample";
  const bool isBody = words.size() == 4 && words[0] == "body" && ToSize(words[2]) > 0;
  if (size == 0 || (!isFoam && !isResampled && !isBody))
  {
    std::cerr << Usage;
    return 2;
  }
  try
  {
    if (isFoam)
    {
      MakeFoam(size, words[2]);
    }
    else if (isBody)
    {
      MakeBody(size, ToSize(words[2]), words[3]);
    }
    else
    {
      Resample(size, words[2], words[3]);
    }
    return 0;
  }
  catch (const std::exception& error)
  {
    std::cerr << "MakeVolume: " << error.what() << std::endl;
    return 1;
  }
}
