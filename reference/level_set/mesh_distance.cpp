#include "reference/level_set/mesh_distance.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace foldproof {

namespace {

constexpr int leaf_size = 4;
// stack for a median-cut tree over fewer than 2^31 items, with room for both children
constexpr int deepest = 64;

/// The unit vector along a vector, or zero for zero.
Vector3 unit(const Vector3& v) {
  const double length = v.norm();
  return length > 0 ? Vector3(v / length) : Vector3(Vector3::Zero());
}

/// The angle of the triangle at its corner k [rad].
double corner_angle(const Corners3& corners, int k) {
  const Vector3 u = corners[(k + 1) % 3] - corners[k], v = corners[(k + 2) % 3] - corners[k];
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

Corners3 corners_at(const PerParticle3& x, const Triangle& triangle) {
  return {x.col(triangle[0]), x.col(triangle[1]), x.col(triangle[2])};
}

/// Normals of the vertices (weighted by angles), of the edges by key, of the faces.
struct Normals {
  PerParticle3 vertex;
  std::unordered_map<long, Vector3> edge;
  std::vector<Vector3> face;
};

/// The same for both directions of an edge.
long edge_key(int a, int b) { return (long(std::min(a, b)) << 32) + std::max(a, b); }

Normals normals_of(const PerParticle3& x, const std::vector<Triangle>& triangles) {
  Normals normals{PerParticle3::Zero(3, x.cols()), {}, {}};
  for (const Triangle& triangle : triangles) {
    const Corners3 corners = corners_at(x, triangle);
    const Vector3 face = unit((corners[1] - corners[0]).cross(corners[2] - corners[0]));
    normals.face.push_back(face);
    for (int k = 0; k < 3; ++k) {
      normals.vertex.col(triangle[k]) += corner_angle(corners, k) * face;
      const auto [edge, fresh] =
          normals.edge.try_emplace(edge_key(triangle[k], triangle[(k + 1) % 3]), Vector3::Zero());
      edge->second += face;
    }
  }
  return normals;
}

std::array<Vector3, 7> feature_normals(const Normals& normals, const Triangle& t, int triangle) {
  std::array<Vector3, 7> all;
  for (int k = 0; k < 3; ++k) {
    all[k] = unit(normals.vertex.col(t[k]));
    all[3 + k] = unit(normals.edge.at(edge_key(t[k], t[(k + 1) % 3])));
  }
  all[6] = normals.face[triangle];
  return all;
}

}  // namespace

MeshDistance make_mesh_distance(PerParticle3 x, std::vector<Triangle> triangles) {
  if (triangles.empty()) throw InputError("make_mesh_distance: no triangles; give at least one");
  MeshDistance mesh;
  mesh.tree = make_box_tree(triangle_bounds(x, triangles), leaf_size);
  const Normals normals = normals_of(x, triangles);
  mesh.corners.reserve(triangles.size());
  mesh.normals.reserve(triangles.size());
  for (const int t : mesh.tree.order) {
    mesh.corners.push_back(corners_at(x, triangles[t]));
    mesh.normals.push_back(feature_normals(normals, triangles[t], t));
  }
  mesh.resolution = 16 * std::numeric_limits<double>::epsilon() * x.cwiseAbs().maxCoeff();
  mesh.x = std::move(x);
  mesh.triangles = std::move(triangles);
  return mesh;
}

// Nodes are visited nearest first; a node farther away than the nearest feature found is skipped.
NearestFeature nearest_feature(const MeshDistance& mesh, const Vector3& p, double bound) {
  struct Waiting {
    int node;
    double squared_distance;
  };
  std::array<Waiting, deepest> waiting;
  const std::vector<BoxNode>& nodes = mesh.tree.nodes;
  int count = 0;
  NearestFeature best;
  best.squared_distance = bound * bound;
  waiting[count++] = {0, nodes[0].bounds.squaredExteriorDistance(p)};
  while (count > 0) {
    const Waiting next = waiting[--count];
    if (!(next.squared_distance < best.squared_distance)) continue;
    const BoxNode& node = nodes[next.node];
    if (node.right < 0) {
      for (int i = node.first; i < node.first + node.count; ++i) {
        NearestFeature found = nearest_on_triangle(mesh.corners[i], p);
        if (!(found.squared_distance < best.squared_distance)) continue;
        best = found;
        best.triangle = i;
      }
      continue;
    }
    Waiting near{next.node + 1, nodes[next.node + 1].bounds.squaredExteriorDistance(p)};
    Waiting far{node.right, nodes[node.right].bounds.squaredExteriorDistance(p)};
    if (far.squared_distance < near.squared_distance) std::swap(near, far);
    if (far.squared_distance < best.squared_distance) waiting[count++] = far;
    if (near.squared_distance < best.squared_distance) waiting[count++] = near;
  }
  return best;
}

Distance signed_distance(const MeshDistance& mesh, const NearestFeature& nearest,
                         const Vector3& p) {
  const Vector3 away = p - nearest.point;
  const Vector3& outward = mesh.normals[nearest.triangle][size_t(nearest.feature)];
  const double side = away.dot(outward) < 0 ? -1 : 1;
  const double distance = std::sqrt(nearest.squared_distance);
  if (!(distance > mesh.resolution)) return {side * distance, outward};
  return {side * distance, side / distance * away};
}

Distance MeshDistance::at(const Vector3& p) const {
  const NearestFeature nearest = nearest_feature(*this, p, std::numeric_limits<double>::infinity());
  // p is not finite
  if (nearest.triangle < 0) return {std::numeric_limits<double>::quiet_NaN(), Vector3::Zero()};
  return signed_distance(*this, nearest, p);
}

}  // namespace foldproof
