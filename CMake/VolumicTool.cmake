# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# The program `volumic`, with its manual page. It belongs to the build with VTK: the one with ParaView
# may lie under the same prefix.

add_subdirectory(Applications/volumic)
if (NOT SKBUILD) # else as VolumicWheel.cmake says
  file(RELATIVE_PATH volumic_tool_to_library
    "/prefix/${CMAKE_INSTALL_BINDIR}" "/prefix/${CMAKE_INSTALL_LIBDIR}")
  set(volumic_tool_rpath "$ORIGIN/${volumic_tool_to_library}")
  set(volumic_tool_destination "${CMAKE_INSTALL_BINDIR}")
  set(volumic_manual_destination "${CMAKE_INSTALL_MANDIR}/man1")
endif ()
set_target_properties(volumic PROPERTIES INSTALL_RPATH "${volumic_tool_rpath}")
install(TARGETS volumic
  RUNTIME DESTINATION "${volumic_tool_destination}" COMPONENT runtime)
install(FILES Applications/volumic/volumic.1
  DESTINATION "${volumic_manual_destination}" COMPONENT runtime)
