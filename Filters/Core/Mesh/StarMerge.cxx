// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/StarMerge.h"

#include <algorithm>
#include <limits>

namespace volumic
{
bool StarMerge::PlanFrom(int offset, float best, float& cost)
{
  // State (i, k): bridge edge from vertex i of the first link to vertex offset + k of the second.
  const int n = this->FirstLink.Count;
  const int m = this->SecondLink.Count;
  float sum[Ring::Capacity + 1][Ring::Capacity + 1];
  bool alongFirst[Ring::Capacity + 1][Ring::Capacity + 1];
  for (int i = 0; i <= n; ++i)
  {
    for (int k = 0; k <= m; ++k)
    {
      const float fromFirst = i > 0 ? sum[i - 1][k] : std::numeric_limits<float>::max();
      const float fromSecond = k > 0 ? sum[i][k - 1] : std::numeric_limits<float>::max();
      const float length = this->Squared[i % n][(offset + k) % m];
      alongFirst[i][k] = fromFirst < fromSecond;
      sum[i][k] = (i == 0 && k == 0) ? 0.f : length + std::min(fromFirst, fromSecond);
    }
  }
  cost = sum[n][m];
  if (cost >= best)
  {
    return false;
  }
  this->Candidate.clear();
  for (int i = n, k = m; i > 0 || k > 0;)
  {
    (alongFirst[i][k] ? i : k) -= 1;
    this->Candidate.push_back({ i % n, (offset + k) % m });
  }
  std::reverse(this->Candidate.begin(), this->Candidate.end());
  // A whole turn about one link vertex has more bridge edges than the other link has vertices.
  int perFirst[Ring::Capacity] = {};
  int perSecond[Ring::Capacity] = {};
  for (const BridgeEdge& edge : this->Candidate)
  {
    if (++perFirst[edge.First] > m || ++perSecond[edge.Second] > n)
    {
      return false;
    }
  }
  return true;
}

bool StarMerge::Fits(const SurfaceMesh& mesh) const
{
  int perFirst[Ring::Capacity] = {};
  int perSecond[Ring::Capacity] = {};
  for (const BridgeEdge& edge : this->BridgeEdges)
  {
    ++perFirst[edge.First];
    ++perSecond[edge.Second];
  }
  for (int i = 0; i < this->FirstLink.Count; ++i)
  {
    if (mesh.Rings[this->FirstLink.Item[i]].Count - 1 + perFirst[i] > Ring::Capacity)
    {
      return false;
    }
  }
  for (int k = 0; k < this->SecondLink.Count; ++k)
  {
    if (mesh.Rings[this->SecondLink.Item[k]].Count - 1 + perSecond[k] > Ring::Capacity)
    {
      return false;
    }
  }
  return true;
}

bool StarMerge::MeasureLinks(const SurfaceMesh& mesh)
{
  this->FirstLink = mesh.Rings[this->U];
  this->SecondLink = mesh.Rings[this->V];
  std::reverse(this->SecondLink.Item, this->SecondLink.Item + this->SecondLink.Count);
  for (int i = 0; i < this->FirstLink.Count; ++i)
  {
    const int r = this->FirstLink.Item[i];
    if (r == this->V)
    {
      return false;
    }
    for (int k = 0; k < this->SecondLink.Count; ++k)
    {
      const int s = this->SecondLink.Item[k];
      if (r == s || mesh.AreNeighbours(r, s))
      {
        return false;
      }
      this->Squared[i][k] = SquaredDistance(mesh.Position[r], mesh.Position[s]);
    }
  }
  return true;
}

float StarMerge::PlanInStep(int offset)
{
  const int n = this->FirstLink.Count;
  const int m = this->SecondLink.Count;
  this->Candidate.clear();
  float cost = 0;
  int i = 0;
  int k = 0;
  while (i < n || k < m)
  {
    (k == m || (i < n && i * m <= k * n) ? i : k) += 1;
    this->Candidate.push_back({ i % n, (offset + k) % m });
    cost += this->Squared[i % n][(offset + k) % m];
  }
  return cost;
}

void StarMerge::ChooseBridgeEdges()
{
  float best = std::numeric_limits<float>::max();
  this->BridgeEdges.clear();
  for (int offset = 0; offset < this->SecondLink.Count; ++offset)
  {
    float cost = 0;
    if (this->PlanFrom(offset, best, cost))
    {
      best = cost;
      this->BridgeEdges.swap(this->Candidate);
    }
  }
  if (!this->BridgeEdges.empty())
  {
    return;
  }
  // Distant or skew stars: fall back to even strips.
  float least = std::numeric_limits<float>::max();
  for (int offset = 0; offset < this->SecondLink.Count; ++offset)
  {
    const float cost = this->PlanInStep(offset);
    if (cost < least)
    {
      least = cost;
      this->BridgeEdges.swap(this->Candidate);
    }
  }
}

void StarMerge::MakeTriangles()
{
  for (std::size_t i = 0; i < this->BridgeEdges.size(); ++i)
  {
    const BridgeEdge& here = this->BridgeEdges[i];
    const BridgeEdge& next = this->BridgeEdges[(i + 1) % this->BridgeEdges.size()];
    const int r = this->FirstLink.Item[here.First];
    const int s = this->SecondLink.Item[here.Second];
    this->SquaredLongest = std::max(this->SquaredLongest, this->Squared[here.First][here.Second]);
    if (here.Second == next.Second)
    {
      this->Triangles.push_back({ r, this->FirstLink.Item[next.First], s });
    }
    else
    {
      this->Triangles.push_back({ this->SecondLink.Item[next.Second], s, r });
    }
  }
}

bool StarMerge::Plan(const SurfaceMesh& mesh)
{
  if (!this->MeasureLinks(mesh))
  {
    return false;
  }
  this->ChooseBridgeEdges();
  if (!this->Fits(mesh))
  {
    return false;
  }
  this->MakeTriangles();
  return true;
}

void StarMerge::InsertBridgeEdges(SurfaceMesh& mesh, bool first) const
{
  const auto own = [first](const BridgeEdge& edge) { return first ? edge.First : edge.Second; };
  const std::size_t count = this->BridgeEdges.size();
  const int centre = first ? this->U : this->V;
  const Ring& link = first ? this->FirstLink : this->SecondLink;
  const Ring& facing = first ? this->SecondLink : this->FirstLink;
  for (std::size_t begin = 0; begin < count; ++begin)
  {
    const int index = own(this->BridgeEdges[begin]);
    if (index == own(this->BridgeEdges[(begin + count - 1) % count]))
    {
      continue; // Not the first bridge edge of this link vertex.
    }
    int run[Ring::Capacity];
    int length = 0;
    for (std::size_t i = begin; own(this->BridgeEdges[i % count]) == index; ++i)
    {
      const BridgeEdge& edge = this->BridgeEdges[i % count];
      run[length++] = facing.Item[first ? edge.Second : edge.First];
    }
    if (first)
    {
      std::reverse(run, run + length);
    }
    // Replace the centre by the run.
    Ring& ring = mesh.Rings[link.Item[index]];
    const int at = ring.Find(centre);
    const Ring old = ring;
    ring.Count = 0;
    for (int i = 0; i < at; ++i)
    {
      ring.Item[ring.Count++] = old.Item[i];
    }
    for (int i = 0; i < length; ++i)
    {
      ring.Item[ring.Count++] = run[i];
    }
    for (int i = at + 1; i < old.Count; ++i)
    {
      ring.Item[ring.Count++] = old.Item[i];
    }
  }
}

void StarMerge::Apply(SurfaceMesh& mesh, VertexSlots* slots) const
{
  this->InsertBridgeEdges(mesh, true);
  this->InsertBridgeEdges(mesh, false);
  mesh.RemoveVertex(this->U, slots);
  mesh.RemoveVertex(this->V, slots);
}
}
