// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLargeArray_h
#define volumicLargeArray_h

#include "Core/Common/ScratchMemory.h"

#include <vtkAbstractArray.h>
#include <vtkDataArray.h>
#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <cstddef>

namespace volumic
{
/**
 * An array of VTK's (vtkFloatArray, ...) that lives in scratch memory where a limit is set and it
 * is large. Its values are not set. @throws std::bad_alloc, ScratchFull.
 */
template <typename Array>
vtkSmartPointer<Array> NewLargeArray(std::size_t tuples, int components = 1)
{
  using Value = typename Array::ValueType;
  const std::size_t n = tuples * static_cast<std::size_t>(components);
  auto array = vtkSmartPointer<Array>::New();
  array->SetNumberOfComponents(components);
  array->SetArray(static_cast<Value*>(AllocateLarge(n * sizeof(Value))),
    static_cast<vtkIdType>(n), 0, vtkAbstractArray::VTK_DATA_ARRAY_USER_DEFINED);
  array->SetArrayFreeFunction([](void* values) { FreeLarge(values); });
  return array;
}

/** The same of the type, the name and the components of another one. */
inline vtkSmartPointer<vtkDataArray> NewLargeArrayLike(vtkDataArray* like, vtkIdType tuples)
{
  vtkSmartPointer<vtkDataArray> array;
  array.TakeReference(vtkDataArray::CreateDataArray(like->GetDataType()));
  array->SetName(like->GetName());
  array->SetNumberOfComponents(like->GetNumberOfComponents());
  const vtkIdType values = tuples * like->GetNumberOfComponents();
  const auto width = static_cast<std::size_t>(array->GetDataTypeSize());
  void* memory = AllocateLarge(static_cast<std::size_t>(values) * width);
  array->SetVoidArray(memory, values, 0, vtkAbstractArray::VTK_DATA_ARRAY_USER_DEFINED);
  array->SetArrayFreeFunction([](void* given) { FreeLarge(given); });
  return array;
}
}

#endif
