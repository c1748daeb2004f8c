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
/** What has been done to the connectivity since it was last reset. */
struct EditCounts
{
  int Merges = 0;
  int Cuts = 0;
  int Splits = 0;
  int Collapses = 0;
  int Flips = 0;
  int Removed = 0; ///< Components deleted.

  EditCounts operator-(const EditCounts& less) const
  {
    EditCounts counts = less;
    for (int EditCounts::*count : { &EditCounts::Merges, &EditCounts::Cuts, &EditCounts::Splits,
           &EditCounts::Collapses, &EditCounts::Flips, &EditCounts::Removed })
    {
      counts.*count = this->*count - less.*count;
    }
    return counts;
  }
  EditCounts& operator+=(const EditCounts& more)
  {
    this->Merges += more.Merges;
    this->Cuts += more.Cuts;
    this->Splits += more.Splits;
    this->Collapses += more.Collapses;
    this->Flips += more.Flips;
    this->Removed += more.Removed;
    return *this;
  }
};

/**
 * Sum of the cotangents of the two angles opposite to an edge from which on it is flipped. Those of
 * a Delaunay edge add up to 0 or more; a little less, so that no flip is undone by the next.
 */
constexpr float LeastCotangentSum = -0.05f;

/**
 * An edge that is this many times as long as the longest legal one keeps its ends still until it is
 * split, so that what a visit reads and writes is bounded (SurfaceBlocks).
 */
constexpr float HugeEdge = 1.4f;
/**
 * How many times as long as the longest legal edge an edge may be that a merge makes between two
 * rims: between sharp ones they are long. The remesher splits them.
 */
constexpr float LongestBridgeEdge = 1.6f;

/** What a vertex may need of the remesher. */
enum RemeshFlag : std::uint8_t
{
  HasLongEdge = 1,   ///< An edge is longer than eq. (1) allows.
  HasShortEdge = 2,  ///< An edge is shorter than eq. (1) allows.
  IsNotDelaunay = 4, ///< An edge is not locally Delaunay.
  HasHugeEdge = 8    ///< An edge is longer than HugeEdge times the longest legal one.
};

/** What the steps of a visit note about a vertex for each other; no bit is set between visits. */
enum VertexMark : std::uint8_t
{
  IsWorking = 1, ///< SurfaceIteration: it may have moved, or a neighbour has.
  IsListed = 2,  ///< Proximity: it is being examined.
  HasMoved = 4,  ///< Dynamics: it has moved visibly.
  IsMoving = 32, ///< Dynamics: it is about to move.
  IsSeen = 8,    ///< ComponentWatch: it has been looked at.
  IsOfLarge = 16 ///< ComponentWatch: it was looked at, and its component is not small.
};

/**
 * The live surface: mesh, grid of its vertices, and what each of these knows. Its vertex properties
 * are registered once, below, and resized together. Who may change what: the mesh and its grid,
 * SurfaceEditor (Dynamics and the roll back move vertices); a property: who is named above it.
 */
class SurfaceState
{
  VertexProperties Properties; // Must be made before those that register there.

public:
  SurfaceMesh Mesh;
  VertexGrid Grid;
  SizingField Sizing;
  ImageMargin Margin;          ///< Of the level: no vertex is moved further out.
  int EulerCharacteristic = 0; ///< Kept by the edits; tests hold it against a count.
  EditCounts Counts;           ///< Of edits that no visit (EditContext) keeps for itself.

  // Motion: Dynamics. An edit gives a vertex the mean of those that it comes of.
  VertexProperty<Vector> Velocity{ this->Properties, Vector() };
  /** Its place before the last displacement, when the surface was free of intersections. */
  VertexProperty<Vector> PreviousPosition{ this->Properties, Vector() };
  VertexProperty<Vector> Anchor{ this->Properties, Vector() }; ///< Where it last was seen to move.
  VertexProperty<float> FieldValue{ this->Properties, 0.f };   ///< When last evaluated.
  VertexProperty<float> Displacement{ this->Properties, 0.f, 0.f }; ///< Length, in this iteration.

  // Rest: Dynamics, the roll back, and edits, by Activate().
  /** Forces act on it; 0: motionless. */
  VertexProperty<std::uint8_t> Active{ this->Properties, 1, 1 };
  /** Active before the regularisation, or off the isopotential before a revision, or made by them.
   */
  VertexProperty<std::uint8_t> WasActive{ this->Properties, 1, 1 };
  /** Iterations since it has moved visibly. */
  VertexProperty<std::uint8_t> ConvergedIterations{ this->Properties, 0, 0 };
  /** Grows with each roll back, shrinks otherwise. */
  VertexProperty<std::uint8_t> RollbackCount{ this->Properties, 0, 0 };
  /** Edited or rolled back since the regularisation has cleared it. */
  VertexProperty<std::uint8_t> Disturbed{ this->Properties, 0, 1 };

