#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/check.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/random.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

using Mode = Eigen::Matrix<double, 12, 1>;

/// The motions of a hinge that change no angle, each of length 1: three translations, three
/// rotations, two motions of x1 and two of x2 in the planes of their triangles, one stretch of the
/// edge.
struct Eleven {
  Eigen::Matrix<double, 12, 11> modes;
  static constexpr std::array<const char*, 11> names = {
      "translation x",     "translation y",       "translation z",      "rotation x",
      "rotation y",        "rotation z",          "x1 along the edge",  "x1 towards the edge",
      "x2 along the edge", "x2 towards the edge", "stretch of the edge"};
};

Eleven eleven_modes(const Corners& x) {
  const Vector3 e = (x[3] - x[2]).normalized(), centre = (x[0] + x[1] + x[2] + x[3]) / 4;
  Eleven eleven;
  eleven.modes.setZero();
  for (int axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < 4; ++corner) {
      eleven.modes.col(axis).segment<3>(3 * corner) = Vector3::Unit(axis);
      eleven.modes.col(3 + axis).segment<3>(3 * corner) =
          Vector3::Unit(axis).cross(x[corner] - centre);
    }
  }
  for (int corner = 0; corner < 2; ++corner) {
    const Vector3 arm = x[corner] - x[2], across = arm - arm.dot(e) * e;
    eleven.modes.col(6 + 2 * corner).segment<3>(3 * corner) = e;
    eleven.modes.col(7 + 2 * corner).segment<3>(3 * corner) = across;
  }
  eleven.modes.col(10).segment<3>(6) = -e;
  eleven.modes.col(10).segment<3>(9) = e;
  eleven.modes.colwise().normalize();
  return eleven;
}

Mode reference_mode(const Corners& x) {
  return bending_mode(hinge_shape(x[0], x[1], x[2], x[3])).reshaped();
}

Mode stack(const std::array<Vector3, 4>& vectors) {
  Mode mode;
  for (int k = 0; k < 4; ++k) mode.segment<3>(3 * k) = vectors[k];
  return mode;
}

std::vector<Corners> shapes() {
  std::vector<Corners> list;
  for (const Specimen& hinge : hinges_of_all_angles())
    list.push_back(corners_of(hinge.scene.mesh.hinges[0], hinge.state.x));
  return list;
}

Finding mode_is_orthogonal() {
  std::array<Worst, 11> worst;
  for (const Corners& x : shapes()) {
    const Eleven eleven = eleven_modes(x);
    const Mode u = reference_mode(x);
    for (int m = 0; m < 11; ++m) {
      worst[m].observe(std::abs(u.dot(eleven.modes.col(m))) /
                       (epsilon * u.norm() * aspect_ratio(x)));
    }
  }
  Table measured = roundings_of("|u| thinness");
  for (int m = 0; m < 11; ++m) measured.row(Eleven::names[m], worst[m].value());
  return judge_worst(measured, 32,
                     "u, a normalised motion and their scalar product take fewer than 32 roundings "
                     "each of |u|, magnified by the triangles' thinness");
}

Finding mode_is_the_only_one() {
  Table measured = roundings_of("thinness over the eleventh singular value");
  measured.add({"smallest over largest singular value", "1"});
  for (const Corners& x : shapes()) {
    const oracles::SingularParts parts = oracles::singular_parts(eleven_modes(x).modes.transpose());
    const double smallest = parts.values[10] / parts.values[0];
    const Mode u = reference_mode(x).normalized(), alone = parts.V.col(11);
    const double sine = (u - u.dot(alone) * alone).norm();
    const bool several = !(smallest > 1e-4);  // otherwise the eleven would not be independent
    measured.row("hinge " + std::to_string(measured.rows() + 1),
                 several ? nan : sine * smallest / (epsilon * aspect_ratio(x)), smallest);
  }
  return judge_worst(measured, "measured", 64,
                     "the null vector of the eleven moves by their roundings, fewer than 64, over "
                     "their smallest singular value",
                     "A smallest singular value of 1e-4 or less would mean that the eleven are not "
                     "independent: it counts as NaN.");
}

