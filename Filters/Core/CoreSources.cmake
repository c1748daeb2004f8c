# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Sources of the core, for the module and for the tests, which use private symbols. The order is that of
# the rooms in Documentation/architecture.md.

set(volumic_core_sources
  Common/Executor.cxx
  Common/FreeMemory.cxx
  Common/ScratchMemory.cxx
  Common/BlockSchedule.cxx
  Image/AxisOperator.cxx
  Image/EdgeAttraction.cxx
  Image/Field.cxx
  Image/LevelReduction.cxx
  Image/PointAttraction.cxx
  Image/PyramidGeometry.cxx
  Image/RowKernels.cxx
  Image/ValidReduction.cxx
  Labels/BoundaryGaussian.cxx
  Labels/VoxelBits.cxx
  Labels/LabelBricks.cxx
  Labels/LabelDistance.cxx
  Labels/LabelField.cxx
  Labels/LabelConstraints.cxx
  Labels/LabelMap.cxx
  Labels/LabelSides.cxx
  Labels/LabelMapPadding.cxx
  Labels/SmallParts.cxx
  Mesh/CycleCut.cxx
  Mesh/Division.cxx
  Mesh/EdgeCollapse.cxx
  Mesh/EdgeFlip.cxx
  Mesh/EdgeSplit.cxx
  Mesh/LegalEdges.cxx
  Mesh/RowCrossing.cxx
  Mesh/SelfIntersections.cxx
  Mesh/StarMerge.cxx
  Mesh/SurfaceCheck.cxx
  Mesh/SurfaceFeatures.cxx
  Mesh/SurfaceMeasures.cxx
  Mesh/SurfaceMesh.cxx
  Mesh/SurfaceMeshAppend.cxx
  Mesh/TriangleDistance.cxx
  Mesh/TriangleTests.cxx
  Mesh/TriangleTree.cxx
  Mesh/VertexGrid.cxx
  Mesh/VertexRemoval.cxx
  Interfaces/CellPattern.cxx
  Interfaces/DistanceLattice.cxx
  Interfaces/DualCells.cxx
  Interfaces/DualMesh.cxx
  Interfaces/InterfaceClearance.cxx
  Interfaces/InterfaceFields.cxx
  Interfaces/InterfaceFit.cxx
  Interfaces/InterfaceMesh.cxx
  Interfaces/InterfaceMotion.cxx
  Interfaces/InterfaceCrossings.cxx
  Interfaces/InterfaceEdits.cxx
  Interfaces/InterfaceRemesher.cxx
  Interfaces/InterfaceSizes.cxx
  Interfaces/InterfaceStart.cxx
  Interfaces/JunctionWedges.cxx
  Interfaces/MakeInterfaces.cxx
  Interfaces/MismatchedVoxels.cxx
  Interfaces/NearDegenerateRegions.cxx
  Interfaces/PeriodicImages.cxx
  Interfaces/VertexTargets.cxx
  Surface/ComponentWatch.cxx
  Surface/NewFaces.cxx
  Surface/Proximity.cxx
  Surface/RemainingContacts.cxx
  Surface/Remesher.cxx
  Surface/RemesherMerges.cxx
  Surface/StarImprovement.cxx
  Surface/StarFaces.cxx
  Surface/StarIntersections.cxx
  Surface/StarScore.cxx
  Surface/StarShape.cxx
  Surface/SurfaceBlocks.cxx
  Surface/SurfaceComponents.cxx
  Surface/SurfaceEditor.cxx
  Surface/SurfaceOptimization.cxx
  Surface/SurfaceState.cxx
  Surface/TopologyEdits.cxx
  Evolution/Dynamics.cxx
  Evolution/EdgeLengthPlan.cxx
  Evolution/EvolutionDivision.cxx
  Evolution/EvolutionGrading.cxx
  Evolution/EvolutionHistory.cxx
  Evolution/EvolutionRun.cxx
  Evolution/EvolutionStart.cxx
  Evolution/EvolutionPasses.cxx
  Evolution/InitialSurfaceCheck.cxx
  Evolution/GradedSizes.cxx
  Evolution/InitialSurface.cxx
  Evolution/LatticeSurface.cxx
  Evolution/MissedBoundary.cxx
  Evolution/MissedParts.cxx
  Evolution/MissedVoxels.cxx
  Evolution/SlabSearch.cxx
  Evolution/SurfaceEvolution.cxx
  Evolution/SurfaceIteration.cxx
  Evolution/SurfaceResult.cxx)
list(TRANSFORM volumic_core_sources PREPEND "${CMAKE_CURRENT_LIST_DIR}/")

# Results are bit-identical on all processors, because no product and sum are contracted. Without errno,
# a square root is one instruction.
set(volumic_core_options)
if (CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  set(volumic_core_options "$<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>"
    "$<$<COMPILE_LANGUAGE:CXX>:-fno-math-errno>")
endif ()
