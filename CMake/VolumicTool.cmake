# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# The example SegmentVolume as the program `volumic`, with its manual page. It belongs to the build
# with VTK: the one with ParaView may lie under the same prefix.

add_subdirectory(Examples/Cxx/SegmentVolume)
set_target_properties(SegmentVolume PROPERTIES OUTPUT_NAME volumic)
file(RELATIVE_PATH volumic_tool_to_library
  "/prefix/${CMAKE_INSTALL_BINDIR}" "/prefix/${CMAKE_INSTALL_LIBDIR}")
set_target_properties(SegmentVolume PROPERTIES INSTALL_RPATH "$ORIGIN/${volumic_tool_to_library}")
install(TARGETS SegmentVolume
  RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT runtime)
install(FILES Examples/Cxx/SegmentVolume/volumic.1
  DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT runtime)
