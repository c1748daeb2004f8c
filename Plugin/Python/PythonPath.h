// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef PythonPath_h
#define PythonPath_h

namespace volumic
{
/**
 * Have ParaView's Python find the package volumic, whose classes read and write files. The plugin
 * calls it when it is loaded, in the client and in servers.
 */
void AddPythonPath();
}

#endif
