// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// To be loaded before the C library (LD_PRELOAD): the process takes the machine for one with 16
// processors, on all of which it may run.

#define _GNU_SOURCE

#include <dlfcn.h>
#include <pthread.h>
#include <sched.h>
#include <string.h>
#include <sys/sysinfo.h>
#include <unistd.h>

enum
{
  Processors = 16
};

int sched_getaffinity(pid_t process, size_t size, cpu_set_t* set)
{
  (void)process;
  memset(set, 0, size);
  for (int i = 0; i < Processors; ++i)
  {
    CPU_SET_S(i, size, set);
  }
  return 0;
}

int pthread_getaffinity_np(pthread_t thread, size_t size, cpu_set_t* set)
{
  (void)thread;
  return sched_getaffinity(0, size, set);
}

int sched_setaffinity(pid_t process, size_t size, const cpu_set_t* set)
{
  (void)process;
  (void)size;
  (void)set;
  return 0;
}

int get_nprocs(void)
{
  return Processors;
}

int get_nprocs_conf(void)
{
  return Processors;
}

long sysconf(int name)
{
  static long (*next)(int);
  if (!next)
  {
    next = (long (*)(int))dlsym(RTLD_NEXT, "sysconf");
  }
  return name == _SC_NPROCESSORS_ONLN || name == _SC_NPROCESSORS_CONF ? Processors : next(name);
}
