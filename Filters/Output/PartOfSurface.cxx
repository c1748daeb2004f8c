// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Output/PartOfSurface.h"

#include <array>
#include <cstddef>

namespace volumic
{
SurfaceResult PartOf(const SurfaceResult& surface, const SurfaceFeatures& features,
  const std::vector<bool>& isKept)
{
  SurfaceResult part;
  part.Delta = surface.Delta;
  part.FitToTolerance = surface.FitToTolerance;
  LargeVector<int> index(surface.Points.size(), -1);
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    if (isKept[features.ComponentOfTriangle[t]])
    {
      part.Triangles.push_back(surface.Triangles[t]);
      for (const int corner : surface.Triangles[t])
      {
        index[corner] = 0;
      }
    }
  }
  for (std::size_t p = 0; p < surface.Points.size(); ++p)
  {
    if (index[p] == 0)
    {
      index[p] = static_cast<int>(part.Points.size());
      part.Points.push_back(surface.Points[p]);
      part.Normals.push_back(surface.Normals[p]);
      part.Residual.push_back(surface.Residual[p]);
      part.Motionless.push_back(surface.Motionless[p]);
      part.Held.push_back(surface.Held[p]);
      if (!surface.Size.empty())
      {
        part.Size.push_back(surface.Size[p]);
      }
      if (!surface.Thickness.empty())
      {
        part.Thickness.push_back(surface.Thickness[p]);
      }
    }
  }
  for (const std::array<int, 2>& pair : surface.Contacts)
  {
    if (index[pair[0]] >= 0 && index[pair[1]] >= 0)
    {
      part.Contacts.push_back({ index[pair[0]], index[pair[1]] });
    }
  }
  for (Triangle& triangle : part.Triangles)
  {
    for (int& corner : triangle)
    {
      corner = index[corner];
    }
  }
  return part;
}
}
