// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicThreadControllers_h
#define volumicThreadControllers_h

#include "MessageQueues.h"

#include <vtkAlgorithm.h>
#include <vtkCommunicator.h>
#include <vtkDataArray.h>
#include <vtkDummyController.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>

#include <thread>

namespace volumic
{
/** Threads of the test in the place of processes, each with a controller of VTK. */
class ThreadControllers
{
public:
  /** Calls work on each of so many threads; it must not throw. Each makes filters of its own. */
  static void Run(int count, const std::function<void(vtkMultiProcessController*)>& work)
  {
    vtkObjectFactory::GetRegisteredFactories(); // Made once, not by many at a time.
    const auto queues = std::make_shared<MessageQueues>(count);
    std::vector<std::thread> threads;
    for (int rank = 0; rank < count; ++rank)
    {
      threads.emplace_back(
        [&, rank]
        {
          const auto communicator = vtkSmartPointer<Communicator>::Take(Communicator::New());
          communicator->Begin(queues, rank);
          vtkNew<vtkDummyController> controller;
          controller->SetCommunicator(communicator);
          controller->SetRMICommunicator(communicator);
          work(controller);
        });
    }
    for (std::thread& thread : threads)
    {
      thread.join();
    }
  }

  /** As ParaView's processes do it: each asks for its piece. */
  static void Update(
    vtkAlgorithm* filter, vtkMultiProcessController* controller, int ghostLevels = 0)
  {
    filter->UpdatePiece(
      controller->GetLocalProcessId(), controller->GetNumberOfProcesses(), ghostLevels);
  }

private:
  class Communicator : public vtkCommunicator
  {
  public:
    static Communicator* New()
    {
      auto* communicator = new Communicator;
      communicator->InitializeObjectBase();
      return communicator;
    }

    void Begin(std::shared_ptr<MessageQueues> queues, int rank)
    {
      this->All = std::move(queues);
      this->SetNumberOfProcesses(this->All->NumberOfRanks());
      this->LocalProcessId = rank;
    }

    int SendVoidArray(const void* values, vtkIdType count, int type, int to, int) override
    {
      this->All->Send(this->LocalProcessId, to, values, BytesOf(count, type));
      return 1;
    }
    int ReceiveVoidArray(void* values, vtkIdType count, int type, int from, int) override
    {
      this->All->Receive(from, this->LocalProcessId, values, BytesOf(count, type));
      return 1;
    }

  private:
    static std::size_t BytesOf(vtkIdType count, int type)
    {
      return static_cast<std::size_t>(count) *
        static_cast<std::size_t>(vtkDataArray::GetDataTypeSize(type));
    }

    std::shared_ptr<MessageQueues> All;
  };
};
}

#endif
