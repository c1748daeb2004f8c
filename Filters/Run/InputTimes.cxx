// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/InputTimes.h"

#include "Host/Pipeline.h"

#include <vtkAlgorithm.h>
#include <vtkAlgorithmOutput.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataObject.h>
#include <vtkSmartPointer.h>

#include <algorithm>

namespace volumic
{
namespace
{
/**
 * Return the data of a connection. Skip the filters that ParaView inserts, which make a new data
 * object in each update.
 */
vtkDataObject* DataOf(vtkAlgorithmOutput* connection)
{
  vtkAlgorithm* producer = connection->GetProducer();
  while (producer->IsA("vtkPVPostFilter") && producer->GetNumberOfInputConnections(0) > 0)
  {
    connection = producer->GetInputConnection(0, 0);
    producer = connection->GetProducer();
  }
  return producer->GetOutputDataObject(connection->GetIndex());
}

/** Return the modification time of data, including blocks. */
vtkMTimeType TimeOf(vtkDataObject* data)
{
  vtkMTimeType time = data->GetMTime();
  if (auto* blocks = vtkCompositeDataSet::SafeDownCast(data))
  {
    auto it = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
    for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem())
    {
      time = std::max(time, it->GetCurrentDataObject()->GetMTime());
    }
  }
  return time;
}
}

InputTimes InputTimesOf(vtkAlgorithm* filter)
{
  InputTimes inputs;
  for (int port = 0; port < filter->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < filter->GetNumberOfInputConnections(port); ++i)
    {
      vtkDataObject* data = DataOf(filter->GetInputConnection(port, i));
      inputs.emplace_back(data, data ? TimeOf(data) : 0);
    }
    inputs.emplace_back(nullptr, port);
  }
  return inputs;
}

bool MayKeepRun(vtkAlgorithm* filter)
{
  bool areReleased = filter->GetReleaseDataFlag() != 0;
  for (int port = 0; port < filter->GetNumberOfInputPorts(); ++port)
  {
    areReleased = areReleased || AreReleased(filter, port);
  }
  return !areReleased;
}
}
