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
/** Whether something has failed on any rank. */
bool HasFailed(bool isHere, vtkMPIController* ranks)
{
  const int here = isHere ? 1 : 0;
  int any = here;
  ranks->AllReduce(&here, &any, 1, vtkCommunicator::MAX_OP);
  return any != 0;
}

/** Called by all ranks. @return the status of the program, the same on all of them */
int Run(const char* volume, const char* output, double iso, vtkMPIController* ranks)
{
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(volume);
  // A rank whose reader fails does not get to the filter, in which the others would wait for it.
  if (HasFailed(!reader->CanReadFile(volume), ranks))
  {
    std::cerr << "rank " << ranks->GetLocalProcessId() << ": cannot read " << volume << "\n";
    return EXIT_FAILURE;
  }

  // The filter takes the global controller; all ranks ask for the piece of their number.
  vtkNew<vtkVolumeToSurface> surface;
  surface->SetInputConnection(reader->GetOutputPort());
  surface->SetIsoValue(iso);
  surface->UpdatePiece(ranks->GetLocalProcessId(), ranks->GetNumberOfProcesses(), 0);

  // What fails in the filter on one rank is an error of it on all ranks.
  if (HasFailed(surface->GetErrorCode() != vtkErrorCode::NoError, ranks))
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
