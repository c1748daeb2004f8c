# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Toolchain to compile for arm64 on another processor and to run the tests in qemu. It requires Debian's
# crossbuild-essential-arm64 and qemu-user-static, and VTK for arm64 in the folder VOLUMIC_ARM64_ROOT
# (see Testing/arm64_root.sh). The preset `arm64` uses it.

if (NOT VOLUMIC_ARM64_ROOT)
  message(FATAL_ERROR "Set VOLUMIC_ARM64_ROOT to the folder that Testing/arm64_root.sh makes.")
endif ()
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES VOLUMIC_ARM64_ROOT)

set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_SYSROOT "${VOLUMIC_ARM64_ROOT}")
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static -L "${CMAKE_SYSROOT}")

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
