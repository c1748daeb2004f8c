// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVtkReaders_h
#define volumicVtkReaders_h

#include "SlabReader.h"
#include "ToolErrors.h"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <functional>
#include <string>

class vtkAlgorithm;
class vtkImageReader2;
class vtkMatrix4x4;

namespace tool
{
/** The image that a reader of VTK gives. @throws Failure if it, or one within it, complains. */
vtkSmartPointer<vtkImageData> ImageOf(vtkAlgorithm* reader, const std::string& name);

template <class Reader>
vtkSmartPointer<vtkImageData> ReadWith(const std::string& name)
{
  vtkNew<Reader> reader;
  reader->SetFileName(name.c_str());
  return ImageOf(reader, name);
}

/** The one of VTK's readers of images that takes the file for its own. @throws Failure for none. */
vtkSmartPointer<vtkImageReader2> ReaderOf(const std::string& name);

/** A reader for the file. @throws Failure if it is of another format. */
template <class Reader>
vtkSmartPointer<Reader> NewReader(const std::string& name)
{
  auto reader = vtkSmartPointer<Reader>::New();
  if (!reader->CanReadFile(name.c_str()))
  {
    throw Failure(name + ": is not what its suffix says");
  }
  reader->SetFileName(name.c_str());
  return reader;
}

template <class Reader>
vtkSmartPointer<vtkImageData> ReadIfItsFormat(const std::string& name)
{
  return ImageOf(NewReader<Reader>(name), name);
}

/** Columns of the matrix, each times the spacing along its axis, and the translation. */
VolumePlacement PlacementOf(vtkMatrix4x4* matrix, const double* spacing);

/**
 * Slices by a reader of VTK that gives parts of an image: each time by a new one, as vtkTIFFReader
 * gives other slices when it is asked again.
 */
class ReaderSlabs : public SlabReader
{
public:
  using Factory = std::function<vtkSmartPointer<vtkImageReader2>()>;

  /** Size, type and so on are what a reader of the file `name` tells. */
  ReaderSlabs(const std::string& name, const Factory& make);

  bool HasTrustedWarnings = true; ///< as VtkMessages::UpdateReader says
  bool IsReversed = false; ///< The reader reverses the slices, of each part by itself.
  double Slope = 1.0; ///< What is read gets multiplied,
  double Shift = 0.0; ///< and shifted, and is float then.

  vtkSmartPointer<vtkDataArray> Read(int first, int count) override;

private:
  std::string Name;
  Factory Make;
};
}

#endif
