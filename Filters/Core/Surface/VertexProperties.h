// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVertexProperties_h
#define volumicVertexProperties_h

#include "Core/Common/Executor.h"
#include "Core/Common/Grow.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Mesh/SurfaceMesh.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace volumic
{
/** Interface of a vertex property for VertexProperties. */
class VertexPropertyBase
{
public:
  virtual ~VertexPropertyBase() = default;
  /** Assign the initial value to n vertices. */
  virtual void Reset(std::size_t n) = 0;
  /** Resize to indices below n. New values are the initial one. */
  virtual void Resize(std::size_t n) = 0;
  /** Release the memory until the next Reset(). */
  virtual void Release() = 0;
  /** See SurfaceMesh::Reorder. Values of free slots are zero. */
  virtual void Reorder(
    const std::vector<int>& order, ReorderBuffers& buffers, Executor& executor) = 0;
  /** Set the value of a new vertex `v` from that of `parent`, or to that of new vertices. */
  virtual void Add(std::size_t v, std::size_t parent) = 0;
};

/**
 * Registry of the vertex properties of a mesh, which are resized together, as in pmp-library and
 * geometry-central. Each property registers itself.
 */
class VertexProperties
{
public:
  VertexProperties() = default;
  VertexProperties(const VertexProperties&) = delete;
  VertexProperties& operator=(const VertexProperties&) = delete;

  void Register(VertexPropertyBase& property) { this->All.push_back(&property); }
  void Reset(std::size_t n, Executor& executor)
  {
    ForSpans(executor, this->All.size(), 1,
      [&](std::size_t i, std::size_t, std::size_t) { this->All[i]->Reset(n); });
  }
  void Resize(std::size_t n)
  {
    for (VertexPropertyBase* property : this->All)
    {
      property->Resize(n);
    }
  }
  void Reorder(const std::vector<int>& order, ReorderBuffers& buffers, Executor& executor)
  {
    for (VertexPropertyBase* property : this->All)
    {
      property->Reorder(order, buffers, executor);
    }
  }
  void Release()
  {
    for (VertexPropertyBase* property : this->All)
    {
      property->Release();
    }
  }
  /** Thread-safe if the properties have slots for the vertices. */
  void Add(int v, int parent)
  {
    for (VertexPropertyBase* property : this->All)
    {
      property->Add(static_cast<std::size_t>(v), static_cast<std::size_t>(parent));
    }
  }

private:
  std::vector<VertexPropertyBase*> All;
};

/** A value per vertex, indexed like the mesh. */
template <typename T>
class VertexProperty final : public VertexPropertyBase
{
public:
  /** Construct a property that new vertices inherit from their parent. */
  VertexProperty(VertexProperties& properties, T initial) : Initial(initial), Inherits(true)
  {
    properties.Register(*this);
  }
  /** Construct a property with a fixed value for new vertices. */
  VertexProperty(VertexProperties& properties, T initial, T newValue)
    : Initial(initial), NewValue(newValue), Inherits(false)
  {
    properties.Register(*this);
  }
  VertexProperty(const VertexProperty&) = delete;
  VertexProperty& operator=(const VertexProperty&) = delete;

  T& operator[](std::size_t v) { return this->Values[v]; }
  const T& operator[](std::size_t v) const { return this->Values[v]; }
  std::size_t Size() const { return this->Values.size(); }
  void Fill(const T& value) { std::fill(this->Values.begin(), this->Values.end(), value); }
  void Assign(const LargeVector<T>& values) { this->Values = values; } ///< The size must match.
  LargeVector<T>& AsVector() { return this->Values; }                  ///< Must not be resized.
  const LargeVector<T>& AsVector() const { return this->Values; }

  void Reset(std::size_t n) override
  {
    MakeRoom(this->Values, n);
    this->Values.assign(n, this->Initial);
  }
  void Resize(std::size_t n) override { Grow(this->Values, n, this->Initial); }
  void Release() override { this->Values = {}; }
  void Reorder(const std::vector<int>& order, ReorderBuffers& buffers, Executor& executor) override
  {
    if (!this->Values.empty())
    {
      volumic::Reorder(this->Values, order, buffers, executor);
    }
  }
  void Add(std::size_t v, std::size_t parent) override
  {
    if (v >= this->Values.size())
    {
      this->Resize(v + 1);
    }
    this->Values[v] = this->Inherits ? this->Values[parent] : this->NewValue;
  }

private:
  T Initial;
  T NewValue{};
  bool Inherits;
  LargeVector<T> Values;
};
}

#endif
