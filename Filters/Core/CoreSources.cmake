# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# The sources of the core, for the module and for the tests, which see what the library hides.
# Room by room, from the ground up: a room includes only itself and those before it
# (Documentation/architecture.md).

set(volumic_core_sources
  Common/StandardThreads.cxx
  Image/AxisOperator.cxx
  Image/EdgeAttraction.cxx
  Image/Field.cxx
  Image/LevelReduction.cxx
  Image/PointAttraction.cxx
  Image/PyramidGeometry.cxx
  Image/RowKernels.cxx
  Image/ValidReduction.cxx
  Mesh/CellSurface.cxx
  Mesh/CycleCut.cxx
  Mesh/Division.cxx
  Mesh/EdgeCollapse.cxx
  Mesh/EdgeFlip.cxx
  Mesh/EdgeSplit.cxx
  Mesh/LatticeInside.cxx
  Mesh/LatticeSurface.cxx
  Mesh/SelfIntersections.cxx
  Mesh/StarMerge.cxx
  Mesh/SurfaceCheck.cxx
  Mesh/SurfaceFeatures.cxx
  Mesh/SurfaceMeasures.cxx
  Mesh/SurfaceMesh.cxx
  Mesh/TriangleTests.cxx
  Mesh/TriangleTree.cxx
  Mesh/VertexGrid.cxx
  Mesh/VertexRemoval.cxx
  Surface/ComponentWatch.cxx
  Surface/NewFaces.cxx
  Surface/Proximity.cxx
  Surface/RemainingContacts.cxx
  Surface/Remesher.cxx
  Surface/StarScore.cxx
  Surface/SurfaceEditor.cxx
  Surface/SurfacePolish.cxx
  Surface/SurfaceState.cxx
  Surface/TopologyEdits.cxx
  Evolution/Dynamics.cxx
  Evolution/EdgeLengthPlan.cxx
  Evolution/EvolutionHistory.cxx
  Evolution/EvolutionRun.cxx
  Evolution/EvolutionStart.cxx
  Evolution/GivenSurface.cxx
  Evolution/InitialSurface.cxx
  Evolution/LostBoundary.cxx
  Evolution/LostParts.cxx
  Evolution/SurfaceEvolution.cxx
  Evolution/SurfaceIteration.cxx)
set(volumic_core_headers
  Common/Box.h
  Common/DisjointSets.h
  Common/Executor.h
  Common/IndexedSurface.h
  Common/Join.h
  Common/LatticeKey.h
  Common/Monitor.h
  Common/Refuse.h
  Common/StandardThreads.h
  Common/Vector.h
  Image/AxisOperator.h
  Image/EdgeAttraction.h
  Image/Field.h
  Image/FieldOptions.h
  Image/ImageMargin.h
  Image/LevelImage.h
  Image/LevelReduction.h
  Image/PointAttraction.h
  Image/PyramidGeometry.h
  Image/RowKernels.h
  Image/ThickPart.h
  Image/ValidReduction.h
  Image/VoxelNumbers.h
  Image/VoxelParts.h
  Image/VoxelRows.h
  Image/VoxelValues.h
  Mesh/CellSurface.h
  Mesh/CycleCut.h
  Mesh/Division.h
  Mesh/EdgeCollapse.h
  Mesh/EdgeFlip.h
  Mesh/EdgeSplit.h
  Mesh/LatticeInside.h
  Mesh/LatticeSurface.h
  Mesh/ObliqueRotation.h
  Mesh/RowCrossing.h
  Mesh/SelfIntersections.h
  Mesh/StarMerge.h
  Mesh/SurfaceCheck.h
  Mesh/SurfaceFeatures.h
  Mesh/SurfaceMeasures.h
  Mesh/SurfaceMesh.h
  Mesh/TriangleTests.h
  Mesh/TriangleTree.h
  Mesh/VertexGrid.h
  Mesh/VertexRemoval.h
  Surface/ComponentWatch.h
  Surface/FaceShape.h
  Surface/NewFaces.h
  Surface/NormalCone.h
  Surface/Proximity.h
  Surface/RemainingContacts.h
  Surface/Remesher.h
  Surface/SizingField.h
  Surface/StarScore.h
  Surface/SurfaceEditor.h
  Surface/SurfacePolish.h
  Surface/SurfaceState.h
  Surface/VertexProperties.h
  Evolution/CycleCriterion.h
  Evolution/Dynamics.h
  Evolution/EdgeLengthPlan.h
  Evolution/EvolutionImplementation.h
  Evolution/InitialSurface.h
  Evolution/LostBoundary.h
  Evolution/LostParts.h
  Evolution/RestCriterion.h
  Evolution/SurfaceEvolution.h
  Evolution/SurfaceIteration.h
  Evolution/SurfaceOptions.h)
list(TRANSFORM volumic_core_sources PREPEND "${CMAKE_CURRENT_LIST_DIR}/")
list(TRANSFORM volumic_core_headers PREPEND "${CMAKE_CURRENT_LIST_DIR}/")

# Results are the same bits on every processor: no product and sum is contracted into one rounding.
set(volumic_core_options)
if (CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  set(volumic_core_options "$<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>")
endif ()
