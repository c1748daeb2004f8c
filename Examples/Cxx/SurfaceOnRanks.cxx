// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// One surface by many processes, each of which reads a part of the image and has a part of the
// surface:
//   mpirun -n 4 SurfaceOnRanks IN.vti OUT.pvtp ISO
#include <vtkErrorCode.h>
#include <vtkMPIController.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkVolumeToSurface.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPPolyDataWriter.h>

#include <cstdlib>
#include <iostream>

namespace
{
/** Called by all ranks. @return the status of the program, the same on all of them */
int Run(const char* volume, const char* output, double iso, vtkMPIController* ranks)
{
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(volume);

  // The filter takes the global controller; all ranks ask for the piece of their number.
  vtkNew<vtkVolumeToSurface> surface;
  surface->SetInputConnection(reader->GetOutputPort());
  surface->SetIsoValue(iso);
  surface->UpdatePiece(ranks->GetLocalProcessId(), ranks->GetNumberOfProcesses(), 0);

  // An error of one rank is that of all; here it makes sure of readers', too.
  const int failed = surface->GetErrorCode() != vtkErrorCode::NoError ||
    reader->GetErrorCode() != vtkErrorCode::NoError;
  int anyFailed = failed;
  ranks->AllReduce(&failed, &anyFailed, 1, vtkCommunicator::MAX_OP);
  if (anyFailed)
  {
    return EXIT_FAILURE; // the reason was printed by VTK
  }
  std::cout << "rank " << ranks->GetLocalProcessId() << ": "
            << surface->GetOutput()->GetNumberOfPolys() << " triangles\n";

  vtkNew<vtkXMLPPolyDataWriter> writer;
  writer->SetController(ranks);
  writer->SetInputConnection(surface->GetOutputPort());
  writer->SetFileName(output);
  writer->SetNumberOfPieces(ranks->GetNumberOfProcesses());
  writer->SetStartPiece(ranks->GetLocalProcessId());
  writer->SetEndPiece(ranks->GetLocalProcessId());
  return writer->Write() ? EXIT_SUCCESS : EXIT_FAILURE;
}
}

int main(int argc, char* argv[])
{
  vtkNew<vtkMPIController> ranks;
  ranks->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(ranks);
  int status = EXIT_FAILURE;
  if (argc == 4)
  {
    status = Run(argv[1], argv[2], std::atof(argv[3]), ranks);
  }
  else if (ranks->GetLocalProcessId() == 0)
  {
    std::cerr << "Usage: mpirun -n N SurfaceOnRanks IN.vti OUT.pvtp ISO\n";
  }
  vtkMultiProcessController::SetGlobalController(nullptr);
  ranks->Finalize();
  return status;
}
