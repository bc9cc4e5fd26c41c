// level-sets-in-time: what lies between two stored level sets of a body that deforms, and
// what a frame costs.
#include <random>

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

double largest_miss(const DeformingBody& body, const MeshDistance& exact,
                    const std::vector<Vector3>& points) {
  Worst worst;
  for (const Vector3& p : points)
    worst.observe(std::abs(deforming_at(body, p, middle).phi - exact.at(p).phi));
  return worst.value();
}

const std::string interval_column = "time between frames", way_column = "longest way of a vertex",
                  distances_column = "distances for a frame",
                  kept_column = "nodes that keep their nearest point";

/// Two frames, each interval apart, with the time that is looked at in their middle: the farthest
/// that a vertex moves between them, the largest misses of phi at that time, distances asked for,
/// for one frame, and the share of the second frame's nodes that keeps the first one's nearest
/// points.
Table pairs_of_frames(const TriangleMesh& ball, int depth, const MeshDistance& exact,
                      const Progress& progress) {
  const std::vector<Vector3> points = points_near(exact);
  double done = 0;
  return refine({{interval_column, "s"},
                 {way_column, "m"},
                 {"miss, blended", "m"},
                 {"miss, carried", "m"},
                 {distances_column, "1"},
                 {kept_column, "1"}},
                std::vector{0.28, 0.14, 0.07, 0.035}, [&](double interval) {
                  const MeshSequence sequence =
                      deformed_mesh(ball, deform, {middle - interval / 2, middle + interval / 2});
                  DeformingBody body =
                      make_deforming_body(sequence, settings_to(depth), BetweenFrames::blended);
                  const double blended = largest_miss(body, exact, points);
                  body.between = BetweenFrames::carried;
                  const double carried = largest_miss(body, exact, points);
                  progress(++done / 4);
                  return std::tuple{
                      interval,
                      (sequence.positions[1] - sequence.positions[0]).colwise().norm().maxCoeff(),
                      blended,
                      carried,
                      double(body.frames[0].field.evaluations),
                      1 - double(body.frames[1].searches) / double(body.frames[1].nodes)};
                });
}

/// kind: "blended" or "carried".
Convergence errors_of(const Table& pairs, const std::string& kind) {
  Convergence errors = convergence_of(pairs, "miss, " + kind);
  errors.floor = 2 * tolerance;  // the octrees' own tolerance, see make_octree
  return errors;
}

NamedFinding nearer_second_order(const Table& pairs, const std::string& kind) {
  Convergence errors = errors_of(pairs, kind);
  const int levels = levels_above_floor(errors, 9);
  errors.steps.resize(std::size_t(levels));
  errors.errors.resize(std::size_t(levels));
  return {"level-sets-in-time." + kind + "-order-is-nearer-two-than-one",
          "Interpolated between frames, " + kind +
              ", phi errs with an order in the time between them that is nearer two than one.",
          {order_verdict(errors, 2, 1, 0.5,
                         "midway between the orders one and two; what the octrees miss leaves no "
                         "more"),
           {{interval_column, "s", errors.steps}, {"largest miss", "m", errors.errors}},
           "measured is |order - 2| of the last pair of intervals whose errors are nine times what "
           "the octrees may miss"}};
}

NamedFinding carried_errs_less(const Table& pairs) {
  const std::vector<double>&carried = pairs.numbers("miss, carried"),
        &blended = pairs.numbers("miss, blended");
  Worst worst;
  for (std::size_t i = 0; i < 2; ++i) worst.observe(carried[i] / blended[i]);
  Table misses = with_columns(pairs, {interval_column});
  misses.add({"carried", "m", carried});
  misses.add({"blended", "m", blended});
  return {"level-sets-in-time.carried-error-is-smaller",
          "At the two longest intervals, phi carried along with the body has less than half the "
          "error of phi blended at a fixed point.",
          {{worst.value(), 0.5, 0, "1",
            "a half: it then saves more than a quarter of the frames, 1 - 1/sqrt(2), since both "
            "errors fall with the square of the interval"},
           misses,
           "measured is the larger ratio of the two longest intervals"}};
}

NamedFinding frame_is_cheap(const Table& pairs, int depth) {
  const double nodes = std::pow(std::ldexp(1, depth) + 1, 3);
  const std::vector<double>& evaluations = pairs.numbers(distances_column);
  Worst worst;
  for (const double distances : evaluations) worst.observe(distances / nodes);
  Table counts = with_columns(pairs, {interval_column});
  counts.add({"distances for the first frame", "1", evaluations});
  counts.add({"nodes of the grid", "1", std::vector<double>(pairs.rows(), nodes)});
  return {"level-sets-in-time.frames-compute-few-distances",
          "A frame of a deforming body needs at most a tenth of the distances that a full grid of "
          "the same spacing would need.",
          {{worst.value(), 0.1, 0, "1",
            "a tenth: beyond the band the octree is sampled only as finely as needed"},
           counts}};
}

NamedFinding fast_bodies_keep_little(const Table& pairs) {
  return {"level-sets-in-time.fast-bodies-reuse-little",
          "A body that moves by more than its radius between two frames leaves few nodes of the "
          "first unchanged: nearly all are computed again.",
          {{pairs.numbers(kept_column).front(), 0.1, 0, "1",
            "a tenth: only a node farther from the surface than the displacement keeps its nearest "
            "point, and the cube has few of these"},
           with_columns(pairs, {way_column, kept_column})}};
}

Figure figure_of(const Table& pairs) {
  Figure figure{"errors",
                "Error between two frames",
                {interval_column, "s", Scale::log},
                {"largest miss of phi", "m", Scale::log},
                2,
                "Within 2 cm of the surface, midway in time between the two frames, against the "
                "exact distance to the mesh as it is then. The floor is the octrees' tolerance."};
  for (const auto& [label, kind] :
       {std::pair{"blended at the point", "blended"}, {"carried along", "carried"}}) {
    figure.curves.push_back(curve_of(label, errors_of(pairs, kind)));
    figure.curves.back().floor = tolerance;
  }
  return figure;
}

StudyResult run_level_sets_in_time(const Subject&, Tier tier, const Progress& progress) {
  const int depth = tier == Tier::quick ? 7 : 8;
  const TriangleMesh ball = make_icosphere(radius, tier == Tier::quick ? 3 : 4);
  const MeshSequence then = deformed_mesh(ball, deform, {middle});
  const MeshDistance exact = make_mesh_distance(then.positions[0], then.triangles);
  const Table pairs = pairs_of_frames(ball, depth, exact, progress);
  StudyResult result;
  result.findings = {nearer_second_order(pairs, "blended"), nearer_second_order(pairs, "carried"),
                     carried_errs_less(pairs), frame_is_cheap(pairs, depth),
                     fast_bodies_keep_little(pairs)};
  result.figures = {figure_of(pairs)};
  result.tables = {
      {"intervals", "A ball of 0.15 m that is thrown, drawn out, bends and swings", pairs}};
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
