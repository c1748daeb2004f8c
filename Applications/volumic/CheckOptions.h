// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCheckOptions_h
#define volumicCheckOptions_h

namespace tool
{
struct ToolOptions;

/** @throws UsageError if something is missing, or options are given that make no sense together. */
void CheckOptions(const ToolOptions& options);
}

#endif
