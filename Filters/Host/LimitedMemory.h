// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLimitedMemory_h
#define volumicLimitedMemory_h

#include "Core/Common/ScratchMemory.h"

#include <vtkAbstractArray.h>
#include <vtkDataArray.h>
#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace volumic
{
/**
 * The scratch memory of a filter with the properties Memory Limit and Scratch Directory. The filter
 * has one, from its first run with a limit to its end: what it made is in it that long.
 */
class LimitedMemory
{
public:
  LimitedMemory();
  ~LimitedMemory();

  /**
   * For the run that begins. What was made under another limit stays where it is.
   * @param mebibytes 0: no limit
   * @throws std::invalid_argument naming the property where the limit is none, or the directory
   *         cannot be used; then there is no limit.
   */
  void Set(int mebibytes, const std::string& directory);

  /** Bytes; 0: there is none. */
  std::size_t Limit() const { return this->Options.Limit; }

  /** What ScratchMemory warns of, each as long as it is new, for the end of a run. */
  std::vector<std::string> TakeWarnings();

  /** The property's mebibytes in bytes; 0 where it is no limit. */
  static std::size_t BytesOf(int mebibytes)
  {
    return static_cast<std::size_t>(mebibytes > 0 ? mebibytes : 0) << 20;
  }

private:
  ScratchOptions Options;
  std::unique_ptr<ScratchMemory> Scratch; ///< null where there is no limit
  std::vector<std::string> Told;          ///< the warnings that were taken
};

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
  array->SetArray(static_cast<Value*>(AllocateLarge(n * sizeof(Value))), static_cast<vtkIdType>(n),
    0, vtkAbstractArray::VTK_DATA_ARRAY_USER_DEFINED);
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
