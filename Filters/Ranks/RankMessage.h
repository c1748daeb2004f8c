// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankMessage_h
#define volumicRankMessage_h

#include <vtkDataArray.h>
#include <vtkMultiProcessStream.h>
#include <vtkSmartPointer.h>

#include <array>
#include <vector>

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

  /** All arrays of numbers or texts, and which of them are attributes. */
  void Put(vtkFieldData* arrays);
  void TakeInto(vtkFieldData* arrays);

  /** Null stays null. */
  void Put(vtkPolyData* surface);
  vtkSmartPointer<vtkPolyData> TakeSurface();
  void Put(vtkImageData* image);
  vtkSmartPointer<vtkImageData> TakeImage();

  /** @throws std::runtime_error where the controller fails. */
  void Send(vtkMultiProcessController* controller, int to, int tag) const;
  void Receive(vtkMultiProcessController* controller, int from, int tag);

private:
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
