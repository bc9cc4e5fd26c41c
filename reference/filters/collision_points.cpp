#include "reference/filters/collision_points.h"

namespace foldproof {

namespace {

void add_point(const std::vector<int>& particles, const PerParticle& inverse_mass,
               std::vector<CollisionPoint>& points) {
  CollisionPoint point;
  double sum = 0;  // 1/kg
  for (int i : particles) {
    point.shares[point.count] = inverse_mass[i];
    point.particles[size_t(point.count++)] = i;
    sum += inverse_mass[i];
  }
  if (!(sum > 0)) return;
  point.shares *= point.count / sum;
  points.push_back(point);
}

}  // namespace

std::vector<CollisionPoint> collision_points(const TriangleMesh& mesh,
                                             const PerParticle& inverse_mass, PointKind kind) {
  std::vector<CollisionPoint> points;
  if (kind == PointKind::faces)
    for (const Triangle& t : mesh.triangles) add_point({t[0], t[1], t[2]}, inverse_mass, points);
  if (kind != PointKind::particles)
    for (const Edge& edge : mesh.edges) add_point({edge.a, edge.b}, inverse_mass, points);
  for (int i = 0; i < mesh.particles(); ++i) add_point({i}, inverse_mass, points);
  return points;
}

}  // namespace foldproof
