// How fast an octree is built and asked.
#include <fmt/format.h>

#include <cmath>
#include <random>

#include "reference/level_set/mesh_distance.h"
#include "reference/level_set/octree.h"
#include "reference/mesh/shapes.h"
#include "scripts/program/bench/bench_parts.h"

namespace foldproof {

namespace {

constexpr int octree_depth = 9;
constexpr double band = 3.0 / 512;  // m

MeshDistance statue_distance() {
  const TriangleMesh mesh = make_statue(1, 4);
  const Vector3 low = mesh.rest.rowwise().minCoeff(), high = mesh.rest.rowwise().maxCoeff();
  return make_mesh_distance(
      0.82 / (high - low).maxCoeff() * (mesh.rest.colwise() - 0.5 * (low + high)), mesh.triangles);
}

/// Places within the band, in no order: the worst that cloth can ask for.
std::vector<Vector3> places(const MeshDistance& mesh) {
  std::mt19937_64 random(11);
  const auto within = [&](double half) {
    return half * (2 * double(random() >> 11) * 0x1p-53 - 1);
  };
  std::vector<Vector3> result;
  for (int i = 0; i < 40000; ++i) {
    const double x = within(0.4), y = within(0.4), z = within(0.4), up = within(band);
    const Distance at = mesh.at({x, y, z});
    result.push_back(Vector3(x, y, z) - (at.phi - up) * at.normal);
  }
  return result;
}

}  // namespace

std::vector<Record> octree_rates() {
  const MeshDistance mesh = statue_distance();
  const OctreeSettings settings{Vector3::Constant(-0.5),  1, octree_depth, 4, 2e-4, band, 0.25, 0,
                                HangingNodes::constrained};
  Octree tree;
  const double build = seconds_of(
      [&] { tree = make_octree({[&](const Vector3& p) { return mesh.at(p); }}, settings); });
  const std::vector<Vector3> all = places(mesh);
  Vector3 sum = Vector3::Zero();
  const double ask = least_seconds([&] {
    for (const Vector3& p : all) {
      const Distance at = tree.at(p);
      sum += at.phi * at.normal;
    }
  });
  const std::string size = fmt::format("{:.1f} million leaves, {:.0f} MB",
                                       double(leaves(tree)) / 1e6, double(bytes(tree)) / 1e6);
  return {rate("octree-queries",
               "phi and N of an octree at random places next to the surface: " + size + ".",
               sum.allFinite() ? double(all.size()) / ask / 1e6 : NAN,
               {3, "million queries/s", "higher",
                "a third of a microsecond: a descent of nine levels and one visit to memory beyond "
                "the caches"}),
          rate("octree-build", "Time to build that octree from a mesh, per distance asked for.",
               1e6 * build / double(tree.evaluations),
               {5, "us", "lower",
                "a distance to a mesh of some thousand triangles is a few microseconds, and the "
                "tree should add little to it"})};
}

}  // namespace foldproof
