// level-sets-in-time: what lies between two stored level sets of a body that deforms, and
// what a frame costs.
#include <algorithm>
#include <cmath>
#include <random>

#include "convergence/order.h"
#include "convergence/study.h"
#include "reference/level_set/deforming.h"
#include "reference/level_set/mesh_distance.h"
#include "reference/mesh/shapes.h"
#include "verification/seeds.h"

namespace foldproof {

namespace {

constexpr double radius = 0.15;       // of the body at rest [m]
constexpr double tolerance = 1.5e-4;  // of the octrees [m]
constexpr double middle = 0.31;       // the time that is looked at [s]

/// A ball that is thrown along x while it is drawn out, bends and swings, all at different rates.
Vector3 deform(const Vector3& X, double t) {
  const double drawn_pairs = 1 + 0.25 * std::sin(2.1 * t), bend = 3.2 * std::sin(3.7 * t);
  const Vector3 x(X.x() * drawn_pairs, X.y() / std::sqrt(drawn_pairs),
                  X.z() / std::sqrt(drawn_pairs));
  return x + Vector3(0.7 * (t - middle), bend * x.x() * x.x() * 0.5 + 0.12 * std::sin(2.9 * t),
                     0.3 * t * t);
}

OctreeSettings settings_to(int depth) {
  return {Vector3::Constant(-0.5), 1, depth, 3, tolerance, 0.03, 0.3, 0, HangingNodes::constrained};
}

/// Points within 2 cm of the surface at the middle time.
std::vector<Vector3> points_near(const MeshDistance& mesh) {
  std::mt19937 random(shifted_seed(33301));
  std::uniform_real_distribution<double> along(-0.4, 0.4), height(-0.02, 0.02);
  std::vector<Vector3> points;
  while (points.size() < 1500) {
    const double x = along(random), y = along(random), z = along(random), up = height(random);
    const Distance at = mesh.at({x, y, z});
    points.push_back(Vector3(x, y, z) - (at.phi - up) * at.normal);
  }
  return points;
}

/// Two frames, an interval apart, with the time that is looked at in their middle.
struct Pair {
  double interval;              // s
  double largest_displacement;  // the farthest that a vertex moves in it [m]
  double blended, carried;      // largest miss of phi at the middle time [m]
  double evaluations;           // distances asked for, for one frame
  // of the second frame's nodes, the share that keeps the nearest point of the first [1]
  double kept;
};

double largest_miss(const DeformingBody& body, const MeshDistance& exact,
                    const std::vector<Vector3>& points) {
  Worst worst;
  for (const Vector3& p : points)
    worst.observe(std::abs(deforming_at(body, p, middle).phi - exact.at(p).phi));
  return worst.value();
}

Pair measure(const TriangleMesh& ball, double interval, int depth,
             const std::vector<Vector3>& points, const MeshDistance& exact) {
  const MeshSequence sequence =
      deformed_mesh(ball, deform, {middle - interval / 2, middle + interval / 2});
  DeformingBody body = make_deforming_body(sequence, settings_to(depth), BetweenFrames::blended);
  Pair pair{interval,
            (sequence.positions[1] - sequence.positions[0]).colwise().norm().maxCoeff(),
            0,
            0,
            double(body.frames[0].field.evaluations),
            1 - double(body.frames[1].searches) / double(body.frames[1].nodes)};
  pair.blended = largest_miss(body, exact, points);
  body.between = BetweenFrames::carried;
  pair.carried = largest_miss(body, exact, points);
  return pair;
}

using Miss = double Pair::*;

Convergence convergence_of(const std::vector<Pair>& pairs, Miss miss) {
  Convergence result;
  for (const Pair& pair : pairs) {
    result.steps.push_back(pair.interval);
    result.errors.push_back(pair.*miss);
  }
  result.floor = 2 * tolerance;  // what the octrees may miss, see make_octree
  return result;
}

std::vector<double> column(const std::vector<Pair>& pairs, Miss member) {
  std::vector<double> values;
  for (const Pair& pair : pairs) values.push_back(pair.*member);
  return values;
}

NamedFinding nearer_second_order(const std::vector<Pair>& pairs, Miss miss,
                                 const std::string& name) {
  Convergence errors = convergence_of(pairs, miss);
  const int levels = levels_above_floor(errors, 9);
  errors.steps.resize(std::size_t(levels));
  errors.errors.resize(std::size_t(levels));
  const Estimate deviation = order_deviation(errors, 2, 1);
  return {"level-sets-in-time." + name + "-order-is-nearer-two-than-one",
          "Interpolated between frames, " + name +
              ", phi errs with an order in the time between them that is nearer two than one.",
          {{deviation.value, 0.5, deviation.uncertainty, "1",
            "midway between the orders one and two; what the octrees miss leaves no more"},
           {{"time between frames", "s", errors.steps}, {"largest miss", "m", errors.errors}},
           "measured is |order - 2| of the last pair of intervals whose errors are nine times what "
           "the octrees may miss"}};
}

NamedFinding carried_errs_less(const std::vector<Pair>& pairs) {
  Worst worst;
  for (std::size_t i = 0; i < 2; ++i) worst.observe(pairs[i].carried / pairs[i].blended);
  return {"level-sets-in-time.carried-error-is-smaller",
          "At the two longest intervals, phi carried along with the body has less than half the "
          "error of phi blended at a fixed point.",
          {{worst.value(), 0.5, 0, "1",
            "a half: it then saves more than a quarter of the frames, 1 - 1/sqrt(2), since both "
            "errors fall with the square of the interval"},
           {{"time between frames", "s", column(pairs, &Pair::interval)},
            {"carried", "m", column(pairs, &Pair::carried)},
            {"blended", "m", column(pairs, &Pair::blended)}},
           "measured is the larger ratio of the two longest intervals"}};
}

NamedFinding frame_is_cheap(const std::vector<Pair>& pairs, int depth) {
  const double nodes = std::pow(std::ldexp(1, depth) + 1, 3);
  Worst worst;
  for (const Pair& pair : pairs) worst.observe(pair.evaluations / nodes);
  return {"level-sets-in-time.frames-compute-few-distances",
          "A frame of a deforming body needs at most a tenth of the distances that a full grid of "
          "the same spacing would need.",
          {{worst.value(), 0.1, 0, "1",
            "a tenth: beyond the band the octree is sampled only as finely as needed"},
           {{"time between frames", "s", column(pairs, &Pair::interval)},
            {"distances for the first frame", "1", column(pairs, &Pair::evaluations)},
            {"nodes of the grid", "1", std::vector<double>(pairs.size(), nodes)}},
           ""}};
}

NamedFinding fast_bodies_keep_little(const std::vector<Pair>& pairs) {
  return {"level-sets-in-time.fast-bodies-reuse-little",
          "A body that moves by more than its radius between two frames leaves few nodes of the "
          "first unchanged: nearly all are computed again.",
          {{pairs.front().kept, 0.1, 0, "1",
            "a tenth: only a node farther from the surface than the displacement keeps its nearest "
            "point, and the cube has few of these"},
           {{"longest way of a vertex", "m", column(pairs, &Pair::largest_displacement)},
            {"nodes that keep their nearest point", "1", column(pairs, &Pair::kept)}},
           ""}};
}

Figure figure_of(const std::vector<Pair>& pairs) {
  const std::vector<double> x = column(pairs, &Pair::interval);
  return {"errors",
          "Error between two frames",
          {"time between frames", "s", Scale::log},
          {"largest miss of phi", "m", Scale::log},
          2,
          "Within 2 cm of the surface, midway in time between the two frames, against the exact "
          "distance to the mesh as it is then. The floor is the octrees' tolerance.",
          {{"blended at the point", x, column(pairs, &Pair::blended), tolerance,
            pair_orders(convergence_of(pairs, &Pair::blended))},
           {"carried along", x, column(pairs, &Pair::carried), tolerance,
            pair_orders(convergence_of(pairs, &Pair::carried))}}};
}

Table table_of(const std::vector<Pair>& pairs) {
  return {"intervals",
          "A ball of 0.15 m that is thrown, drawn out, bends and swings",
          {{"time between frames", "s", column(pairs, &Pair::interval)},
           {"longest way of a vertex", "m", column(pairs, &Pair::largest_displacement)},
           {"miss, blended", "m", column(pairs, &Pair::blended)},
           {"miss, carried", "m", column(pairs, &Pair::carried)},
           {"distances for a frame", "1", column(pairs, &Pair::evaluations)},
           {"nodes that keep their nearest point", "1", column(pairs, &Pair::kept)}}};
}

StudyResult run_level_sets_in_time(const Subject&, Tier tier, const Progress& progress) {
  const int depth = tier == Tier::quick ? 7 : 8;
  const TriangleMesh ball = make_icosphere(radius, tier == Tier::quick ? 3 : 4);
  const MeshSequence then = deformed_mesh(ball, deform, {middle});
  const MeshDistance exact = make_mesh_distance(then.positions[0], then.triangles);
  const std::vector<Vector3> points = points_near(exact);
  std::vector<Pair> pairs;
  for (const double interval : {0.28, 0.14, 0.07, 0.035}) {
    pairs.push_back(measure(ball, interval, depth, points, exact));
    progress(double(pairs.size()) / 4);
  }
  StudyResult result;
  result.findings = {nearer_second_order(pairs, &Pair::blended, "blended"),
                     nearer_second_order(pairs, &Pair::carried, "carried"),
                     carried_errs_less(pairs), frame_is_cheap(pairs, depth),
                     fast_bodies_keep_little(pairs)};
  result.figures = {figure_of(pairs)};
  result.tables = {table_of(pairs)};
  return result;
}

}  // namespace

Study level_sets_in_time_study() {
  return {"level-sets-in-time",
          "Stored level sets of a deforming body, interpolated in time, converge to the body "
          "faster than with first order, until the error nears what the octrees themselves miss.",
          {"blended-order-is-nearer-two-than-one", "carried-order-is-nearer-two-than-one"},
          "BMF03 section 5.1",
          "How many frames must be stored? A body deforms smoothly; two frames of it lie about one "
          "time, ever closer, and phi between them is compared with the exact distance to the mesh "
          "at that time.",
          run_level_sets_in_time};
}

}  // namespace foldproof
