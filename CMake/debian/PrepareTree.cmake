# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Run by cpack on the trees of packages: remove settings that a relocatable installation needs and an
# installation in /usr must not have.

file(GLOB_RECURSE files LIST_DIRECTORIES OFF "${CPACK_TEMPORARY_INSTALL_DIRECTORY}/*")
foreach (file IN LISTS files)
  if (IS_SYMLINK "${file}")
    continue ()
  endif ()
  if (file MATCHES "/plugins/[^/]+/[^/]+[.]so$")
    # The library of the plugin is in the same folder; all others are in system folders.
    file(RPATH_SET FILE "${file}" NEW_RPATH "$ORIGIN")
  elseif (file MATCHES "[.]so([.0-9]*)$")
    file(RPATH_REMOVE FILE "${file}")
  elseif (file MATCHES "/bin/volumic$")
    # Debian's interpreter finds VTK without help.
    file(READ "${file}" script)
    string(REGEX REPLACE "^#![^\n]*" "#!/usr/bin/python3" script "${script}")
    string(REGEX REPLACE "sys[.]path[.]append[^\n]*\n" "" script "${script}")
    file(WRITE "${file}" "${script}")
  elseif (file MATCHES "/changelog[.]Debian$")
    execute_process(COMMAND gzip -9nf "${file}" RESULT_VARIABLE status)
    if (NOT status EQUAL 0)
      message(FATAL_ERROR "gzip failed for ${file}")
    endif ()
  endif ()
endforeach ()
