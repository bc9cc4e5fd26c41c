#include <cstdio>

#include "reference/forces/degenerate.h"
#include "verification/specimens/check.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/random.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

std::string in_radians(double angle) {
  char text[40];
  std::snprintf(text, sizeof text, "%.15g rad", angle);
  return text;
}

double sine_of(const Corners& x) { return hinge_shape(x[0], x[1], x[2], x[3]).sin_half; }

/// A hinge in the plane z = 0, exactly flat or (folded) exactly sharp: the second triangle lies on
/// either side of the edge.
Corners planar_hinge(double height2) {
  return {Vector3(0.11, 0.23, 0), Vector3(0.19, height2, 0), Vector3(0.03, 0, 0),
          Vector3(0.37, 0, 0)};
}

Finding sine_is_accurate() {
  Table measured = roundings_of("thinness");
  Random random(421);
  for (const double small : {1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2, 0.3, 1.0, 1.5}) {
    for (const double angle : {small, -small, pi - small, small - pi}) {
      Worst error;
      oracles::Estimate printed;
      for (int repeat = 0; repeat < 3; ++repeat) {
        const Corners x = random_corners(random, angle);
        printed = oracles::sin_half_angle_50(x);
        error.observe(std::abs(sine_of(x) - printed.value) / (epsilon * aspect_ratio(x)));
      }
      measured.row(in_radians(angle),
                   oracles::Estimate{error.value(), printed.uncertainty / epsilon});
    }
  }
  const double flat = sine_of(planar_hinge(-0.17));
  measured.row("exactly flat (must be exactly zero)", flat == 0 ? 0 : INFINITY);
  return judge_worst(measured, 16,
                     "the normals, their products and one root: fewer than 16 roundings of 1, "
                     "magnified by the thinness");
}

Finding angle_is_accurate() {
  Table measured = roundings_of("pi thinness");
  for (const Specimen& hinge : hinges_of_all_angles()) {
    const Corners x = corners_of(hinge.scene.mesh.hinges[0], hinge.state.x);
    const oracles::Estimate theta = oracles::hinge_angle_50(x);
    const double unit = epsilon * pi * aspect_ratio(x);
    measured.row(
        in_radians(theta.value),
        oracles::Estimate{std::abs(hinge_angle(x[0], x[1], x[2], x[3]) - theta.value) / unit,
                          theta.uncertainty / unit});
  }
  return judge_worst(
      measured, 16,
      "sine and cosine of theta take fewer than 16 roundings of 1, magnified by the thinness");
}

/// The hinge of a sweep: axis-aligned, so that only the angle changes.
Corners swept(double angle) {
  return {Vector3(0.11, 0.23, 0), Vector3(0.19, -0.17 * std::cos(angle), -0.17 * std::sin(angle)),
          Vector3(0.03, 0, 0), Vector3(0.37, 0, 0)};
}

/// The largest fall, or rise beyond half the angle's step, from one angle to the next [epsilon].
double worst_unevenness(double first, double last, int count) {
  Worst worst;
  double before = sine_of(swept(first));
  const double step = (last - first) / count;
  for (int i = 1; i <= count; ++i) {
    const double now = sine_of(swept(first + i * step));
    worst.observe((before - now) / epsilon);
    worst.observe((now - before - 0.5 * step) / epsilon);
    before = now;
  }
  return worst.value();
}

