// Hinges bent sharply, to both sides, and about angles that are not those of the rest shape.

#include "reference/mesh/shapes.h"
#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/strips.h"

namespace foldproof {

namespace {

using namespace suite;

constexpr StripShape shape{4, 6, 0.05};
constexpr long steps = 4;

PortableScene flat_strip() {
  return free_strip(shape, {.young = 60, .bending_rigidity = 3e-3}, 2e-4);
}

/// By which the half beyond the middle row turns back, over the time [N m].
double moment_of(Trial& trial, PortableScene scene, const Vector3& away) {
  scene.x.colwise() += away;
  const PerParticle3 v =
      momentum_velocities(scene, trial.after(scene, steps).v, trial.declaration());
  return angular_momentum(scene, v, 1, shape.row_height() / 4, away) / (double(steps) * scene.dt);
}

double moment_beyond_rounding(Trial& trial, const PortableScene& scene) {
  return beyond_rounding(trial, "a moment [N m]", 0.05,
                         [&](const Vector3& away) { return moment_of(trial, scene, away); });
}

/// Throws FailedWithoutNumber unless a strip that is bent up turns back.
void require_opening(double moment) {
  if (!(moment > 0))
    throw FailedWithoutNumber("a strip that is bent up does not turn back, but on",
                              "a moment: angles other than at rest must turn back");
}

/// At rest, folded along its middle row, up for angles > 0 [rad].
PortableScene folded_strip(double angle) {
  PortableScene scene = flat_strip();
  scene.name = fmt::format("strip folded by {:.0f} degrees", angle * 180 / pi);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double y = scene.mesh.rest(1, i);
    scene.x(1, i) = y * std::cos(angle / 2);
    scene.x(2, i) = std::abs(y) * std::sin(angle / 2);
  }
  return scene;
}

constexpr double small = 0.12;  // rad

/// Moments in use grow as the angle, sin(theta/2), sin(theta) or tan(theta/2).
Finding sharp_folds_resist(Trial& trial) {
  const double first = moment_beyond_rounding(trial, folded_strip(small)) / small;
  require_opening(first);
  Table measured = table_of(
      "angle [degrees] | moment over the angle [that of a small one] | at least [1] | at most [1] "
      "| "
      "beyond [1]");
  for (const double angle : {0.7, drawn("fold beyond 60 degrees", 1.1, 1.25), 1.6, 2.1, 2.6}) {
    const double now = moment_beyond_rounding(trial, folded_strip(angle)) / angle / first;
    const double least = std::sin(angle) / angle, most = 2 * std::tan(angle / 2) / angle;
    measured.row(angle * 180 / pi, now, least, most, std::max(least / now, now / most));
    require_opening(now);
  }
  return judge_worst(measured, 1.18,
                     "moments in use grow as the sine of the angle or faster, and not faster than "
                     "the tangent of its half; the fold opens meanwhile, as fast in all");
}

Finding both_sides_resist_alike(Trial& trial) {
  Table measured =
      table_of("angle [degrees] | moment up [N m] | moment down [N m] | sum [of the first]");
  for (const double angle : {small, drawn("fold to both sides", 0.6, 0.9), 1.9}) {
    const double up = moment_beyond_rounding(trial, folded_strip(angle)),
                 down = moment_beyond_rounding(trial, folded_strip(-angle));
    measured.row(angle * 180 / pi, up, down, std::abs((up + down) / up));
  }
  return judge_worst(measured, 0.02, "mirror images, and rounding of single precision");
}

std::vector<double> angles_of(const PortableScene& scene) {
  std::vector<double> angles;
  for (const Hinge& hinge : scene.mesh.hinges) {
    const auto at = [&](int k) { return Vector3(scene.x.col(hinge.particles[size_t(k)])); };
    const Vector3 n1 = (at(0) - at(2)).cross(at(0) - at(3)),
                  n2 = (at(1) - at(3)).cross(at(1) - at(2)), e = (at(3) - at(2)).normalized();
    angles.push_back(std::atan2(n1.cross(n2).dot(e), n1.dot(n2)));
  }
  return angles;
}

constexpr double curvature = 1.1;  // 1/m

PortableScene bent_strip(double by) {
  PortableScene scene = flat_strip();
  bend(scene, 1, by);
  return scene;
}

/// Flat, as long as its chords.
PortableScene strip_of_bent_rest() {
  PortableScene scene = flat_strip();
  scene.name = "flat strip of a bent rest shape, with rest angles 0";
  const double turn = curvature * shape.row_height();
  scene.x.row(1) *= 2 / turn * std::sin(turn / 2);
  scene.mesh.rest = bent_strip(curvature).x;
  return scene;
}

PortableScene of_its_rest(PortableScene scene) {
  PortableScene rest = scene;
  rest.x = scene.mesh.rest;
  scene.rest_angles = angles_of(rest);
  return scene;
}

Finding rest_angles_count(Trial& trial) {
  PortableScene with_angles = flat_strip();
  with_angles.name = "flat strip with rest angles";
  with_angles.rest_angles = angles_of(bent_strip(curvature));
  const double bent = (moment_beyond_rounding(trial, bent_strip(-curvature)) -
                       moment_beyond_rounding(trial, bent_strip(curvature))) /
                      2;
  require_opening(-bent);
  Table measured = table_of(
      "strip | moment [N m] | expected [N m] | difference [of a bent strip's; a tenth of it "
      "folded]");
  const auto row = [&](const char* name, const PortableScene& scene, double expected) {
    const double moment = moment_beyond_rounding(trial, scene);
    measured.row(name, moment, expected, std::abs((moment - expected) / bent));
  };
  row("flat, with rest angles", with_angles, bent);
  PortableScene at_its_angles = bent_strip(curvature);
  at_its_angles.rest_angles = with_angles.rest_angles;
  row("bent, with those rest angles", at_its_angles, 0);
  row("flat, of a bent rest shape, without rest angles", strip_of_bent_rest(), 0);
  row("flat, of a bent rest shape, with its rest angles", of_its_rest(strip_of_bent_rest()), bent);
  const double fold = drawn("fold at rest", 0.7, 1.0),
               blunt = moment_beyond_rounding(trial, folded_strip(small));
  PortableScene folded = folded_strip(fold + small);
  folded.mesh.rest = folded_strip(fold).x;
  const double beyond = moment_beyond_rounding(trial, of_its_rest(folded));
  // the stiffness of hinges in use, there: cos(fold) to 1/cos(fold/2)^2 of that when flat
  measured.row("folded beyond a fold at rest", beyond, blunt, std::abs(beyond / blunt - 1) / 10);
  return judge_worst(measured, 0.05,
                     "a moment depends on angle minus rest angle; bent by 0.15 rad, arms are "
                     "shorter by 1 %, and steps add the rest (empirical)");
}

/// Rows of 0.5 to 1.5 times their height, from end to end.
PortableScene graded_strip() {
  PortableScene scene = flat_strip();
  scene.name = "strip of graded rows";
  const double length = shape.length();
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
    scene.x(1, i) *= 1 + scene.x(1, i) / (2 * length);
  scene.mesh.rest = scene.x;
  scene.mass = lumped_masses(scene.mesh, scene.material.density);
  bend(scene, 1, 0.8);
  return scene;
}

/// Beyond this y of the rest shape [m].
double moment_beyond(Trial& trial, double y) {
  return beyond_rounding(trial, "a moment [N m]", 0.05, [&](const Vector3& away) {
    PortableScene scene = graded_strip();
    scene.x.colwise() += away;
    const PerParticle3 v =
        momentum_velocities(scene, trial.after(scene, steps).v, trial.declaration());
    return angular_momentum(scene, v, 1, y, away) / (double(steps) * scene.dt);
  });
}

Finding graded_rows_resist_alike(Trial& trial) {
  const double fine = moment_beyond(trial, -0.055), coarse = moment_beyond(trial, 0.04);
  require_opening(fine);
  Table measured = table_of(
      "moment across fine rows [N m] | across coarse rows [N m] | difference [of the first]");
  measured.row(fine, coarse, std::abs(coarse / fine - 1));
  return judge_worst(measured, 0.1,
                     "evenly bent, an even strip has the same moment everywhere; hinges of several "
                     "kinds give 2 % between triangles of unequal shape (empirical)");
}

/// Of squares with diagonals, or in no order: inner vertices have three to eight neighbours.
PortableScene bent_sheet_of(SheetPattern pattern) {
  PortableScene scene = flat_strip();
  TriangleMesh mesh = make_sheet({.pattern = pattern,
                                  .width = shape.width(),
                                  .height = shape.length(),
                                  .columns = 4,
                                  .rows = 6,
                                  .seed = 7});
  mesh.rest.row(1).array() -= shape.length() / 2;
  PortableScene sheet = resting("bent sheet of another pattern", std::move(mesh), scene.material);
  sheet.dt = scene.dt;
  bend(sheet, 1, 0.8);
  return sheet;
}

Finding every_pattern_resists(Trial& trial) {
  const double usual = moment_beyond_rounding(trial, bent_strip(0.8));
  require_opening(usual);
  Table measured = table_of(
      "pattern | moment over that of equilateral triangles [1] | farthest from it, as a factor "
      "[1]");
  for (const auto& [name, pattern] : {std::pair("one diagonal", SheetPattern::one_diagonal),
                                      {"alternating diagonals", SheetPattern::alternating},
                                      {"union jack", SheetPattern::union_jack},
                                      {"criss cross", SheetPattern::criss_cross},
                                      {"random Delaunay", SheetPattern::random_delaunay}}) {
    const double ratio = moment_beyond_rounding(trial, bent_sheet_of(pattern)) / usual;
    measured.row(name, ratio, ratio > 0 ? std::max(ratio, 1 / ratio) : 1e9);
  }
  return judge_worst(measured, 1.5,
                     "on regular patterns several kinds of hinges give 0.99 to 1.01, on a random "
                     "one 1.14 (empirical)");
}

//   0 ---- 2,3         0, 2 and 3 are held. The weight m g of 1 bends the hinge by theta, where
//             \\       2 B w theta = m g h cos(theta),   w = 1/sqrt(3), h the triangle's height
//              1
/// At rest in that angle [rad]; its springs stretch by 1 %.
PortableScene weighed_hinge(double angle) {
  const double side = 0.1, height = side * std::sqrt(0.75);  // m
  PerParticle3 corners(3, 4);
  corners << 0, 0, -side / 2, side / 2, -height, height, 0, 0, 0, 0, 0, 0;
  PortableScene scene = resting("hinge bent by a weight",
                                make_triangle_mesh(corners, {{2, 0, 3}, {3, 1, 2}}), {.young = 5});
  scene.gravity = Vector3(0, 0, -9.81);
  scene.material.bending_rigidity =
      scene.mass[1] * 9.81 * height * std::cos(angle) * std::sqrt(3.0) / (2 * angle);
  scene.held = {0, 2, 3};
  scene.x.col(1) = height * Vector3(0, std::cos(angle), -std::sin(angle));
  scene.dt = 0.002;
  return scene;
}

/// The mean angle of two swings or more, twice, three seconds apart.
Finding bends_do_not_creep(Trial& trial) {
  const double angle = drawn("angle of a weighed hinge", 0.85, 0.95);
  const PortableScene scene = weighed_hinge(angle);
  constexpr long stride = 10, samples = 200, window = 50;  // 4 s, of them 1 s
  const std::vector<Snapshot> states = trial.motion(scene, multiples(stride, samples));
  const auto mean_from = [&](long first) {
    double sum = 0;
    for (long k = first; k < first + window; ++k)
      sum += std::atan2(-states[size_t(k)].x(2, 1), states[size_t(k)].x(1, 1)) / double(window);
    return sum;
  };
  const double early = mean_from(0), late = mean_from(samples - window);
  Table measured = table_of(
      "start [rad] | mean angle of the first second [rad] | of the fourth [rad] | change [of the "
      "start]");
  measured.row(angle, early, late, std::abs(late - early) / angle);
  return judge_worst(measured, 0.05,
                     "the mean of a swing that fades moves by the square of its amplitude, of a "
                     "tenth where the hinge is a fifth too soft");
}

}  // namespace

