# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Build the ParaView plugin `Volumic` in a folder that ParaView searches for plugins.

set(volumic_plugin_subdirectory
  "paraview-${ParaView_VERSION_MAJOR}.${ParaView_VERSION_MINOR}/plugins")
# Folder of the plugin in the build tree.
set(VOLUMIC_PLUGIN_DIR
  "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}/${volumic_plugin_subdirectory}/Volumic")

function (volumic_build_plugin)
  # From <lib>/paraview-x.y/plugins/Volumic to the module's library in <lib>.
  list(PREPEND CMAKE_INSTALL_RPATH "$ORIGIN/../../..")
  paraview_plugin_scan(
    PLUGIN_FILES "${CMAKE_SOURCE_DIR}/Plugin/paraview.plugin"
    PROVIDES_PLUGINS plugins
    HIDE_PLUGINS_FROM_CACHE ON
    ENABLE_BY_DEFAULT ON)
  paraview_plugin_build(
    PLUGINS ${plugins}
    PLUGINS_COMPONENT plugin
    RUNTIME_DESTINATION "${CMAKE_INSTALL_BINDIR}"
    LIBRARY_DESTINATION "${CMAKE_INSTALL_LIBDIR}"
    LIBRARY_SUBDIRECTORY "${volumic_plugin_subdirectory}"
    ADD_INSTALL_RPATHS OFF
    INSTALL_HEADERS OFF)
endfunction ()

volumic_build_plugin()
