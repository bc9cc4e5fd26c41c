// Cost of contact with an object per step.
#include <fmt/format.h>

#include <cmath>

#include "reference/filters/filter.h"
#include "reference/level_set/mesh_distance.h"
#include "reference/level_set/octree.h"
#include "reference/mesh/shapes.h"
#include "scripts/program/bench/bench_parts.h"

namespace foldproof {

namespace {

constexpr int depth = 8;

/// A statue 0.8 m long about the origin.
OctreeSolid statue() {
  const TriangleMesh mesh = make_statue(1, 4);
  const Vector3 low = mesh.rest.rowwise().minCoeff(), high = mesh.rest.rowwise().maxCoeff();
  const MeshDistance distance = make_mesh_distance(
      0.8 / (high - low).maxCoeff() * (mesh.rest.colwise() - 0.5 * (low + high)), mesh.triangles);
  const OctreeSettings settings{
      Vector3::Constant(-0.5),  1, depth, 4, 2e-4, 3.0 / (1 << depth), 0.25, 0,
      HangingNodes::constrained};
  return {std::make_shared<const Octree>(
      make_octree({[&](const Vector3& p) { return distance.at(p); }}, settings))};
}

/// Lets each particle of a level sheet sink from above until it is within `near` [m] of the object,
/// or back where it was.
void drape(const Object& object, double near, PerParticle3& x) {
  ObjectsOverSpan still({&object, 1}, {0, 0, 0});
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    Vector3 p = x.col(i) + Vector3(0, 0, 1);
    for (double phi = 1; phi > near && p.z() > x(2, i);) {
      phi = still.at(p).front().phi;
      p.z() -= phi;
    }
    x(2, i) = std::max(x(2, i), p.z());
  }
}

}  // namespace

Record contact_rate(const Scene& load, double step, double step_seconds) {
  Object object{"statue", RigidObject{statue(), {}, Motion{}}, 0.3};
  auto& body = std::get<RigidObject>(object.body);
  body.place.translation = load.x.rowwise().mean();
  State s{0, load.x, load.v};
  drape(object, 1e-4, s.x);
  s.v.row(2) *= -1;  // down, onto the body
  const PerParticle inverse_mass = PerParticle::Ones(s.x.cols());
  const ObjectCollision contact{{object},
                                collision_points(load.mesh, inverse_mass, PointKind::particles),
                                responses().front(),
                                0};

  Work counted, work;
  PerParticle3 v = s.v;
  const auto correct_twice = [&](Work& kept) {
    v = s.v;
    contact.correct({0, step, step}, s, v, kept);
    contact.correct({step, step, step}, s, v, kept);
  };
  correct_twice(counted);
  const double seconds = least_seconds([&] { correct_twice(work); });
  return rate(
      "contact-octree",
      fmt::format(
          "The two corrections of a step against an octree of {:.0f} MB, over that step without "
          "objects: {} particles, {:.0f} % of them on the object; the corrections take {:.1f} ms.",
          double(bytes(*std::get<OctreeSolid>(body.solid).tree)) / 1e6, s.x.cols(),
          100.0 * double(counted.object_contacts) / double(s.x.cols()), 1e3 * seconds),
      seconds / step_seconds,
      {0.1, "1", "lower",
       "a particle asks twice a step; a descent of eight levels and a cell that its neighbour has "
       "brought to the cache are 50 ns, a step some microsecond a particle"});
}

}  // namespace foldproof