Finding mode_is_minus_gradient() {
  Table measured = roundings_of("|u| thinness");
  measured.add({"the same against 50-digit differences", "epsilon |u| thinness"});
  measured.add({"d(theta)/dt of a random motion", "rad/s"});
  measured.add({"u.v of the same motion", "rad/s"});
  Random random(907);
  for (const Corners& x : shapes()) {
    const Mode u = reference_mode(x);
    const double unit = epsilon * u.norm() * aspect_ratio(x);
    const auto gradient = oracles::theta_gradient_autodiff(x);
    const auto differences = oracles::theta_gradient_differences(x);
    const oracles::Estimate off{(u + stack(gradient.value)).norm() / unit,
                                4 * gradient.uncertainty / unit};
    const PerParticle3 v = random.vectors(4, 0.8);
    const auto rate = oracles::theta_rate_autodiff(x, {v.col(0), v.col(1), v.col(2), v.col(3)});
    measured.row("hinge " + std::to_string(measured.rows() + 1), off,
                 (u + stack(differences.value)).norm() / unit, rate.value, u.dot(v.reshaped()));
  }
  return judge_worst(measured, "measured", 32,
                     "u takes fewer than 32 roundings, magnified by the triangles' thinness",
                     "The printed line d(theta)/dt = u.v has the wrong sign: d(theta)/dt = -u.v, "
                     "as the last two columns show. The printed forces are right.");
}

/// Position of the foot of p along the edge: 1 at x3, 0 at x4.
long double foot(const Corners& x, const Vector3& p) {
  const Eigen::Matrix<long double, 3, 1> from4 = p.cast<long double>() - x[3].cast<long double>(),
                                         edge = x[2].cast<long double>() - x[3].cast<long double>();
  return from4.dot(edge) / edge.squaredNorm();
}

/// Distance of p from the line of the edge [m].
double height(const Corners& x, const Vector3& p) {
  const Vector3 edge = x[3] - x[2];
  return (p - x[2]).cross(edge).norm() / edge.norm();
}

Finding weights_are_barycentric(const Subject& subject) {
  Table measured = roundings_of("|f| thinness");
  measured.add({"height of x1 over height of x2", "1"});
  for (Specimen& hinge : hinges_of_all_angles()) {
    hinge.scene.bending = bending_variants()[0];
    const PerParticle3 f = Probe(subject, hinge.scene).elastic(hinge.state);
    const Corners x = corners_of(hinge.scene.mesh.hinges[0], hinge.state.x);
    const double b1 = double(foot(x, x[0])), b2 = double(foot(x, x[1]));
    const Vector3 f3 = -(b1 * f.col(0) + b2 * f.col(1)),
                  f4 = -((1 - b1) * f.col(0) + (1 - b2) * f.col(1));
    const double unit = epsilon * f.norm() * aspect_ratio(x);
    const double moment1 = f.col(0).norm() * height(x, x[0]),
                 moment2 = f.col(1).norm() * height(x, x[1]);
    Worst worst;
    worst.observe((f.col(2) - f3).norm() / unit);
    worst.observe((f.col(3) - f4).norm() / unit);
    worst.observe(std::abs(moment1 - moment2) / (epsilon * aspect_ratio(x) * moment1));
    measured.row(hinge.name, worst.value(), height(x, x[0]) / height(x, x[1]));
  }
  return judge_worst(
      measured, "measured", 32,
      "weights, heights and forces take fewer than 32 roundings, magnified by the thinness");
}

}  // namespace

std::vector<Check> bending_mode_checks() {
  return {{"bending.mode-is-orthogonal-to-the-eleven-others",
           "The reference's bending mode u is orthogonal to translations, rotations, in-plane "
           "motions and the edge's stretch.",
           "BMF03 section 4", mode_is_orthogonal},
          {"bending.mode-is-unique",
           "Nothing but the reference's u is orthogonal to the eleven other modes: their null "
           "space is the line along u.",
           "BMF03 section 4", mode_is_the_only_one},
          {"bending.mode-is-minus-gradient-of-theta",
           "The reference's u is minus the gradient of the angle theta.",
           "BMF03 section 4, with the sign of d(theta)/dt corrected", mode_is_minus_gradient},
          {"bending.mode-weights-are-barycentric",
           "Forces on x1 and x2 fall off with their distance from the edge; those on x3 and x4 are "
           "minus them in barycentric shares.",
           "BMF03 section 4", weights_are_barycentric}};
}

}  // namespace foldproof
