// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPickOnSlices_h
#define volumicPickOnSlices_h

class pqRenderView;

/**
 * The point under the mouse on the nearest slice of a volume that the view shows as "Slice", which
 * ParaView's own picking doesn't see. False where there is none, or where ParaView's picking finds
 * a surface.
 */
bool PickOnSlices(pqRenderView* view, double position[3]);

#endif
