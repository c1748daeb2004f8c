# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# The sources of the core, for the module and for the tests, which see what the library hides.

set(volumic_core_sources
  AxisOperator.cxx
  CellSurface.cxx
  ComponentWatch.cxx
  CycleCut.cxx
  Division.cxx
  Dynamics.cxx
  EdgeAttraction.cxx
  EdgeCollapse.cxx
  EdgeFlip.cxx
  EdgeLengthPlan.cxx
  EdgeSplit.cxx
  EvolutionIteration.cxx
  EvolutionRun.cxx
  EvolutionStart.cxx
  Field.cxx
  GivenSurface.cxx
  InitialSurface.cxx
  LatticeInside.cxx
  LatticeSurface.cxx
  LevelReduction.cxx
  LostBoundary.cxx
  LostParts.cxx
  PointAttraction.cxx
  Proximity.cxx
  PyramidGeometry.cxx
  RemainingContacts.cxx
  Remesher.cxx
  RowKernels.cxx
  SelfIntersections.cxx
  StandardThreads.cxx
  StarMerge.cxx
  SurfaceCheck.cxx
  SurfaceEditor.cxx
  SurfaceEvolution.cxx
  SurfaceFeatures.cxx
  SurfaceMesh.cxx
  SurfacePolish.cxx
  SurfaceState.cxx
  ThickPart.cxx
  TriangleTests.cxx
  TriangleTree.cxx
  ValidReduction.cxx
  VertexGrid.cxx
  VertexRemoval.cxx)
set(volumic_core_headers
  AxisOperator.h
  CellSurface.h
  ComponentWatch.h
  CycleCriterion.h
  CycleCut.h
  Division.h
  Dynamics.h
  EdgeAttraction.h
  EdgeCollapse.h
  EdgeFlip.h
  EdgeLengthPlan.h
  EdgeSplit.h
  EvolutionImplementation.h
  Executor.h
  Field.h
  ImageMargin.h
  InitialSurface.h
  Join.h
  LatticeInside.h
  LatticeSurface.h
  LevelImage.h
  LevelReduction.h
  LostBoundary.h
  LostParts.h
  Monitor.h
  ObliqueRotation.h
  PointAttraction.h
  Proximity.h
  PyramidGeometry.h
  RemainingContacts.h
  Remesher.h
  RestCriterion.h
  Refuse.h
  RowCrossing.h
  RowKernels.h
  SelfIntersections.h
  StandardThreads.h
  StarMerge.h
  SurfaceCheck.h
  SurfaceEditor.h
  SurfaceEvolution.h
  SurfaceFeatures.h
  SurfaceMesh.h
  SurfaceOptions.h
  SurfacePolish.h
  SurfaceState.h
  ThickPart.h
  TriangleTests.h
  TriangleTree.h
  ValidReduction.h
  Vector.h
  VertexGrid.h
  VertexRemoval.h
  VoxelNumbers.h)
list(TRANSFORM volumic_core_sources PREPEND "${CMAKE_CURRENT_LIST_DIR}/")
list(TRANSFORM volumic_core_headers PREPEND "${CMAKE_CURRENT_LIST_DIR}/")

# Results are the same bits on every processor: no product and sum is contracted into one rounding.
set(volumic_core_options)
if (CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  set(volumic_core_options "$<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>")
endif ()
