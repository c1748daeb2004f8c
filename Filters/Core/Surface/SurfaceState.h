// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceState_h
#define volumicSurfaceState_h

#include "Core/Common/Executor.h"
#include "Core/Image/ImageMargin.h"
#include "Core/Mesh/SurfaceMesh.h"
#include "Core/Mesh/VertexGrid.h"
#include "Core/Surface/NormalCone.h"
#include "Core/Surface/SizingField.h"
#include "Core/Surface/VertexProperties.h"

#include <cstdint>
#include <vector>

namespace volumic
{
/** Counters of edits since the last reset. */
struct EditCounts
{
  int Merges = 0;
  int Cuts = 0;
  int Splits = 0;
  int Collapses = 0;
  int Flips = 0;
  int Removed = 0; ///< Deleted components.

  EditCounts& Add(const EditCounts& more, int factor = 1)
  {
    for (int EditCounts::*count : { &EditCounts::Merges, &EditCounts::Cuts, &EditCounts::Splits,
           &EditCounts::Collapses, &EditCounts::Flips, &EditCounts::Removed })
    {
      this->*count += factor * more.*count;
    }
    return *this;
  }
  EditCounts operator-(const EditCounts& less) const { return EditCounts(*this).Add(less, -1); }
  EditCounts& operator+=(const EditCounts& more) { return this->Add(more); }
};

/**
 * An edge is flipped if the sum of the cotangents of its two opposite angles is less. The sum is at
 * least 0 for a Delaunay edge. The tolerance prevents the next pass from undoing a flip.
 */
constexpr float LeastCotangentSum = -0.05f;

/**
 * The ends of an edge this many times as long as the longest legal one do not move until it is
 * split. This bounds what a block pass reads and writes (SurfaceBlocks).
 */
constexpr float HugeEdge = 1.4f;
/**
 * Longest bridge edge of a merge, in longest legal edges. Between sharp links bridge edges are
 * long. The remesher splits them.
 */
constexpr float LongestBridgeEdge = 1.6f;

/** Reasons to remesh at a vertex. */
enum RemeshFlag : std::uint8_t
{
  HasLongEdge = 1,   ///< An edge is longer than eq. (1) allows.
  HasShortEdge = 2,  ///< An edge is shorter than eq. (1) allows.
  IsNotDelaunay = 4, ///< An edge is not locally Delaunay.
  HasHugeEdge = 8    ///< An edge is longer than HugeEdge times the longest legal one.
};

/** Temporary marks that the steps of a block pass share. All bits are 0 between passes. */
enum VertexMark : std::uint8_t
{
  IsWorking = 1, ///< SurfaceIteration: it, or a neighbour, may have moved.
  IsListed = 2,  ///< Proximity: it is being tested.
  HasMoved = 4,  ///< Dynamics: it has moved visibly.
  IsMoving = 32, ///< Dynamics: it is about to move.
  IsSeen = 8,    ///< ComponentWatch: it has been tested.
  IsOfLarge = 16 ///< ComponentWatch: its component is not small.
};

/**
 * Live surface: mesh, grid of its vertices, and vertex properties, which are registered below and
 * resized together. SurfaceEditor changes mesh and grid; Dynamics and the rollback also move
 * vertices. The comment above a group of properties names the classes that change it.
 */
class SurfaceState
{
  VertexProperties Properties; // Must be constructed before the properties.

public:
  SurfaceMesh Mesh;
  VertexGrid Grid;
  SizingField Sizing;
  ImageMargin Margin;          ///< Of the level: no vertex moves further out.
  int EulerCharacteristic = 0; ///< Maintained by the edits.
  EditCounts Counts;           ///< Edits outside block passes, see EditContext.

  // Motion: Dynamics. An edit assigns the mean of the old vertices.
  VertexProperty<Vector> Velocity{ this->Properties, Vector() };
  /** Position before the last displacement, free of intersections. */
  VertexProperty<Vector> PreviousPosition{ this->Properties, Vector() };
  VertexProperty<Vector> Anchor{ this->Properties, Vector() };      ///< At its last visible motion.
  VertexProperty<float> FieldValue{ this->Properties, 0.f };        ///< When last evaluated.
  VertexProperty<float> Displacement{ this->Properties, 0.f, 0.f }; ///< Length, in this iteration.

