#include <memory>
#include <random>

#include "reference/level_set/object.h"
#include "reference/level_set/octree_nodes.h"
#include "verification/checks/level_set/octree_samples.h"
#include "verification/seeds.h"
#include "verification/specimens/check.h"

namespace foldproof {

namespace {

Distance capsule_upright(const Vector3& p) { return Capsule{0.17, 0.13}.at(p); }
Distance ball(const Vector3& p) { return Sphere{0.31}.at(p - Vector3(0.05, -0.02, 0.03)); }

struct Body {
  std::string name;
  DistanceFunction distance;
};

std::vector<Body> smooth_bodies() {
  return {{"sphere", ball}, {"tilted torus", tilted_torus}, {"capsule", capsule_upright}};
}

Finding jumps_nowhere() {
  Table measured("case; largest jump [epsilon of the cube's width]; with free nodes [m]");
  for (const Body& body : smooth_bodies())
    for (const int depth : {4, 7}) {
      const Octree tree =
          make_octree({body.distance}, sampling(depth, 3e-4, HangingNodes::constrained));
      const Octree loose = make_octree({body.distance}, sampling(depth, 3e-4, HangingNodes::free));
      measured.row(body.name + ", depth " + std::to_string(depth),
                   largest_jump(tree, 20000) / epsilon, largest_jump(loose, 20000));
    }
  return judge_worst(measured, "largest jump", 32,
                     "each side adds the products of its eight corners with six roundings; a place "
                     "rounded by epsilon/2 moves a trilinear value of slope 1 by as much, along "
                     "three axes and on both sides");
}

/// The tree's error in tolerances, at points of the inner half of the band.
double worst_miss(const Body& body, const OctreeSettings& settings) {
  const Octree tree = make_octree({body.distance}, settings);
  Worst worst;
  for (const Vector3& p : random_points(60000, 0.5, 90211)) {
    const double phi = body.distance(p).phi;
    if (std::abs(phi) <= 0.5 * settings.band)
      worst.observe(std::abs(tree.at(p).phi - phi) / settings.tolerance);
  }
  return worst.value();
}

Finding misses_by_its_tolerance() {
  Table measured{{"case", ""}, {"largest miss", "tolerances"}};
  for (const Body& body : smooth_bodies())
    for (const double tolerance : {1.1e-3, 2.3e-4})
      measured.row(body.name + " to " + std::to_string(tolerance) + " m",
                   worst_miss(body, sampling(9, tolerance, HangingNodes::constrained)));
  return judge_worst(measured, 2,
                     "a leaf errs by the tolerance where its own corners are exact, and by as much "
                     "again where they are interpolated from a coarse neighbour");
}

/// Differences in level between the eight leaves around a node, highest less lowest.
int level_step(const Octree& tree, const Vector3& node) {
  int low = 99, high = 0;
  for (int side = 0; side < 8; ++side) {
    const Vector3 toward(side & 1 ? 1 : -1, side & 2 ? 1 : -1, side & 4 ? 1 : -1);
    const int level = leaf_at(tree, node + 1e-9 * toward).level;
    low = std::min(low, level);
    high = std::max(high, level);
  }
  return high - low;
}

Finding neighbours_differ_by_one_level() {
  Table measured{{"case", ""}, {"levels between neighbours", "1"}};
  for (const Body& body : smooth_bodies()) {
    const Octree tree = make_octree({body.distance}, sampling(7, 3e-4, HangingNodes::constrained));
    Worst worst;
    for (const OctreePlace& place : branch_places(tree))
      for (int n = 0; n < 27; ++n)
        worst.observe(level_step(tree, node_position(tree.settings, place, n)));
    measured.row(body.name, worst.value());
  }
  return judge_worst(measured, 1,
                     "constraints span one level only, across faces, edges and corners alike");
}

/// Angle between the tree's normals and the exact ones next to the surface, over the finest
/// cell's angle h/R.
Finding normals_are_those_of_the_cells() {
  Table measured{{"case", ""}, {"largest angle", "finest cells over the least radius"}};
  for (const int depth : {5, 6, 7}) {
    const double h = std::ldexp(1, -depth), radius = 0.11;
    OctreeSettings settings = sampling(depth, 1e-9, HangingNodes::constrained);
    settings.band = 4 * h;
    const Octree tree = make_octree({tilted_torus}, settings);
    Worst worst;
    for (const Vector3& p : random_points(60000, 0.5, 90211)) {
      const Distance exact = tilted_torus(p);
      if (!(std::abs(exact.phi) <= h)) continue;
      const Vector3 n = tree.at(p).normal;
      worst.observe(std::atan2(n.cross(exact.normal).norm(), n.dot(exact.normal)) /
                    (h / (radius - h)));
    }
    measured.row("h = 1/" + std::to_string(1 << depth) + " m", worst.value());
  }
  return judge_worst(measured, std::sqrt(3.0) / 2,
                     "the slope of a cell is exact at its centre, at most half a diagonal away, "
                     "and a normal turns by the distance over the radius of curvature");
}

Finding goes_on_beyond_the_cube() {
  Table measured{{"case", ""}, {"share of what is allowed", "1"}};
  OctreeSettings settings = sampling(7, 5e-4, HangingNodes::constrained);
  settings.band = 1;  // the tolerance holds as far as the boundary
  for (const Body& body : smooth_bodies()) {
    const Octree tree = make_octree({body.distance}, settings);
    Worst change, below;
    for (const Vector3& p : random_points(3000, 1.3, 90211)) {
      const Vector3 q = p.cwiseMax(-0.5).cwiseMin(0.5);
      if (p == q) continue;
      const double phi = tree.at(p).phi;
      change.observe(std::abs(phi - tree.at(q).phi) / (p - q).norm());
      below.observe((body.distance(p).phi - phi) / (2 * settings.tolerance));
    }
    measured.row(body.name + ", change over the way", change.value() * (1 - 16 * epsilon));
    measured.row(body.name + ", below the distance over two tolerances", below.value());
  }
  return judge_worst(
      measured, 1,
      "the distance to one point changes by at most the displacement, up to rounding; it is at "
      "least the distance to the surface, which that point misses by the error of phi");
}

/// An octree of a body moved by keyframes: its answers against the body's own, and the number of
/// queries to the body after the tree is built.
Finding rides_with_its_body() {
  long queries = 0;
  const DistanceFunction counted = [&queries](const Vector3& p) {
    ++queries;
    return tilted_torus(p);
  };
  const OctreeSettings settings = sampling(8, 4e-4, HangingNodes::constrained);
  const OctreeSolid solid{std::make_shared<const Octree>(make_octree({counted}, settings))};
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(1.1, Vector3(0.6, 0, -0.8)));
  const Keyframes motion = make_keyframes(
      {{0, {}}, {0.7, {turned, {0.3, -0.2, 0.9}}}, {1.6, {turned * turned, {1.3, 0.4, 0.1}}}});
  const RigidObject object{solid, {turned.conjugate(), {0.05, 0.1, -0.2}}, motion};
  Table measured{{"case", ""}, {"largest miss", "tolerances"}};
  const long before = queries;
  for (const double time : {0.0, 0.4, 1.1, 2.0}) {
    const Pose pose = after(pose_at(motion, time), object.place);
    Worst worst;
    for (const Vector3& X : random_points(20000, 0.5, 90211)) {
      const double phi = tilted_torus(X).phi;
      if (std::abs(phi) > 0.5 * settings.band) continue;
      const Vector3 x = pose.rotation * X + pose.translation;
      worst.observe(std::abs(object.at(x, {time, time, 0}).phi - phi) / settings.tolerance);
    }
    measured.row("at " + std::to_string(time) + " s", worst.value());
  }
  measured.row("distances asked for after it was built", double(queries - before));
  return judge_worst(measured, 2, "as at rest: a rigid motion changes no distance");
}

Finding rejects_bad_settings() {
  Table measured{{"case", ""}, {"refusals without the reason", "1"}};
  struct Bad {
    std::string name, keyword;
    std::function<void(OctreeSettings&)> spoil;
  };
  const std::vector<Bad> all = {
      {"no width", "width", [](OctreeSettings& s) { s.width = 0; }},
      {"a width that is no number", "width", [](OctreeSettings& s) { s.width = NAN; }},
      {"no depth", "depth", [](OctreeSettings& s) { s.depth = 0; }},
      {"a surface finer than the tree", "surface",
       [](OctreeSettings& s) { s.surface_depth = s.depth + 1; }},
      {"no tolerance", "tolerance", [](OctreeSettings& s) { s.tolerance = 0; }},
      {"a negative band", "band", [](OctreeSettings& s) { s.band = -0.1; }},
      {"a negative reach", "reach", [](OctreeSettings& s) { s.reach = -0.1; }},
      {"a cube that is too small", "reaches the boundary",
       [](OctreeSettings& s) { s.width = 0.4; }}};
  for (const Bad& bad : all) {
    OctreeSettings settings = sampling(5, 1e-3, HangingNodes::constrained);
    bad.spoil(settings);
    measured.row(bad.name, !is_rejected([&] { make_octree({ball}, settings); }, bad.keyword));
  }
  const OctreeSettings good = sampling(5, 1e-3, HangingNodes::constrained);
  measured.row("no body", !is_rejected([&] { make_octree({}, good); }, "bodies"));
  return judge_worst(measured, 0, "each refusal must name its reason");
}

}  // namespace

