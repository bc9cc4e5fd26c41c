// Checks of meshes that are refused as solids, and of the test for intersecting triangles.
#include <iterator>
#include <tuple>
#include <utility>

#include "reference/bodies/closed_mesh.h"
#include "reference/mesh/mesh_file.h"
#include "reference/mesh/self_intersection.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/check.h"
#include "verification/specimens/random.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/ugly_solids.h"

namespace foldproof {

namespace {

TriangleSoup turned_round(TriangleSoup soup) {
  for (Triangle& t : soup.triangles) std::swap(t[0], t[1]);
  return soup;
}

TriangleSoup ball(double radius) { return soup_of(make_icosphere(radius, 2)); }

/// A surface that is not a solid, and the words that its refusal must contain.
struct BadSolid {
  std::string name;
  TriangleSoup soup;
  std::vector<std::string> parts;
};

/// ":LINE:" of triangle t in a file written by write_obj: a comment, the vertices, the triangles.
std::string line_of(const TriangleSoup& soup, int t) {
  return ":" + std::to_string(2 + soup.rest.cols() + t) + ":";
}

std::vector<BadSolid> bad_solids() {
  const TriangleSoup whole = ball(0.7);
  TriangleSoup open = whole, flipped = whole, pierced = whole;
  open.triangles.erase(open.triangles.begin() + 211);
  open.triangles.erase(open.triangles.begin() + 17);
  std::swap(flipped.triangles[133][1], flipped.triangles[133][2]);
  pierced.rest.col(5) *= -1.2;  // pulled out through the far side
  return {
      {"two holes", open, {"a hole", "6 such edges around 2 holes", "repair"}},
      {"a flipped triangle", flipped, {"opposite orientation"}},
      {"a vertex pulled through the far side", pierced, {"meets", "intersecting pairs", "repair"}},
      {"two balls that overlap",
       join(whole, whole, {0.5, 0.31, 0.22}),
       {"meets", "intersecting pairs"}},
      {"a ball inside out", turned_round(whole), {line_of(whole, 0), "320 triangles", "inward"}},
      {"a ball in a ball, both outward",
       join(whole, ball(0.3), {0.1, 0.05, 0}),
       {":" + std::to_string(2 + 2 * 162 + 320) + ":", "within another piece"}},
      {"a ball beside another, inside out",
       join(whole, turned_round(ball(0.3)), {1.7, 0.05, 0}),
       {":" + std::to_string(2 + 2 * 162 + 320) + ":", "inward"}}};
}

Finding bad_solids_are_rejected() {
  const ScratchFolder folder;
  const std::string path = folder.file("bad.obj");
  Table measured("case; file or words missing from the refusal [1]; message");
  for (const BadSolid& bad : bad_solids()) {
    write_obj(path, bad.soup.rest, bad.soup.triangles);
    const std::string message =
        rejection_message([&] { make_closed_mesh(read_mesh_file(path).soup); });
    const int missing = !message.starts_with(path + ":") + count_missing(message, bad.parts);
    const size_t folder_size = path.size() - std::string("bad.obj").size();
    measured.row(bad.name, missing, message.substr(std::min(message.size(), folder_size)));
  }
  return judge_worst(measured, "file or words missing from the refusal", 0,
                     "each message must name the file, the defect, and how often it occurs");
}

Finding places_are_right() {
  Table measured{{"case", ""}, {"places that are not named as they are", "1"}};
  const TriangleSoup whole = ball(0.7);
  int wrong = 0;
  for (int t = 3; t < 320; t += 37) {
    TriangleSoup open = whole;
    open.triangles.erase(open.triangles.begin() + t);
    const std::string message = rejection_message([&] { make_closed_mesh(open); });
    bool named = false;  // an edge of the missing triangle
    for (int k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(whole.triangles[t][k], whole.triangles[t][(k + 1) % 3]);
      named = named || message.find("between vertex " + std::to_string(a) + " and vertex " +
                                    std::to_string(b) + ",") != std::string::npos;
    }
    if (!named) ++wrong;
  }
  measured.row("hole: an edge of the triangle that is missing", wrong);
  return judge_worst(measured, 0, "the edge named must be one of the hole's");
}

Finding solids_are_accepted() {
  Table measured{{"case", ""}, {"refused", "1"}};
  std::vector<std::pair<std::string, TriangleSoup>> good{
      {"ball", ball(0.7)},
      {"statue", soup_of(small_statue())},
      {"two balls", join(ball(0.7), ball(0.4), {1.3, 0.2, 0.1})},
      {"ball with a cavity and a ball in it",
       join(join(ball(0.7), turned_round(ball(0.5)), {0.02, 0.01, 0}), ball(0.3),
            {0.05, -0.02, 0.01})}};
  for (const UglySolid& solid : ugly_solids()) good.emplace_back(solid.name, solid.soup);
  for (const auto& [name, soup] : good)
    measured.row(name,
                 rejection_message([&soup = soup] { make_closed_mesh(soup); }).empty() ? 0 : 1);
  return judge_worst(measured, 0, "each of them parts inside from outside");
}

// ---- pairs of triangles whose answer follows from their construction, in whole numbers

using Six = std::array<Vector3, 6>;

Vector3 whole(Random& random, double size) {
  const Vector3 v = random.vectors(1, size).col(0);
  return {std::round(v.x()), std::round(v.y()), std::round(v.z())};
}

/// Three vectors, weighted 1, 2 and 3, add up to zero: the origin is inside the triangle that they
/// span.
std::array<Vector3, 3> around_origin(Random& random) {
  const Vector3 a = 6 * whole(random, 50), b = 6 * whole(random, 50);
  return {a, b, -(a + 2 * b) / 3};
}

/// Two triangles with a common point inside each.
Six crossing(Random& random) {
  const Vector3 at = whole(random, 100);
  const auto s = around_origin(random), t = around_origin(random);
  return {at + s[0], at + s[1], at + s[2], at + t[0], at + t[1], at + t[2]};
}

/// A vertex of the second lies in the first; the rest of it is on one side.
Six touching(Random& random) {
  Six x = crossing(random);
  const Vector3 normal = (x[1] - x[0]).cross(x[2] - x[0]);
  const Vector3 at = (x[0] + 2 * x[1] + 3 * x[2]) / 6;
  x[3] = at;
  for (int k = 4; k < 6; ++k)
    if ((x[k] - at).dot(normal) < 0) x[k] = 2 * at - x[k];
  return x;
}

/// The same, with the second moved away by `gap` along an axis. These numbers can hold a gap of
/// 2^-44 at the least.
Six apart(Random& random, double gap) {
  Six x = touching(random);
  const Vector3 normal = (x[1] - x[0]).cross(x[2] - x[0]);
  Eigen::Index axis;
  normal.cwiseAbs().maxCoeff(&axis);
  for (int k = 3; k < 6; ++k) x[k][axis] += std::copysign(gap, normal[axis]);
  return x;
}

/// Coplanar: the second lies within the first, or beyond its far side.
Six in_plane(Random& random, bool overlapping) {
  const Vector3 u = whole(random, 50), v = whole(random, 50), at = whole(random, 1000);
  const auto point = [&](double a, double b) { return Vector3(at + a * u + b * v); };
  if (overlapping)
    return {point(0, 0), point(9, 1), point(2, 8), point(2, 2), point(4, 2), point(3, 4)};
  return {point(0, 0), point(9, 1), point(2, 8), point(9, 2), point(8, 7), point(6, 6)};
}

struct Family {
  std::string name;
  std::function<Six(Random&)> make;
  bool meets;
};

std::vector<Family> families() {
  return {{"common point", crossing, true},
          {"vertex on face", touching, true},
          {"vertex off face", [](Random& random) { return apart(random, 1); }, false},
          {"vertex a hair off face", [](Random& random) { return apart(random, 0x1p-44); }, false},
          {"in one plane, one in the other", [](Random& random) { return in_plane(random, true); },
           true},
          {"in one plane, side by side", [](Random& random) { return in_plane(random, false); },
           false}};
}

bool has_area(const Vector3& a, const Vector3& b, const Vector3& c) {
  return (b - a).cross(c - a).norm() > 0;
}

Finding intersections_are_found() {
  Table measured{{"case", ""}, {"wrong answers", "1"}};
  for (const Family& family : families()) {
    Random random(97);
    int wrong = 0;
    for (int i = 0; i < 4000; ++i) {
      const Six x = family.make(random);
      if (!has_area(x[0], x[1], x[2]) || !has_area(x[3], x[4], x[5])) continue;
      PerParticle3 rest(3, 6);
      for (int k = 0; k < 6; ++k) rest.col(k) = x[k];
      rest /= 1024;  // no coordinate is rounded
      if (intersect(rest, {0, 1, 2}, {3, 4, 5}) != family.meets) ++wrong;
      if (intersect(rest, {5, 3, 4}, {2, 0, 1}) != family.meets) ++wrong;
    }
    measured.row(family.name, wrong);
  }
  return judge_worst(
      measured, 0, "coordinates are whole numbers over 1024, and signs of determinants are exact");
}

/// Triangles that share an edge or a vertex.
Finding neighbours_are_told_apart() {
  PerParticle3 x(3, 7);
  x << 0, 4, 0, 4, 1, 5, 1,  //
      0, 0, 4, 4, 1, 1, 1,   //
      0, 0, 0, 0, 0, 3, -3;
  const Triangle base{0, 1, 2};
  const std::vector<std::tuple<std::string, Triangle, bool>> cases = {
      {"edge shared, flat", {2, 1, 3}, false},
      {"edge shared, folded flat onto the other", {2, 1, 4}, true},
      {"edge shared, folded", {2, 1, 5}, false},
      // 3 is in the plane, but 0-3 runs over the base
      {"vertex shared, an edge over the other", {0, 5, 3}, true},
      {"vertex shared, through the other", {0, 5, 6}, true},
      {"vertex shared, away from the other", {1, 5, 3}, false}};
  Table measured{{"case", ""}, {"wrong answers", "1"}};
  for (const auto& [name, triangle, meets] : cases)
    measured.row(name,
                 (intersect(x, base, triangle) != meets) + (intersect(x, triangle, base) != meets));
  return judge_worst(measured, 0,
                     "contact in a shared vertex does not count, any other contact does");
}

/// The tree must find the same pairs as a brute-force search.
Finding pairs_are_complete() {
  Table measured{{"case", ""}, {"pairs missing or superfluous", "1"}};
  for (const double shift : {0.4, 1.1}) {
    const TriangleSoup both = join(ball(0.7), ball(0.7), {shift, 0.31, 0.22});
    std::vector<std::pair<int, int>> all;
    for (int s = 0; s < int(both.triangles.size()); ++s)
      for (int t = s + 1; t < int(both.triangles.size()); ++t)
        if (intersect(both.rest, both.triangles[s], both.triangles[t])) all.emplace_back(s, t);
    const auto found = self_intersections(both.rest, both.triangles);
    std::vector<std::pair<int, int>> differing;
    std::set_symmetric_difference(all.begin(), all.end(), found.begin(), found.end(),
                                  std::back_inserter(differing));
    measured.row(std::to_string(all.size()) + " pairs",
                 double(differing.size()) + (all.empty() ? 1 : 0));
  }
  return judge_worst(measured, 0, "boxes that do not meet hold no triangles that do");
}

}  // namespace

std::vector<Check> closed_mesh_checks() {
  return {{"level-set.invalid-solids-are-rejected",
           "Holes, flipped triangles, intersections and inside-out pieces are refused by name and "
           "number.",
           "ours", bad_solids_are_rejected},
          {"level-set.reported-edges-belong-to-holes",
           "The edge that a refusal names is one of the hole's.", "ours", places_are_right},
          {"level-set.valid-solids-are-accepted",
           "Single bodies, several bodies and nested shells are accepted, even with thin rays and "
           "fins.",
           "ours", solids_are_accepted},
          {"level-set.triangle-intersections-are-exact",
           "The test whether two triangles meet is right, also for contact and for triangles in "
           "one plane.",
           "Shewchuk 1997", intersections_are_found},
          {"level-set.neighbouring-triangles-may-touch",
           "Triangles may meet in the edge or vertex that they share, and in nothing more.", "ours",
           neighbours_are_told_apart},
          {"level-set.all-intersecting-pairs-are-found", "The tree finds all intersecting pairs.",
           "ours", pairs_are_complete}};
}

}  // namespace foldproof