  // Convergence: Dynamics, the rollback, and edits by Activate().
  /** 1: forces act on it; 0: converged. */
  VertexProperty<std::uint8_t> Active{ this->Properties, 1, 1 };
  /** Active before the regularisation, or off the isosurface before a refit, or made by them. */
  VertexProperty<std::uint8_t> WasActive{ this->Properties, 1, 1 };
  /** Iterations since its last visible motion. */
  VertexProperty<std::uint8_t> ConvergedIterations{ this->Properties, 0, 0 };
  /** Increases with each rollback, decreases otherwise. */
  VertexProperty<std::uint8_t> RollbackCount{ this->Properties, 0, 0 };
  /** Edited or rolled back since the start of the regularisation. */
  VertexProperty<std::uint8_t> Disturbed{ this->Properties, 0, 1 };

  // Shape: UpdateShape().
  VertexProperty<NormalCone> Normal{ this->Properties, NormalCone() };
  /** Barycentre of the neighbours minus position. Padding holds the weight of each neighbour. */
  VertexProperty<Vector> Laplacian{ this->Properties, Vector(), Vector() };
  VertexProperty<Vector> SpringPull{ this->Properties, Vector() }; ///< Sum over its edges.
  VertexProperty<float> EdgeLengthSum{ this->Properties, 0.f, 0.f };
  VertexProperty<std::uint8_t> RemeshFlags{ this->Properties, 0, 0 }; ///< Bits of RemeshFlag.

  // Proximity.
  /** Motion of its star since its last test; NeverTested: must be tested. */
  VertexProperty<float> MotionSinceTest{ this->Properties, NeverTested, NeverTested };
  VertexProperty<float> ClearanceAtTest{ this->Properties, 0.f, 0.f };
  /** Whether an iteration like the last one would use up little of the clearance. */
  VertexProperty<std::uint8_t> IsSlow{ this->Properties, 1, 0 };
  /** A part of the surface with opposed normals lies within the search radius. */
  VertexProperty<std::uint8_t> NearOthers{ this->Properties, 1 };

  // Grading: GradedSizes. A split or a collapse interpolates it.
  /** delta of a graded surface, in the computational space, see SizingField. */
  VertexProperty<float> Size{ this->Properties, 0.f };

  VertexProperty<std::uint8_t> Marks{ this->Properties, 0, 0 }; ///< Bits of VertexMark.

  VertexProperty<int> Component{ this->Properties, Unlabelled }; ///< ComponentWatch.

  static constexpr int Unlabelled = 1 << 30; ///< Greater than any label of SurfaceComponents.
  static constexpr float NeverTested = 1e6f; ///< Greater than any clearance.

  /** Release what only iterations need. Call Reset() before the next iterations. */
  void ReleaseMotion();
  /** Reset all properties to those of a new mesh and cover the box with the grid. */
  void Reset(const Vector& low, const Vector& high, Executor& executor);
  void Reset(const Vector& low, const Vector& high);

  /**
   * Reorder the mesh, see SurfaceMesh::Reorder, and all vertex properties. Properties used only
   * within a block pass are reset: their memory serves as buffers.
   */
  void Reorder(const std::vector<int>& order, ReorderBuffers& buffers, Executor& executor);
  /** Append a closed surface, with properties as after Reset(), and compute its shapes. */
  void Append(const IndexedSurface& surface, Executor& executor);

  /** Call it after v has been added to the mesh next to, or as a copy of, its parent. */
  void AddVertex(int v, int parent);
  /** Call it before v is removed from the mesh. */
  void RemoveVertex(int v);
  void MoveTo(int v, const Vector& position)
  {
    this->Mesh.Position[v] = position;
    this->Grid.Move(v, position);
  }
  /** Call it after a change at v: forces act on it again. */
  void Activate(int v)
  {
    this->Active[v] = 1;
    this->ConvergedIterations[v] = 0;
    this->Disturbed[v] = 1;
  }

  /** Compute normal, cone, internal forces and remesh flags from the positions. */
  void UpdateShape(const std::vector<int>& vertices, Executor& executor);
  void UpdateShape(int v);

  /** Changes made by the removal of a component. */
  struct RemovedComponent
  {
    int Vertices = 0;
    int EulerCharacteristic = 0;
  };
  /**
   * Delete the component of a vertex. The caller updates the counters.
   * @param slots of the block pass; null: no other thread edits
   */
  RemovedComponent EraseComponent(int v, VertexSlots* slots);
  /** Delete the component of a vertex and update the counters. Return the number of vertices. */
  int RemoveComponent(int v);

  /**
   * Return false if the normals of all faces at v and w lie in a common cone: no face of one can
   * then be the first that a face of the other meets. v == w tests one star.
   */
  bool AreOpposed(int v, int w) const
  {
    return volumic::AreOpposed(this->Normal[v], this->Normal[w]);
  }
};
}

#endif
