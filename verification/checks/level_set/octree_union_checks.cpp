#include <random>

#include "reference/level_set/octree_nodes.h"
#include "verification/checks/level_set/octree_samples.h"
#include "verification/seeds.h"
#include "verification/specimens/check.h"

namespace foldproof {

namespace {

/// Four bodies: two balls and a capsule, all overlapping each other, and one that touches none.
std::vector<DistanceFunction> parts_of_a_body() {
  return {[](const Vector3& p) { return Sphere{0.19}.at(p - Vector3(-0.11, 0.02, 0.01)); },
          [](const Vector3& p) { return Sphere{0.16}.at(p - Vector3(0.14, -0.03, 0.04)); },
          [](const Vector3& p) {
            return Capsule{0.08, 0.21}.at(p - Vector3(0.02, 0.09, -0.03));
          },
          [](const Vector3& p) { return Sphere{0.07}.at(p - Vector3(0.29, -0.31, -0.27)); }};
}

OctreeSettings union_sampling(double tolerance) {
  OctreeSettings settings = sampling(8, tolerance, HangingNodes::constrained);
  settings.reach = 0.011;
  return settings;
}

/// The union of bodies at a point, from the definition.
struct Exact {
  double first = INFINITY, second = INFINITY;  // phi of the two nearest parts [m]
  int part = -1, second_part = -1;
  int inside = 0;
};

Exact exact_union(const std::vector<DistanceFunction>& parts, const Vector3& p) {
  std::vector<std::pair<double, int>> sorted;
  for (std::size_t k = 0; k < parts.size(); ++k) sorted.push_back({parts[k](p).phi, int(k)});
  std::sort(sorted.begin(), sorted.end());
  const auto inside =
      std::count_if(sorted.begin(), sorted.end(), [](const auto& s) { return s.first < 0; });
  return {sorted[0].first, sorted[1].first, sorted[0].second, sorted[1].second, int(inside)};
}

Finding nodes_know_their_part() {
  const std::vector<DistanceFunction> parts = parts_of_a_body();
  const Octree tree = make_octree(parts, union_sampling(7e-4));
  const std::vector<OctreePlace> places = branch_places(tree);
  double wrong_value = 0, wrong_part = 0, wrong_flag = 0, pinched = 0;
  for (std::size_t b = 0; b < places.size(); ++b) {
    const std::uint32_t hanging = hanging_nodes(tree, places[b]);
    const BranchNodes<NodeFlags> flags = node_flags(tree, int(b));
    for (int n = 0; n < 27; ++n) {
      if (hanging >> n & 1) continue;
      const Exact exact = exact_union(parts, node_position(tree.settings, places[b], n));
      double phi = INFINITY;
      for (int k = 0; k < tree.branches[b].parts; ++k)
        phi = std::min(phi, tree.phi[tree.branches[b].channels + k][n]);
      wrong_value += !(phi == exact.first);
      wrong_part += flags[n].part != exact.part && exact.second != exact.first;
      wrong_flag += flags[n].pinched != (exact.inside >= 2);
      pinched += exact.inside >= 2;
    }
  }
  Table measured{{"case", ""}, {"nodes that are wrong", "1"}};
  measured.row("phi, bit for bit", wrong_value);
  measured.row("nearest part", wrong_part);
  measured.row("pinch flag", wrong_flag);
  measured.row("fewer than 101 nodes are pinched", !(pinched > 100));
  return judge_worst(measured, 0, "free nodes hold the parts' values: comparisons, no arithmetic");
}

std::vector<Vector3> points_near(const std::vector<DistanceFunction>& parts, double within) {
  std::mt19937 random(shifted_seed(5309));
  std::uniform_real_distribution<double> along(-0.5, 0.5);
  std::vector<Vector3> points;
  while (points.size() < 20000) {
    const double x = along(random), y = along(random), z = along(random);
    if (std::abs(exact_union(parts, {x, y, z}).first) <= within) points.push_back({x, y, z});
  }
  return points;
}

Finding union_misses_by_its_tolerance() {
  const std::vector<DistanceFunction> parts = parts_of_a_body();
  Table measured{{"case", ""}, {"largest miss", "tolerances"}};
  for (const double tolerance : {2.1e-3, 7e-4}) {
    const Octree tree = make_octree(parts, union_sampling(tolerance));
    Worst nearest, second;
    for (const Vector3& p : points_near(parts, 0.03)) {
      const Exact exact = exact_union(parts, p);
      const NearestParts at = nearest_parts(tree, p);
      nearest.observe(std::abs(tree.at(p).phi - exact.first) / tolerance);
      nearest.observe(std::abs(at.first.phi - exact.first) / tolerance);
      if (exact.second < 0) second.observe(std::abs(at.second.phi - exact.second) / tolerance);
    }
    measured.row("nearest part, to " + std::to_string(tolerance) + " m", nearest.value());
    measured.row("second part of pinched points, to " + std::to_string(tolerance) + " m",
                 second.value());
  }
  return judge_worst(
      measured, 2,
      "as for one body: each part is sampled by itself, so their crease costs nothing");
}

Finding pinch_is_flagged() {
  const std::vector<DistanceFunction> parts = parts_of_a_body();
  const double tolerance = 7e-4;
  const Octree tree = make_octree(parts, union_sampling(tolerance));
  double wrong_count = 0, wrong_parts = 0, pinched = 0;
  for (const Vector3& p : points_near(parts, 0.03)) {
    const Exact exact = exact_union(parts, p);
    if (!(std::abs(exact.second) > 2 * tolerance && std::abs(exact.first) > 2 * tolerance))
      continue;
    const NearestParts at = nearest_parts(tree, p);
    wrong_count += std::min(at.inside, 2) != std::min(exact.inside, 2);
    if (exact.inside < 2) continue;
    ++pinched;
    if (exact.inside == 2 && exact.second - exact.first > 4 * tolerance)
      wrong_parts += at.first_part != exact.part || at.second_part != exact.second_part;
  }
  Table measured{{"case", ""}, {"points that are wrong", "1"}};
  measured.row("inside of two or more", wrong_count);
  measured.row("which two", wrong_parts);
  measured.row("fewer than 100 pinched points", pinched < 100);
  return judge_worst(measured, 0, "points nearer to a decision than two tolerances are left out");
}

/// Small balls far from each other: inside the wide cells between them, the nearest ball may be one
/// that is nearest at none of the nodes.
std::vector<DistanceFunction> scattered_balls() {
  std::vector<DistanceFunction> parts;
  for (const Vector3& c : random_points(9, 0.4, 5))
    parts.push_back([=](const Vector3& p) { return Sphere{0.05}.at(p - c); });
  return parts;
}

Finding union_jumps_nowhere() {
  Table measured{{"case", ""}, {"largest jump", "epsilon of the cube's width"}};
  for (const double tolerance : {2.1e-3, 7e-4})
    measured.row(
        "to " + std::to_string(tolerance) + " m",
        largest_jump(make_octree(parts_of_a_body(), union_sampling(tolerance)), 20000) / epsilon);
  const OctreeSettings sparse{Vector3::Constant(-0.5),  1, 6, 2, 2.1e-3, 0.02, 0.3, 0,
                              HangingNodes::constrained};
  measured.row("scattered balls, wide cells",
               largest_jump(make_octree(scattered_balls(), sparse), 200000, 3) / epsilon);
  return judge_worst(measured, 32,
                     "as for one body; a part that one side omits is behind another at all nodes "
                     "of their common face, and so everywhere on it");
}

}  // namespace

std::vector<Check> octree_union_checks() {
  const char* const source = "BMF03 section 5.1";
  return {
      {"octree.union-nodes-know-their-part",
       "Nodes of a union hold the least of the parts' distances, the part it belongs to, and "
       "whether two parts contain the node.",
       source, nodes_know_their_part},
      {"octree.union-error-is-bounded-by-the-tolerance",
       "A union's phi errs by at most twice the tolerance, even at its creases.", source,
       union_misses_by_its_tolerance},
      {"octree.union-flags-pinched-points",
       "A point inside two or more parts of a union is reported, with those parts.", source,
       pinch_is_flagged},
      {"octree.union-is-continuous", "A union's phi jumps nowhere.", source, union_jumps_nowhere}};
}

}  // namespace foldproof
