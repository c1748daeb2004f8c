// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkVolumicPropertyMacros_h
#define vtkVolumicPropertyMacros_h

// Declare the Set and Get methods of a property. Unlike those of vtkSetMacro(), they are defined in
// the source file of the class.
#define volumicPropertyMacro(name, type) \
  virtual void Set##name(type value);    \
  virtual type Get##name()

// Declare also the On and Off methods.
#define volumicBooleanPropertyMacro(name) \
  volumicPropertyMacro(name, bool);       \
  vtkBooleanMacro(name, bool)

#endif
