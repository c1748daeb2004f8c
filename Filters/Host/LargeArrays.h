// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLargeArrays_h
#define volumicLargeArrays_h

#include "Core/Common/ScratchMemory.h"

#include <vtkAbstractArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <cstddef>
#include <cstring>

/** The warning of the filters' deprecated property MemoryLimit. */
#define VOLUMIC_MEMORY_LIMIT_WARNING                                                        \
  "Set ScratchDirectory to a folder on a disk, and limit the memory of the process by its " \
  "cgroup, "                                                                                \
  "as with `systemd-run --user --scope -p MemoryMax=2G`."

namespace volumic
{
/**
 * Return a VTK array with uninitialized values, which AllocateLarge() has allocated.
 * @throws std::bad_alloc, ScratchFull
 */
template <typename Array>
vtkSmartPointer<Array> NewLargeArray(std::size_t tuples, int components = 1)
{
  using Value = typename Array::ValueType;
  const std::size_t n = tuples * static_cast<std::size_t>(components);
  // The header holds the number of bytes, as the free function receives the address only.
  constexpr std::size_t header = 64;
  const std::size_t bytes = header + n * sizeof(Value);
  char* memory = static_cast<char*>(AllocateLarge(bytes));
  std::memcpy(memory, &bytes, sizeof bytes);
  auto array = vtkSmartPointer<Array>::New();
  array->SetNumberOfComponents(components);
  array->SetArray(reinterpret_cast<Value*>(memory + header), static_cast<vtkIdType>(n), 0,
    vtkAbstractArray::VTK_DATA_ARRAY_USER_DEFINED);
  array->SetArrayFreeFunction(
    [](void* values)
    {
      char* begin = static_cast<char*>(values) - header;
      std::size_t allocated = 0;
      std::memcpy(&allocated, begin, sizeof allocated);
      FreeLarge(begin, allocated);
    });
  return array;
}

/** Add an array with one value to field data. */
template <typename Array, typename Value>
void AddField(vtkFieldData* fieldData, const char* name, Value value)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->InsertNextValue(value);
  fieldData->AddArray(array);
}
}

#endif
