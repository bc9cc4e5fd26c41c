// Two triangles that cross, pushed apart: where each edge pierces, against the definition.
#include <Eigen/LU>
#include <cmath>

#include "reference/filters/untangling.h"
#include "verification/checks/filters/filter_checks.h"
#include "verification/evidence.h"
#include "verification/specimens/random.h"

namespace foldproof {

namespace {

constexpr double speed = 0.3;        // m/s
constexpr double well_inside = 0.1;  // of every weight, and of what is left to an edge's ends
constexpr double steepness = 0.2;    // least sine of an edge's angle with the other triangle

/// Where an edge of one triangle pierces the other.
struct Place {
  int a, b;        // the edge's ends
  Triangle plane;  // the other's corners
  Vector3 p;       // m
  Vector3 shares;  // along the edge from a; of the second and third corner
};

/// p = a + along (b - a) = t0 + w1 (t1 - t0) + w2 (t2 - t0), solved for the shares.
Place place_of(const PerParticle3& x, int a, int b, const Triangle& plane) {
  const Vector3 t0 = x.col(plane[0]), edge = x.col(b) - x.col(a);
  Eigen::Matrix3d M;
  M << edge, t0 - x.col(plane[1]), t0 - x.col(plane[2]);
  const Vector3 shares = M.partialPivLu().solve(t0 - x.col(a));
  return {a, b, plane, x.col(a) + shares[0] * edge, shares};
}

bool is_steep(const PerParticle3& x, const Place& at) {
  const Vector3 t0 = x.col(at.plane[0]);
  const Vector3 n = (x.col(at.plane[1]) - t0).cross(x.col(at.plane[2]) - t0).normalized();
  return std::abs((x.col(at.b) - x.col(at.a)).normalized().dot(n)) > steepness;
}

/// The two ends of the line in which the triangles cross; empty where they do not, or hardly.
std::vector<Place> ends_of_line(const PerParticle3& x, const Triangle& s, const Triangle& t) {
  std::vector<Place> ends;
  for (const auto& [edges, plane] : {std::pair(s, t), std::pair(t, s)})
    for (std::size_t k = 0; k < 3; ++k) {
      const Place at = place_of(x, edges[k], edges[(k + 1) % 3], plane);
      const double last = 1 - at.shares[1] - at.shares[2];
      const Vector3& w = at.shares;
      if (!(w[0] > 0 && w[0] < 1 && w[1] > 0 && w[2] > 0 && last > 0)) continue;
      if (w.minCoeff() < well_inside || last < well_inside || w[0] > 1 - well_inside) return {};
      if (!is_steep(x, at)) return {};
      ends.push_back(at);
    }
  return ends;
}

/// How the end moves per displacement of its edge against the other triangle, along the line
/// towards the other end: the steepest way to shorten the line. Exact, as the end is linear in it.
Vector3 steepest(const PerParticle3& x, const Place& end, const Place& other) {
  const Vector3 along = (other.p - end.p).normalized();
  Vector3 direction;
  for (int axis = 0; axis < 3; ++axis) {
    PerParticle3 moved = x;
    moved(axis, end.a) += 1;
    moved(axis, end.b) += 1;
    direction[axis] = (place_of(moved, end.a, end.b, end.plane).p - end.p).dot(along);
  }
  return direction.normalized();
}

/// One impulse between the edge's point and the triangle's, if they part too slowly.
void part(const Place& end, const Vector3& direction, const PerParticle& inverse_mass,
          PerParticle3& v) {
  PerParticle row = PerParticle::Zero(v.cols());  // of each particle in their relative velocity
  row[end.a] += 1 - end.shares[0];
  row[end.b] += end.shares[0];
  row[end.plane[0]] -= 1 - end.shares[1] - end.shares[2];
  row[end.plane[1]] -= end.shares[1];
  row[end.plane[2]] -= end.shares[2];
  const double parting = direction.dot(v * row);
  const PerParticle response = row.cwiseProduct(inverse_mass);
  if (parting < speed)
    v += direction * ((speed - parting) / row.dot(response) * response).transpose();
}

struct Tangle {
  PerParticle3 x, v;
  PerParticle inverse_mass;  // 1/kg
  std::vector<Place> ends;
};

const Triangle first{0, 1, 2}, second{3, 4, 5};

/// Two triangles that cross well: both ends on edges of one of them, or one on each.
Tangle random_tangle(Random& random, bool both_of_one) {
  for (;;) {
    Tangle tangle{random.vectors(6, 1), random.vectors(6, 0.2), PerParticle(6), {}};
    for (Eigen::Index i = 0; i < 6; ++i) tangle.inverse_mass[i] = random.uniform(0.5, 3);
    tangle.ends = ends_of_line(tangle.x, first, second);
    if (tangle.ends.size() == 2 && (tangle.ends[0].plane == tangle.ends[1].plane) == both_of_one)
      return tangle;
  }
}

/// The largest difference from the definition, in either order of the two ends [1].
double difference_from_definition(const Tangle& tangle) {
  PerParticle3 pushed = tangle.v;
  push_out_of_tangle({{0, 1}}, {first, second}, tangle.x, speed, tangle.inverse_mass, pushed);
  double least = INFINITY;
  for (const std::size_t start : {0, 1}) {
    PerParticle3 v = tangle.v;
    for (const std::size_t k : {start, 1 - start})
      part(tangle.ends[k], steepest(tangle.x, tangle.ends[k], tangle.ends[1 - k]),
           tangle.inverse_mass, v);
    least = std::min(least, (v - pushed).cwiseAbs().maxCoeff() / speed);
  }
  return least;
}

Finding pushes_finding(const Subject&) {
  Table measured{{"case", ""}, {"difference of a velocity over the speed", "1"}};
  Random random(71);
  for (const bool both_of_one : {true, false}) {
    double worst = 0, worst_held = 0, moved = 0;
    for (int trial = 0; trial < 40; ++trial) {
      Tangle tangle = random_tangle(random, both_of_one);
      worst = std::max(worst, difference_from_definition(tangle));
      tangle.inverse_mass[trial % 6] = 0;
      worst_held = std::max(worst_held, difference_from_definition(tangle));
      tangle.v.setZero();
      push_out_of_tangle({{0, 1}}, {first, second}, tangle.x, speed, tangle.inverse_mass, tangle.v);
      moved += tangle.v.cwiseAbs().maxCoeff() > 0;
    }
    const std::string name =
        both_of_one ? "two edges of one pierce the other" : "an edge of each pierces the other";
    measured.row(name, moved == 40 ? worst : NAN);
    measured.row(name + ", a particle is held", worst_held);
  }
  return judge_worst(
      measured, 1e-12,
      "a hundred roundings, times 5 for edges a fifth steep and 10 for shares of a tenth");
}

}  // namespace

std::vector<Check> untangling_checks() {
  return {{"self-collision.tangles-are-pushed-where-edges-pierce",
           "Where an edge pierces a triangle, the two part at the set speed, by one impulse in the "
           "direction that shortens their line of intersection fastest.",
           "Volino and Magnenat-Thalmann 2006", pushes_finding}};
}

}  // namespace foldproof