Finding sine_rises() {
  Table measured{{"case", ""}, {"largest fall, or rise faster than theta/2", "epsilon"}};
  measured.row("-pi to pi, 20,001 steps", worst_unevenness(-3.14159, 3.14159, 20001));
  measured.row("about -pi", worst_unevenness(-3.1415926535, -3.1415, 1009));
  measured.row("about -pi/2", worst_unevenness(-pi / 2 - 1e-9, -pi / 2 + 1.3e-9, 997));
  measured.row("about 0", worst_unevenness(-1.7e-9, 1.9e-9, 1009));
  measured.row("about pi/2", worst_unevenness(pi / 2 - 1e-9, pi / 2 + 1.3e-9, 997));
  measured.row("about pi", worst_unevenness(3.1415, 3.1415926535, 1013));
  measured.row(
      "whole range left out",
      std::abs(sine_of(swept(3.14159)) - sine_of(swept(-3.14159)) - 2) < 1e-9 ? 0 : INFINITY);
  return judge_worst(measured, 16,
                     "two neighbouring values carry fewer than 16 roundings of 1 between them",
                     "Measured is by how much, at worst, a value of sin(theta/2) lies below the "
                     "one before it or rises by more than half the step of theta, which is its "
                     "steepest slope; exact values would give 0.");
}

Finding sharp_folds_stay_finite(const Subject& subject) {
  Table ratios{{"case", ""}, {"|F| over its limit", "1"}};
  BendingMaterial material = damped_bending_variants()[0];
  std::vector<std::pair<std::string, Corners>> cases = {{"pi exactly", planar_hinge(0.17)}};
  for (const double degrees : {179.0, -179.0, 179.99, -179.99, 179.9999, -179.9999}) {
    Random random(unsigned(std::abs(degrees) * 1e4) + (degrees < 0));
    cases.emplace_back(in_radians(degrees * pi / 180), random_corners(random, degrees * pi / 180));
  }
  for (const auto& [name, x] : cases) {
    Scene scene = hinge_scene(x, 0.83);
    scene.bending = material;
    const Probe probe(subject, scene);
    const State s = state_of(x);
    const PerParticle3 f = probe.elastic(s),
                       damping = probe.damping(s, PerParticle3::Constant(3, 4, 0.7));
    const Eigen::Matrix<double, 3, 4> u = bending_mode(hinge_shape(x[0], x[1], x[2], x[3]));
    const double edge = (x[3] - x[2]).norm();
    const double areas =
        (x[0] - x[2]).cross(x[0] - x[3]).norm() + (x[1] - x[2]).cross(x[1] - x[3]).norm();
    const double limit =
        material.stiffness * edge * edge / areas * (1 + std::sin(0.83 / 2)) * u.norm();
    ratios.row(name, damping.allFinite() ? f.norm() / limit : nan);
  }
  const double excess = signed_largest(ratios.numbers("|F| over its limit")) - 1;
  return {{excess / epsilon, 256, 0, "epsilon of the limit",
           "|sin(theta/2)| is at most 1, however sharp the fold, so |F| is at most the limit ke c "
           "(1 + sin(theta0/2)) |u|, up to the roundings of the dozen products in each"},
          ratios,
          "Measured is the largest |F| less its limit: negative where it stays below. A force or a "
          "damping force that is not finite gives NaN."};
}

Finding rest_angles_give_no_force(const Subject& subject) {
  Table measured = roundings_of("ke c |u| thinness");
  for (Specimen& shape : curved_shapes()) {
    shape.scene.bending = bending_variants()[0];
    const PerParticle3 f = Probe(subject, shape.scene).elastic(shape.state);
    PerParticle scale = PerParticle::Zero(f.cols());
    for (const Hinge& hinge : shape.scene.mesh.hinges) {
      const Corners x = corners_of(hinge, shape.state.x);
      const HingeShape at_rest = hinge_shape(x[0], x[1], x[2], x[3]);
      const double c = at_rest.edge * at_rest.edge / at_rest.area_sum;
      const Eigen::Vector4d u = bending_mode(at_rest).colwise().norm();
      for (int k = 0; k < 4; ++k) scale[hinge.particles[k]] += c * u[k] * aspect_ratio(x);
    }
    const PerParticle relative = f.colwise().norm().transpose().cwiseQuotient(scale);
    measured.row(shape.name, relative.maxCoeff<Eigen::PropagateNaN>() /
                                 (epsilon * shape.scene.bending->stiffness));
  }
  return judge_worst(
      measured, 32,
      "sin(theta/2) by two routes, each good to fewer than 16 roundings of 1 times the thinness");
}

