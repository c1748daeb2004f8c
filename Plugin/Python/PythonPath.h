// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef PythonPath_h
#define PythonPath_h

namespace volumic
{
/**
 * Add the folder of the package volumic to the path of ParaView's Python. The plugin calls it when
 * it is loaded, in the client and in servers.
 */
void AddPythonPath();
}

#endif