std::vector<Law> hinge_laws() {
  return {
      {"bending.sharp-folds-resist",
       "Folds of 40 to 150 degrees open, by the moment that some hinge in use has there.",
       "Newton's second law of half a folded strip", sharp_folds_resist, "bending",
       "angle | moment over the angle"},
      {"bending.both-sides-resist-alike", "Folds to the front and to the back open alike.",
       "mirror symmetry", both_sides_resist_alike, "bending", "angle | sum"},
      {"bending.rest-angles-are-those-of-the-scene",
       "Hinges are bent from the scene's rest angles, whatever the rest shape and the start.",
       "protocol: 'rest_angles'", rest_angles_count, "bending", "strip | moment | expected"},
      {"bending.every-pattern-resists",
       "Sheets of any pattern of triangles resist bending, within a factor of 3 of equilateral "
       "ones.",
       "protocol: 'hinges'", every_pattern_resists, "bending",
       "pattern | moment over that of equilateral triangles"},
      {"bending.bends-do-not-creep",
       "A hinge that a weight bends by 50 degrees bears it for 4 s: no crease forms.",
       "equilibrium; protocol: 'rest_angles'", bends_do_not_creep, "bending held",
       "mean angle of the first second | of the fourth"},
      {"bending.graded-rows-resist-alike",
       "An evenly bent strip has the same moment across fine rows of triangles as across coarse "
       "ones.",
       "equilibrium; protocol: 'hinge_weights'", graded_rows_resist_alike, "bending",
       "moment across fine rows | across coarse rows"},
  };
}

}  // namespace foldproof