/// Positions at which a triangle has no area.
struct Loss {
  std::string name;
  PerParticle3 x;
  std::vector<int> lost;  // two of these, or the only one, must be named
};

std::vector<Loss> losses(const Scene& scene) {
  const Triangle triangle = scene.mesh.triangles[11];
  const auto [a, b, c] = triangle;
  const std::vector<int> lost(triangle.begin(), triangle.end());
  std::vector<Loss> cases(4, {"", scene.x, lost});
  cases[0].name = "a corner put on the opposite edge";
  cases[0].x.col(c) = 0.3 * scene.x.col(a) + 0.7 * scene.x.col(b);
  cases[1].name = "two corners in one place";
  cases[1].x.col(c) = scene.x.col(b);
  cases[2].name = "a height of 1e-12 of the edge";
  cases[2].x.col(c) =
      scene.x.col(a) + 0.4 * (scene.x.col(b) - scene.x.col(a)) +
      1e-12 * (scene.x.col(c) - scene.x.col(a)).cross(scene.x.col(b) - scene.x.col(a));
  cases[3].name = "a NaN";
  cases[3].x(1, c) = nan;
  cases[3].lost = {c};
  return cases;
}

/// True if `ask` throws an error that names the particles in `lost`.
template <class Ask>
bool is_reported(const Loss& loss, const Ask& ask) {
  try {
    ask();
  } catch (const DegenerateElement& error) {
    long named = 0;
    for (const int particle : error.particles)
      named += std::count(loss.lost.begin(), loss.lost.end(), particle);
    return named >= std::min<long>(2, long(loss.lost.size()));
  }
  return false;
}

Finding lost_triangles_are_reported(const Subject& subject) {
  Table measured{{"case", ""}, {"questions answered without a report", "1"}};
  Specimen sheet = crumpled_sheets()[4];
  sheet.scene.bending = damped_bending_variants()[1];
  const Probe probe(subject, sheet.scene);
  for (const Loss& loss : losses(sheet.scene)) {
    const State s{0, loss.x, sheet.state.v};
    const int silent = !is_reported(loss, [&] { probe.elastic(s); }) + !is_reported(loss, [&] {
      probe.damping(s, s.v);
    }) + !is_reported(loss, [&] { probe.energy(s); });
    measured.row(loss.name, silent);
  }
  return judge_worst(measured, 0,
                     "forces, damping and energy each must throw DegenerateElement naming "
                     "particles of the lost triangle");
}

}  // namespace

std::vector<Check> bending_angle_checks() {
  const char* const section = "BMF03 section 4";
  return {
      {"bending.sine-is-accurate-near-flat-and-near-folded",
       "The reference's sin(theta/2) is good to roundings of 1 from 1e-12 rad to pi - 1e-12 rad, "
       "and exactly 0 when flat.",
       section, sine_is_accurate},
      {"bending.angle-is-accurate",
       "The reference's hinge angle is theta to rounding, signed as printed.", section,
       angle_is_accurate},
      {"bending.sine-rises-monotonically",
       "The reference's sin(theta/2) rises with theta from folded through flat to folded, nowhere "
       "faster than theta/2.",
       section, sine_rises},
      {"bending.force-stays-finite-in-sharp-folds",
       "Folded up to 179.9999 degrees, and to exactly pi, the elastic force stays within ke c (1 + "
       "sin(theta0/2)) |u|.",
       section, sharp_folds_stay_finite},
      {"bending.rest-shape-feels-no-force",
       "A statue, a sphere, a cylinder and pleats feel no bending force in the shape that their "
       "rest angles were taken from.",
       section, rest_angles_give_no_force},
      {"bending.degenerate-triangles-are-reported",
       "A triangle without area is reported with its particles; no NaN leaves the bending forces.",
       "a rule of this suite: nothing fails in silence", lost_triangles_are_reported}};
}

}  // namespace foldproof
