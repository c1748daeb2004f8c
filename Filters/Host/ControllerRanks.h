// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicControllerRanks_h
#define volumicControllerRanks_h

#include "Core/Common/Communicator.h"

#include <vtkMultiProcessController.h>
#include <vtkSmartPointer.h>

#include <cstddef>
#include <memory>

class vtkInformation;
class vtkInformationVector;

namespace volumic
{
/**
 * The processes of a controller of VTK. Messages go point to point, with a tag of their own: others
 * may use the controller as well, as long as they do so between two calls of a filter.
 */
class ControllerRanks final : public Communicator
{
public:
  /** @param controller of this process and the others; of one process where it is null */
  explicit ControllerRanks(vtkMultiProcessController* controller);
  ~ControllerRanks() override;
  int Rank() const override;
  int NumberOfRanks() const override;

protected:
  /** These throw std::runtime_error where the controller fails. */
  void Send(int to, const void* bytes, std::size_t count) override;
  void Receive(int from, void* bytes, std::size_t count) override;
  void ReceiveFromAny(void* bytes, std::size_t count) override;

private:
  vtkSmartPointer<vtkMultiProcessController> Controller;
};

/**
 * The ranks that make the output of a filter together: those of its controller where each asks for
 * the piece of its own number, of as many pieces as there are ranks, as ParaView has them do. Else
 * one rank alone: who asks for a piece gets it as from a program without MPI.
 * @param request, output as RequestUpdateExtent and RequestData have them
 */
std::unique_ptr<Communicator> RanksOf(
  vtkMultiProcessController* controller, vtkInformation* request, vtkInformationVector* output);
}

#endif