std::vector<Vector3> random_points(int count, double half_width, unsigned seed) {
  std::mt19937 random(shifted_seed(seed));
  std::uniform_real_distribution<double> along(-half_width, half_width);
  std::vector<Vector3> points;
  for (int i = 0; i < count; ++i) {
    const double x = along(random), y = along(random), z = along(random);
    points.push_back({x, y, z});
  }
  return points;
}

Distance tilted_torus(const Vector3& p) {
  const Eigen::AngleAxisd turn(0.7, Vector3(0.36, -0.48, 0.8));
  const Distance distance = Torus{0.29, 0.11}.at(turn.inverse() * (p - Vector3(0.02, 0.03, -0.04)));
  return {distance.phi, turn * distance.normal};
}

OctreeSettings sampling(int depth, double tolerance, HangingNodes hanging) {
  return {Vector3::Constant(-0.5), 1, depth, 2, tolerance, 0.06, 0.1, 0, hanging};
}

double largest_jump(const Octree& tree, int count, int deepest) {
  std::vector<OctreePlace> places = branch_places(tree);
  std::erase_if(
      places, [&](const OctreePlace& place) { return place.level == 0 || place.level > deepest; });
  std::mt19937 random(shifted_seed(41177));
  std::uniform_int_distribution<std::size_t> any_branch(0, places.size() - 1);
  std::uniform_int_distribution<int> any_axis(0, 2);
  std::uniform_real_distribution<double> along(0, 1);
  Worst worst;
  for (int i = 0; i < count; ++i) {
    const OctreePlace& place = places[any_branch(random)];
    const Vector3 low = node_position(tree.settings, place, 0),
                  high = node_position(tree.settings, place, 26);
    const double x = along(random), y = along(random), z = along(random);
    Vector3 above = low + (high - low).cwiseProduct(Vector3(x, y, z));
    const int axis = any_axis(random);
    above[axis] = low[axis];
    Vector3 below = above;
    below[axis] = std::nextafter(low[axis], -1e9);
    worst.observe(std::abs(tree.at(above).phi - tree.at(below).phi));
  }
  return worst.value();
}

std::vector<Check> octree_checks() {
  const char* const source = "BMF03 section 5.1";
  return {
      {"octree.phi-is-continuous",
       "The octree's phi jumps nowhere, not even where cells of two sizes meet.", source,
       jumps_nowhere},
      {"octree.error-is-bounded-by-the-tolerance",
       "In the band the octree's phi errs by at most twice the tolerance.", source,
       misses_by_its_tolerance},
      {"octree.neighbours-differ-by-at-most-one-level",
       "Leaves that touch differ by one level at most.", source, neighbours_differ_by_one_level},
      {"octree.normals-are-first-order",
       "Next to the surface the octree's N errs by half a cell's diagonal at most.", source,
       normals_are_those_of_the_cells},
      {"octree.phi-continues-beyond-the-cube",
       "Beyond its cube the octree's phi is continuous and no less than the distance.", source,
       goes_on_beyond_the_cube},
      {"octree.tree-moves-with-its-body",
       "The octree of a rigid body, built once, is valid for every place and orientation.", source,
       rides_with_its_body},
      {"octree.invalid-settings-are-rejected",
       "Settings that make no tree are refused with the reason.", source, rejects_bad_settings}};
}

}  // namespace foldproof
