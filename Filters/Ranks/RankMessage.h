// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankMessage_h
#define volumicRankMessage_h

#include <vtkSmartPointer.h>

#include <cstddef>
#include <type_traits>
#include <vector>

class vtkDataObject;
class vtkMultiProcessController;

namespace volumic
{
/**
 * What goes from one rank to another, taken in the order in which it was put. All ranks are the
 * same program on the same kind of machine. VTK's own way of sending data, by its legacy files,
 * changes types, order and names of arrays.
 */
class RankMessage
{
public:
  /** Numbers, structs of numbers, texts, and vectors of all these: put, or, once received, taken.
   */
  template <typename T>
  RankMessage& operator&(T& value)
  {
    static_assert(!std::is_pointer_v<T>);
    if constexpr (std::is_trivially_copyable_v<T>)
    {
      this->Pass(&value, sizeof(T));
    }
    else
    {
      std::size_t size = value.size();
      *this& size;
      value.resize(size);
      for (auto& each : value)
      {
        *this& each;
      }
    }
    return *this;
  }
  template <typename T>
  RankMessage& operator<<(T value)
  {
    return *this & value;
  }
  template <typename T>
  RankMessage& operator>>(T& value)
  {
    return *this & value;
  }
  /** @throws std::runtime_error where a message has less. */
  void Pass(void* bytes, std::size_t count);

  /** Surfaces, images, tables, and blocks of them; null stays null, and so does anything else. */
  void Put(vtkDataObject* data);
  vtkSmartPointer<vtkDataObject> TakeData();

  bool IsReceived() const { return this->WasReceived; }

  /**
   * @param word what sort of message it is
   * @throws std::runtime_error where the controller fails.
   */
  void Send(vtkMultiProcessController* controller, int to, int word) const;
  /** @return the word */
  int Receive(vtkMultiProcessController* controller, int from);

private:
  std::vector<char> Bytes;
  bool WasReceived = false;
  std::size_t Taken = 0; ///< of the bytes
};
}

#endif
