#include <filesystem>
#include <set>

#include "reference/level_set/mesh_distance.h"
#include "reference/level_set/object.h"
#include "reference/level_set/octree_nodes.h"
#include "reference/mesh/mesh_file.h"
#include "reference/mesh/shapes.h"
#include "verification/checks/level_set/octree_samples.h"
#include "verification/specimens/check.h"
#include "verification/specimens/scratch_folder.h"

namespace foldproof {

namespace {

constexpr double radius = 0.13;     // m
constexpr double tolerance = 1e-3;  // m

OctreeSettings coarse_sampling() {
  return {Vector3::Constant(-0.5), 1, 6, 3, tolerance, 0.06, 0.2, 0, HangingNodes::constrained};
}

Vector3 shift() { return {0.83, -0.24, 0.5}; }  // a direction, about 1 long

/// A ball displaced by -1/2 `displacement` along the shift at time 0; it moves by `displacement` in
/// every 0.04 s.
MeshSequence moving_ball(double displacement, std::vector<double> times) {
  const auto deformation = [=](const Vector3& X, double t) -> Vector3 {
    return X + (displacement * t / 0.04 - 0.5 * displacement) * shift().normalized();
  };
  return deformed_mesh(make_icosphere(radius, 3), deformation, std::move(times));
}

/// Points about the origin, no farther than `reach` along an axis.
std::vector<Vector3> points_within(double reach) { return random_points(2000, reach, 7741); }

/// Largest error of the body's phi near the surface, at a fraction of the time from its first frame
/// to its second, in tolerances.
double carried_miss(const MeshSequence& ball, const DeformingBody& body, double part) {
  const PerParticle3 x = (1 - part) * ball.positions[0] + part * ball.positions[1];
  const MeshDistance exact = make_mesh_distance(x, ball.triangles);
  Worst worst;
  const Vector3 centre = x.rowwise().mean();
  for (const Vector3& from_centre : points_within(1.2 * radius)) {
    const Vector3 p = centre + from_centre;
    const double phi = exact.at(p).phi;
    if (std::abs(phi) > 0.03) continue;
    worst.observe(std::abs(deforming_at(body, p, part * ball.times[1]).phi - phi) / tolerance);
  }
  return worst.value();
}

Finding carried_ball_keeps_its_shape() {
  Table measured{{"case", ""}, {"largest miss", "tolerances"}};
  for (const double displacement : {0.07, 0.41}) {
    const MeshSequence ball = moving_ball(displacement, {0, 0.04});
    const DeformingBody body = make_deforming_body(ball, coarse_sampling(), BetweenFrames::carried);
    for (const double part : {0.25, 0.5, 0.9})
      measured.row(std::to_string(displacement / (2 * radius)) + " diameters a frame, at " +
                       std::to_string(part),
                   carried_miss(ball, body, part));
  }
  return judge_worst(measured, 2, "a uniform displacement adds nothing to the octrees' error");
}

/// Halfway between the frames: radius, across the motion, at which the blended phi is zero [m]; 0
/// if phi is positive even at the centre.
double blended_radius(double displacement) {
  const DeformingBody body = make_deforming_body(moving_ball(displacement, {0, 0.04}),
                                                 coarse_sampling(), BetweenFrames::blended);
  const Vector3 across = shift().unitOrthogonal();
  double low = 0, high = 2 * radius;
  if (deforming_at(body, Vector3::Zero(), 0.02).phi > 0) return 0;
  while (high - low > 1e-9) {
    const double middle = 0.5 * (low + high);
    (deforming_at(body, middle * across, 0.02).phi < 0 ? low : high) = middle;
  }
  return low;
}

///          p
///       /  |  \        two balls of radius R, d apart: halfway, at the distance r from their line,
///     /  r |    \      the mean of both distances is sqrt(r^2 + d^2/4) - R
///   a ---- + ---- b
Finding blended_ball_shrinks() {
  Table measured{{"case", ""}, {"miss of the radius", "tolerances"}};
  for (const double displacement : {0.05, 0.11, 0.17, 0.29}) {
    const double derived =
        std::sqrt(std::max(0.0, radius * radius - displacement * displacement / 4));
    const double slope = derived / radius;  // of the blended phi there, along r
    const double miss = std::abs(blended_radius(displacement) - derived) * (slope > 0 ? slope : 1);
    measured.row(std::to_string(displacement / (2 * radius)) + " diameters a frame",
                 miss / tolerance);
  }
  return judge_worst(measured, 3,
                     "the two octrees err by two tolerances, and the ball of 1280 triangles "
                     "differs from the sphere by less than another");
}

/// A ball that turns about an axis off its centre: neighbouring points are displaced differently.
MeshSequence turning_ball(double angle, int subdivisions) {
  const Vector3 axis = Vector3(0.48, 0.6, -0.64);
  const auto deformation = [=](const Vector3& X, double t) -> Vector3 {
    return Eigen::AngleAxisd(angle * t / 0.04, axis) * (X + Vector3(0.07, 0.02, 0)) -
           Vector3(0.07, 0.02, 0);
  };
  return deformed_mesh(make_icosphere(radius, subdivisions), deformation, {0, 0.04});
}

/// Errors of a frame's nodes over the allowed ones: some roundings; beyond the band, if |phi| is
/// too large, also half of the error allowed in a cell.
double node_error(const DeformingFrame& frame, const MeshDistance& exact) {
  const Octree& tree = frame.field;
  const std::vector<OctreePlace> places = branch_places(tree);
  Worst worst;
  for (std::size_t b = 0; b < places.size(); ++b)
    for (int n = 0; n < 27; ++n) {
      const double phi = exact.at(node_position(tree.settings, places[b], n)).phi;
      const double kept = tree.phi[std::size_t(tree.branches[b].channels)][std::size_t(n)];
      const double rounding = 16 * epsilon * tree.settings.width;
      const double more = (phi < 0 ? -1 : 1) * (kept - phi);
      const double beyond = std::max(0.0, std::abs(phi) - tree.settings.band);
      worst.observe(more > 0 ? more / (rounding + tree.settings.beyond / 2 * beyond)
                             : -more / rounding);
    }
  return worst.value();
}

/// Hanging nodes keep their own computed values.
OctreeSettings free_sampling() {
  OctreeSettings settings = coarse_sampling();
  settings.hanging = HangingNodes::free;
  return settings;
}

Finding kept_nodes_err_as_bounded() {
  Table measured{{"case", ""}, {"largest error", "of what is allowed"}};
  for (const double displacement : {0.003, 0.02, 0.33}) {
    const MeshSequence ball = moving_ball(displacement, {0, 0.02, 0.04});
    const DeformingBody body = make_deforming_body(ball, free_sampling(), BetweenFrames::carried);
    for (std::size_t k = 0; k < body.frames.size(); ++k)
      measured.row(
          std::to_string(displacement) + " m a frame, frame " + std::to_string(k),
          node_error(body.frames[k], make_mesh_distance(ball.positions[k], ball.triangles)));
  }
  return judge_worst(measured, 1,
                     "a value is kept only if it errs by at most half of a cell's tolerance beyond "
                     "the band, and the surface cannot have passed the node");
}

Finding far_nodes_are_not_searched() {
  const MeshSequence ball = moving_ball(0.003, {0, 0.02, 0.04});
  const DeformingBody body = make_deforming_body(ball, free_sampling(), BetweenFrames::carried);
  Table measured{{"case", ""}, {"searched", "nodes that must be, and a tenth of the others"}};
  for (std::size_t k = 1; k < body.frames.size(); ++k) {
    const Octree& tree = body.frames[k].field;
    std::set<std::array<double, 3>> all, near;
    const std::vector<OctreePlace> places = branch_places(tree);
    for (std::size_t b = 0; b < places.size(); ++b)
      for (int n = 0; n < 27; ++n) {
        const Vector3 p = node_position(tree.settings, places[b], n);
        all.insert({p.x(), p.y(), p.z()});
        if (std::abs(tree.phi[b][std::size_t(n)]) <= tree.settings.band)
          near.insert({p.x(), p.y(), p.z()});
      }
    const double must = double(near.size()) / double(all.size());
    measured.row(
        "frame " + std::to_string(k),
        double(body.frames[k].searches) / double(body.frames[k].nodes) / (must + 0.1 * (1 - must)));
  }
  return judge_worst(measured, 1,
                     "nodes in the band must be searched; a tenth of the rest allows for nodes "
                     "that the previous frame did not have");
}

Finding velocity_is_that_of_the_surface() {
  Table measured{{"case", ""}, {"largest difference", "largest speed"}};
  const MeshSequence ball = turning_ball(0.3, 3);
  const DeformingBody body = make_deforming_body(ball, coarse_sampling(), BetweenFrames::carried);
  const PerParticle3 u = (ball.positions[1] - ball.positions[0]) / 0.04;
  const double scale = u.colwise().norm().maxCoeff();
  for (const double height : {-0.03, 0.0, 0.02, 0.05}) {
    Worst worst;
    for (const Triangle& t : ball.triangles) {
      const PerParticle3& x = ball.positions[0];
      const Vector3 a = x.col(t[0]), b = x.col(t[1]), c = x.col(t[2]);
      const Vector3 middle = (a + b + c) / 3, normal = (b - a).cross(c - a).normalized();
      const Vector3 expected = (u.col(t[0]) + u.col(t[1]) + u.col(t[2])) / 3;
      worst.observe((deforming_at(body, middle + height * normal, 0).velocity - expected).norm() /
                    scale);
    }
    measured.row(std::to_string(height) + " m along N", worst.value());
  }
  return judge_worst(
      measured, 0.05,
      "a cell whose phi errs by the tolerance has a width h with h^2 = 4 tolerance r; there a "
      "direction, whose second derivatives are below 1.5/r^2, errs by 2.25 tolerance/r; twice that "
      "at hanging nodes; r = 0.1 m at the deepest points");
}

Finding points_ride_along() {
  Table measured{{"case", ""}, {"largest distance from the path", "epsilon of the cube's width"}};
  const MeshSequence ball = moving_ball(0.06, {0, 0.04, 0.07, 0.16});
  const DeformingObject object{std::make_shared<DeformingBody>(
      make_deforming_body(ball, coarse_sampling(), BetweenFrames::carried))};
  for (const double start : {-0.02, 0.0, 0.013, 0.05})
    for (const double duration : {0.007, 0.06, 0.2}) {
      const auto clock = [](double t) { return std::clamp(t, 0.0, 0.16); };
      const Vector3 displacement =
          0.06 * (clock(start + duration) - clock(start)) / 0.04 * shift().normalized();
      const Vector3 mean =
          object.at({0.03, 0.05, 0.02}, {start, start + duration, duration}).velocity;
      measured.row("from " + std::to_string(start) + " s for " + std::to_string(duration) + " s",
                   (duration * mean - displacement).norm() / epsilon);
    }
  return judge_worst(
      measured, 64,
      "up to four intervals, each with a division by its duration and a sum of displacements");
}

Finding rests_outside_its_frames() {
  Table measured{{"case", ""}, {"differences", "1"}};
  const MeshSequence ball = moving_ball(0.06, {0, 0.04});
  for (const BetweenFrames between : {BetweenFrames::blended, BetweenFrames::carried}) {
    const DeformingBody body = make_deforming_body(ball, coarse_sampling(), between);
    double wrong = 0;
    for (const Vector3& p : points_within(0.3)) {
      const DeformingPoint before = deforming_at(body, p, -0.01),
                           after = deforming_at(body, p, 0.04);
      wrong += before.phi != body.frames.front().field.at(p).phi || before.velocity.norm() != 0;
      wrong += after.phi != body.frames.back().field.at(p).phi || after.velocity.norm() != 0;
    }
    measured.row(between == BetweenFrames::blended ? "blended" : "carried", wrong);
  }
  return judge_worst(measured, 0, "no arithmetic: the first frame's and the last one's own values");
}

Finding sequences_are_read() {
  Table measured{{"case", ""}, {"differences, and refusals without their reason", "1"}};
  const ScratchFolder folder;
  const MeshSequence ball = turning_ball(0.3, 1);
  const auto accepts = [&](double interval, const std::string& words) {
    return !is_rejected([&] { read_mesh_sequence({folder.file("."), interval}); }, words);
  };
  measured.row("no files", accepts(0.04, "holds no frame"));
  write_obj(folder.file("b0001.obj"), ball.positions[1], ball.triangles);
  write_obj(folder.file("b0000.obj"), ball.positions[0], ball.triangles);
  const MeshSequence read = read_mesh_sequence({folder.file("."), 0.04});
  measured.row("positions, bit for bit",
               !(read.positions == ball.positions && read.times == ball.times));
  measured.row("no interval", accepts(-0.04, "must be positive"));
  const TriangleMesh other = make_icosphere(radius, 2);
  write_obj(folder.file("b0002.obj"), other.rest, other.triangles);
  measured.row("other triangles", accepts(0.04, "b0002.obj"));
  MeshSequence back = ball;
  back.times = {0.04, 0.04};
  const auto go_back = [&] {
    make_deforming_body(back, coarse_sampling(), BetweenFrames::carried);
  };
  measured.row("times that do not rise", !is_rejected(go_back, "must rise"));
  return judge_worst(measured, 0, "17 digits keep every bit; each refusal must name its reason");
}

}  // namespace

std::vector<Check> deforming_checks() {
  const char* const source = "BMF03 section 5.1";
  return {
      {"deforming.carried-ball-keeps-its-shape",
       "Interpolated along its motion a ball keeps its shape between frames, however far it moves.",
       source, carried_ball_keeps_its_shape},
      {"deforming.blended-ball-shrinks-as-derived",
       "Interpolated at the point, a ball of radius R that moves by d shrinks to sqrt(R^2 - d^2/4) "
       "across its motion, and vanishes beyond two radii.",
       source, blended_ball_shrinks},
      {"deforming.velocity-matches-the-nearest-surface-point",
       "Inside and outside alike, the velocity is that of the nearest surface point: constant "
       "along N.",
       source, velocity_is_that_of_the_surface},
      {"deforming.reused-nodes-err-within-their-bound",
       "A frame's values are exact in the band; beyond it, values kept from the previous frame err "
       "by at most half of a cell's tolerance there and have the right sign, however far the body "
       "moved.",
       source, kept_nodes_err_as_bounded},
      {"deforming.far-nodes-are-not-searched",
       "Where the body moves little, nearest points are searched in the band only.", source,
       far_nodes_are_not_searched},
      {"deforming.points-move-with-the-body",
       "The mean velocity over an interval moves a point with the body, even across frames.",
       source, points_ride_along},
      {"deforming.body-rests-outside-its-frames",
       "Before its first frame and after its last a body rests.", source, rests_outside_its_frames},
      {"deforming.sequences-are-read",
       "A folder of OBJ files is read as written, and a folder without a sequence is refused.",
       source, sequences_are_read}};
}

}  // namespace foldproof
