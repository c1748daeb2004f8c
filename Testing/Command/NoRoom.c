// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// To be loaded before the C library (LD_PRELOAD): a file system that reserves nothing, on a disk that
// is full. Files stay empty, and who touches their memory gets SIGBUS.

#include <sys/types.h>

int posix_fallocate(int file, off_t offset, off_t length)
{
  (void)file;
  (void)offset;
  (void)length;
  return 0;
}

int posix_fallocate64(int file, off_t offset, off_t length)
{
  return posix_fallocate(file, offset, length);
}
