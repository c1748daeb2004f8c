// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPointHandles_h
#define volumicPointHandles_h

#include <vtkSmartPointer.h>

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

class pqRenderView;
class vtkObject;
class vtkSMNewWidgetRepresentationProxy;
class vtkSMProperty;

/** Handles of points in a view, which the user can drag. */
class PointHandles
{
public:
  using Position = std::array<double, 3>;

  /**
   * @param dragged  called when the user moves a handle, with its index, at every position
   * @param released called at the end of each such move
   */
  PointHandles(std::function<void(std::size_t index, const Position& position)> dragged,
    std::function<void()> released);

  /** There must be none any more: call Place() without positions first. */
  ~PointHandles();

  /** One for each position, of which there are none without a view; those in the view are moved. */
  void Place(pqRenderView* view, const std::vector<Position>& positions);

  void SetVisible(bool visible);

private:
  PointHandles(const PointHandles&) = delete;
  PointHandles& operator=(const PointHandles&) = delete;

  struct Handle
  {
    vtkSmartPointer<vtkSMNewWidgetRepresentationProxy> Proxy;
    unsigned long DragTag = 0;    ///< observer of its position
    unsigned long ReleaseTag = 0; ///< observer of the end of a move

    vtkSMProperty* WorldPosition() const;
  };
  void Add(pqRenderView* view);
  void RemoveLast(pqRenderView* view);
  void OnDrag(vtkObject* position, unsigned long, void*);
  void OnRelease(vtkObject*, unsigned long, void*);

  std::function<void(std::size_t index, const Position& position)> Dragged;
  std::function<void()> Released;
  std::vector<Handle> Handles;
  bool IsPlacing = false; ///< They are moved by us, not by the user.
};

#endif