  // Shape: UpdateShape().
  VertexProperty<NormalCone> Normal{ this->Properties, NormalCone() };
  /** Barycentre of the neighbours minus position; as Padding the share of each of them in it. */
  VertexProperty<Vector> Laplacian{ this->Properties, Vector(), Vector() };
  VertexProperty<Vector> SpringPull{ this->Properties, Vector() }; ///< Sum over its edges.
  VertexProperty<float> EdgeLengthSum{ this->Properties, 0.f, 0.f };
  VertexProperty<std::uint8_t> RemeshFlags{ this->Properties, 0, 0 }; ///< Bits of RemeshFlag.

  // Proximity.
  /** How far its star has moved since it was last examined; NeverTested: it must be examined. */
  VertexProperty<float> MotionSinceTest{ this->Properties, NeverTested, NeverTested };
  VertexProperty<float> ClearanceAtTest{ this->Properties, 0.f,
    0.f }; ///< The room it had then: Proximity.
  /** Whether another iteration like the last one would use up little of that room. */
  VertexProperty<std::uint8_t> IsSlow{ this->Properties, 1, 0 };
  /** Something that is not the smooth surface about it lies within reach. */
  VertexProperty<std::uint8_t> NearOthers{ this->Properties, 1 };

  // Grading: GradedSizes. Where an edge is split, or collapsed, its point gets the size there.
  /** delta about it, workspace, where the surface is graded: see SizingField. */
  VertexProperty<float> Size{ this->Properties, 0.f };

  VertexProperty<std::uint8_t> Marks{ this->Properties, 0, 0 }; ///< Bits of VertexMark.

  VertexProperty<int> Component{ this->Properties, Unlabelled }; ///< ComponentWatch.

  static constexpr int Unlabelled = 1 << 30; ///< More than any label of SurfaceComponents.
  static constexpr float NeverTested = 1e6f; ///< More than any slack.

  /** Lets go of all that only iterations need: a reset must come before others. */
  void ForgetMotion();
  /** Resets all properties to those of a mesh that is new, lays the grid over the box. */
  void Reset(const Vector& low, const Vector& high, Executor& executor);
  void Reset(const Vector& low, const Vector& high);

  /**
   * SurfaceMesh::Reorder, with all that is known of the vertices. Values that are only of use while
   * a block is visited are reset: their memory is that of the copies.
   */
  void Reorder(const std::vector<int>& order, VertexSpares& spares, Executor& executor);
  /** Adds a closed surface. Its vertices follow the last ones, as after Reset(), with their shapes.
   */
  void Append(const IndexedSurface& surface, Executor& executor);

  /** After v has been added to the mesh, next to, or as a copy of, its parent. */
  void AddVertex(int v, int parent);
  /** Before v is removed from the mesh. */
  void RemoveVertex(int v);
  void MoveTo(int v, const Vector& position)
  {
    this->Mesh.Position[v] = position;
    this->Grid.Move(v, position);
  }
  /** Something about v has changed: forces act on it again. */
  void Activate(int v)
  {
    this->Active[v] = 1;
    this->ConvergedIterations[v] = 0;
    this->Disturbed[v] = 1;
  }

  /** Normal, cone, internal forces and remesh flags, from the positions as they are. */
  void UpdateShape(const std::vector<int>& vertices, Executor& executor);
  void UpdateShape(int v);

  /** What removing a component has changed. */
  struct RemovedComponent
  {
    int Vertices = 0;
    int EulerCharacteristic = 0;
  };
  /**
   * Deletes the whole component of a vertex; the caller keeps the books.
   * @param room of the visit; null: nothing else is at work
   */
  RemovedComponent TakeComponentAway(int v, VertexRoom* room);
  /** The same where nothing else is at work: counts and chi are kept. @return the vertices removed.
   */
  int RemoveComponent(int v);

  /**
   * False where the normals of the faces about v and w all lie in a common cone, so that none of
   * the faces of one can be what a face of the other meets first. v == w asks about its own star.
   */
  bool AreOpposed(int v, int w) const
  {
    return volumic::AreOpposed(this->Normal[v], this->Normal[w]);
  }
};
}

#endif
