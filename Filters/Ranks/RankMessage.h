// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankMessage_h
#define volumicRankMessage_h

#include <vtkDataArray.h>
#include <vtkMultiProcessStream.h>
#include <vtkSmartPointer.h>

#include <array>
#include <vector>

class vtkDataObject;
class vtkFieldData;
class vtkImageData;
class vtkMultiProcessController;
class vtkPolyData;

namespace volumic
{
/**
 * What goes from one rank to another: words and arrays, taken in the order in which they were put.
 * VTK's own way of sending data, by its legacy files, changes types, order and names of arrays.
 */
class RankMessage
{
public:
  /** Numbers and texts. */
  vtkMultiProcessStream Words;

  void Put(vtkDataArray* array);
  vtkSmartPointer<vtkDataArray> TakeArray();

  /** Surfaces, images, tables, and blocks of them; null stays null, and so does anything else. */
  void Put(vtkDataObject* data);
  vtkSmartPointer<vtkDataObject> TakeData();

  /** @throws std::runtime_error where the controller fails. */
  void Send(vtkMultiProcessController* controller, int to, int tag) const;
  void Receive(vtkMultiProcessController* controller, int from, int tag);

private:
  /** All arrays of numbers or texts, and which of them are attributes. */
  void PutArrays(vtkFieldData* arrays);
  void TakeInto(vtkFieldData* arrays);
  void TakeShape(vtkPolyData* surface);
  std::vector<vtkSmartPointer<vtkDataArray>> Arrays;
  std::size_t Taken = 0; ///< of these
};

/** Where a piece of an image is. */
struct Place
{
  std::array<int, 6> Extent = { 0, -1, 0, -1, 0, -1 };
  std::array<double, 3> Origin = { 0, 0, 0 };
  std::array<double, 3> Spacing = { 1, 1, 1 };
  std::array<double, 9> Direction = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
};

/** @param image null, or without points: none */
Place PlaceOf(vtkImageData* image);
void PutPlace(RankMessage& message, const Place& place);
Place TakePlace(RankMessage& message);
}

#endif
