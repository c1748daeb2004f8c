// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Build the pyramid of an image and write it as blocks:
//   BuildPyramid IN.vti OUT.vtm [NUMBER_OF_LEVELS]
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkImagePyramid.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLMultiBlockDataWriter.h>

#include <cstdlib>
#include <iostream>

int main(int argc, char* argv[])
{
  if (argc < 3 || argc > 4)
  {
    std::cerr << "Usage: BuildPyramid IN.vti OUT.vtm [NUMBER_OF_LEVELS]\n";
    return EXIT_FAILURE;
  }
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(argv[1]);

  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetInputConnection(reader->GetOutputPort());
  pyramid->SetNumberOfLevels(argc > 3 ? std::atoi(argv[3]) : 0);
  pyramid->Update();

  vtkMultiBlockDataSet* levels = pyramid->GetOutput();
  if (pyramid->GetErrorCode() != vtkErrorCode::NoError || levels->GetNumberOfBlocks() == 0)
  {
    return EXIT_FAILURE; // VTK has printed the error
  }
  for (unsigned int h = 0; h < levels->GetNumberOfBlocks(); ++h)
  {
    auto* level = vtkImageData::SafeDownCast(levels->GetBlock(h));
    const int* size = level->GetDimensions();
    std::cout << levels->GetMetaData(h)->Get(vtkCompositeDataSet::NAME()) << ": " << size[0]
              << " x " << size[1] << " x " << size[2] << " voxels, unit "
              << level->GetFieldData()->GetArray("Unit")->GetTuple1(0) << "\n";
  }

  vtkNew<vtkXMLMultiBlockDataWriter> writer;
  writer->SetFileName(argv[2]);
  writer->SetInputData(levels);
  return writer->Write() ? EXIT_SUCCESS : EXIT_FAILURE;
}
