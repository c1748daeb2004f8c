// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Makes the volumes of a .msh that volumic has written such that gmsh fills them:
//   gmsh -3 model.msh volumes.geo -o tetrahedra.msh
// It takes volumes of a file for meshed, with or without elements. So each gets a volume of gmsh's own
// with the same boundary in its place, and in its physical group.
p() = Physical Volume{:};
For k In {0 : #p() - 1}
  v() = Physical Volume{p(k)};
  For i In {0 : #v() - 1}
    b() = Boundary{ Volume{v(i)}; };
    Delete{ Volume{v(i)}; }
    Surface Loop(v(i)) = b();
    Volume(v(i)) = {v(i)};
  EndFor
  Physical Volume(p(k)) = v();
EndFor
