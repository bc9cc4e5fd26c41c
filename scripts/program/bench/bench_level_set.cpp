// Speed and memory of level sets: a grid of 128^3 nodes about a mesh of 81,920 triangles.
#include <fmt/format.h>

#include <memory>
#include <random>
#include <string>

#include "reference/bodies/repair.h"
#include "reference/mesh/self_intersection.h"
#include "reference/level_set/deforming.h"
#include "reference/level_set/narrow_band.h"
#include "reference/mesh/shapes.h"
#include "scripts/program/bench/bench_parts.h"

namespace foldproof {

namespace {

constexpr int side = 128;  // nodes

/// A cube of 128 nodes along each side about the mesh, three cells of it beyond the
/// longest side's ends.
Lattice cube_about(const Bounds& bounds) {
  Lattice lattice = lattice_about(bounds, side - 7, 3);
  lattice.nodes = {side, side, side};
  lattice.origin = bounds.center() - Vector3::Constant(0.5 * lattice.spacing * (side - 1));
  return lattice;
}

std::vector<Vector3> points_in(const Bounds& bounds, int count) {
  std::mt19937_64 random(11);
  std::vector<Vector3> points;
  for (int i = 0; i < count; ++i) {
    Vector3 p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = double(random() >> 11) * 0x1p-53;
    points.push_back(bounds.min() + p.cwiseProduct(bounds.sizes()));
  }
  return points;
}

/// Million answers a second of a solid at the points.
template <class S>
double queries(const S& solid, const std::vector<Vector3>& points) {
  double sum = 0;
  const double seconds = least_seconds([&] {
    for (const Vector3& p : points) {
      const Distance distance = solid.at(p);
      sum += distance.phi + distance.normal.x();
    }
  });
  return sum == sum ? double(points.size()) / seconds / 1e6 : 0;
}

}  // namespace

std::vector<ThreadScaling> level_set_scalings() {
  const TriangleMesh body = make_statue(1, 6);
  const auto mesh = std::make_shared<MeshDistance>(make_mesh_distance(body.rest, body.triangles));
  ThreadScaling band{
      .scene = fmt::format("band of 128^3 nodes, {} triangles", body.triangles.size()),
      .on_two = "level-set-band-on-two-threads",
      .target_on_two = {0.18, "s", "lower",
                        "half of what one thread is to take; tree and normals come before"}};
  measure_on_threads(
      [&](int threads) -> std::function<void()> {
        return [&, threads] {
          narrow_band(*mesh, cube_about(mesh->tree.nodes[0].bounds), 3, threads);
        };
      },
      band);

  const TriangleMesh smaller = make_statue(1, 4);
  const TriangleSoup soup{smaller.rest, smaller.triangles, {}};
  ThreadScaling repair{.scene = fmt::format("grid by winding numbers, 64 cells, {} triangles",
                                            soup.triangles.size())};
  measure_on_threads(
      [&](int threads) -> std::function<void()> {
        return [&, threads] {
          make_repaired_grid(soup, {64, 3, 3, MarchingOrder::second}, threads);
        };
      },
      repair);

  const auto bend = [](const Vector3& X, double t) -> Vector3 {
    return 0.4 * X + t * Vector3(0.1 * X.y() * X.y(), 0, 0.02);
  };
  const MeshSequence frames = deformed_mesh(smaller, bend, {0, 0.5, 1});
  const OctreeSettings settings{Vector3(-0.5, -0.4, -0.5), 1, 7, 4, 1e-3, 0.03, 0.25, 0,
                                HangingNodes::constrained};
  ThreadScaling octrees{
      .scene = fmt::format("three frames of a body, {} triangles", smaller.triangles.size())};
  measure_on_threads(
      [&](int threads) -> std::function<void()> {
        return [&, threads] {
          make_deforming_body(frames, settings, BetweenFrames::carried, threads);
        };
      },
      octrees);
  return {band, repair, octrees};
}

std::vector<Record> level_set_rates() {
  const TriangleMesh body = make_statue(1, 6);
  const MeshDistance mesh = make_mesh_distance(body.rest, body.triangles);
  const Lattice lattice = cube_about(mesh.tree.nodes[0].bounds);
  const std::vector<Vector3> points = points_in(lattice.bounds(), 100000);
  const double ready = least_seconds([&] { make_mesh_distance(body.rest, body.triangles); });
  const double pairs = least_seconds([&] { self_intersections(body.rest, body.triangles); });
  const double band = ready + least_seconds([&] { narrow_band(mesh, lattice, 3); });
  forget_peak();
  const double before = resident_megabytes("VmRSS");
  Grid grid;
  const double whole = ready + seconds_of([&] {
                         grid =
                             march(lattice, narrow_band(mesh, lattice, 3), MarchingOrder::second);
                       });
  const double over = resident_megabytes("VmHWM") - before - 8e-6 * double(lattice.size());
  const std::string on = fmt::format(" {} triangles, 128^3 nodes.", body.triangles.size());
  return {
      rate("level-set-band",
           "Exact signed distance in a band of three cells, tree and normals included;" + on, band,
           {0.35, "s", "lower",
            "some 400,000 nodes at 0.8 microseconds: the node before bounds the search of each"}),
      rate("level-set-whole", "Band, and second-order marching of all nodes;" + on, whole,
           {1.6, "s", "lower",
            "two million nodes at 0.8 microseconds each: a heap of the front, three quadratics"}),
      rate("level-set-memory", "Peak memory over the grid itself while it is made;" + on, over,
           {100, "MB", "lower",
            "a flag a node, the front, the band's seeds: less than 50 bytes a node"}),
      rate("level-set-intersections",
           fmt::format("All pairs of {} triangles that intersect.", body.triangles.size()), pairs,
           {1, "s", "lower", "a dozen neighbours a triangle at a microsecond each"}),
      rate("level-set-mesh-queries", "Exact signed distance and N at random points about the mesh.",
           queries(mesh, {points.begin(), points.begin() + 5000}),
           {0.1, "million/s", "higher", "some hundred boxes and triangles a search"}),
      rate("level-set-grid-queries", "Trilinear phi and blended N on the grid, at random points.",
           queries(grid, points),
           {3, "million/s", "higher",
            "fifty values gathered from two million, most of them not in the cache"})};
}

}  // namespace foldproof
