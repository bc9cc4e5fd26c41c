#include "reference/bodies/closed_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "reference/mesh/self_intersection.h"
#include "reference/level_set/winding.h"
#include "reference/mesh/mesh_locations.h"
#include "reference/mesh/seams.h"

namespace foldproof {

namespace {

const std::string remedy = "mend it, or set repair = \"winding\"";

int root(std::vector<int>& parent, int item) {
  while (parent[item] != item) item = parent[item] = parent[parent[item]];
  return item;
}

std::vector<int> roots(int items) {
  std::vector<int> parent(items);
  std::iota(parent.begin(), parent.end(), 0);
  return parent;
}

void join(std::vector<int>& parent, int a, int b) {
  const int first = root(parent, a), second = root(parent, b);
  parent[std::max(first, second)] = std::min(first, second);
}

/// Each border vertex has two border edges, so borders are closed loops, one per root.
void reject_holes(const TriangleMesh& mesh, const MeshOrigin& origin) {
  std::vector<int> parent = roots(mesh.particles());
  std::vector<const Edge*> border;
  for (const Edge& edge : mesh.edges) {
    if (edge.triangles[1] >= 0) continue;
    border.push_back(&edge);
    join(parent, edge.a, edge.b);
  }
  if (border.empty()) return;
  if (const std::string open = open_seams_in_words(mesh, "[[object]]"); !open.empty())
    throw InputError(triangle_location(origin, border.front()->triangles[0]) + open);
  std::set<int> loops;
  for (const Edge* edge : border) loops.insert(root(parent, edge->a));
  const Edge& first = *border.front();
  throw InputError(triangle_location(origin, first.triangles[0]) +
                   "a hole: " + edge_name(origin, first.a, first.b) + ", at " +
                   position_name(mesh.rest.col(first.a)) + ", has no triangle on its other side (" +
                   std::to_string(border.size()) + " such edges around " +
                   std::to_string(loops.size()) + (loops.size() == 1 ? " hole" : " holes") + "); " +
                   remedy);
}

void reject_self_intersections(const TriangleMesh& mesh, const MeshOrigin& origin) {
  const auto pairs = self_intersections(mesh.rest, mesh.triangles);
  if (pairs.empty()) return;
  const auto [s, t] = pairs.front();
  throw InputError(triangle_location(origin, t) + "meets " + triangle_name(origin, s) + " near " +
                   position_name(mesh.rest.col(mesh.triangles[t][0])) + ", the first of " +
                   std::to_string(pairs.size()) + " intersecting pairs; " + remedy);
}

/// Normals point outward on a piece outside all others, inward on a piece inside another.
void reject_inside_out(const TriangleMesh& mesh, const MeshOrigin& origin) {
  const std::vector<int> piece = pieces_of(mesh);
  const int pieces = count_of_pieces(mesh);
  for (int own = 0; own < pieces; ++own) {
    std::vector<Triangle> inside, others;
    for (size_t t = 0; t < piece.size(); ++t)
      (piece[t] == own ? inside : others).push_back(mesh.triangles[t]);
    const double around =
        std::round(winding_number(mesh.rest, others, mesh.rest.col(inside[0][0])));
    const bool outward = enclosed_volume(mesh.rest, inside) > 0;
    if (around == (outward ? 0 : 1)) continue;
    const int first = int(std::find(piece.begin(), piece.end(), own) - piece.begin());
    throw InputError(triangle_location(origin, first) + "the piece of " +
                     std::to_string(inside.size()) +
                     " triangles that begins here is inside out: its normals point " +
                     (outward ? "outward, though it lies within another piece" : "inward") +
                     "; reverse the order of its triangles' vertices, or set repair = \"winding\"");
  }
}

}  // namespace

std::vector<int> pieces_of(const TriangleMesh& mesh) {
  std::vector<int> parent = roots(int(mesh.triangles.size()));
  for (const Edge& edge : mesh.edges)
    if (edge.triangles[1] >= 0) join(parent, edge.triangles[0], edge.triangles[1]);
  std::vector<int> piece(parent.size());
  int pieces = 0;
  for (int t = 0; t < int(parent.size()); ++t)
    piece[t] = root(parent, t) == t ? pieces++ : piece[root(parent, t)];
  return piece;
}

int count_of_pieces(const TriangleMesh& mesh) { return std::ranges::max(pieces_of(mesh)) + 1; }

double enclosed_volume(const PerParticle3& x, const std::vector<Triangle>& triangles) {
  const Vector3 origin = x.col(triangles[0][0]);
  double six_volumes = 0;
  for (const Triangle& t : triangles)
    six_volumes += (x.col(t[0]) - origin).cross(x.col(t[1]) - origin).dot(x.col(t[2]) - origin);
  return six_volumes / 6;
}

TriangleMesh make_closed_mesh(TriangleSoup soup) {
  const MeshOrigin origin = std::move(soup.origin);
  TriangleMesh mesh = make_triangle_mesh(std::move(soup.rest), std::move(soup.triangles), origin);
  reject_holes(mesh, origin);
  reject_self_intersections(mesh, origin);
  reject_inside_out(mesh, origin);
  return mesh;
}

}  // namespace foldproof
