// Nonlinear damping of the angle's rate; and whether a sculpted shape recovers.
#include "reference/mesh/shapes.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/check.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

using Matrix12 = Eigen::Matrix<double, 12, 12>;
using Vector12 = Eigen::Matrix<double, 12, 1>;

constexpr double stencil = 0.37;   // half width of the differences [m/s]
constexpr double rate_scale = 23;  // rate at which the cubic part equals the linear one [rad/s]

/// A damping law: forces for the velocities v of a hinge's corners, a cubic polynomial in v [N].
using Law = std::function<Vector12(const Vector12& v)>;

/// dF/dv by five-point central differences, which are exact for cubic polynomials, and their
/// rounding.
struct Jacobian {
  Matrix12 matrix = Matrix12::Zero();  // N s/m
  double rounding = 0;  // epsilon times the largest |F| of the stencil over its width [N s/m]
};

Jacobian jacobian_of(const Law& law, const Vector12& v) {
  Jacobian result;
  Worst largest;
  for (int k = 0; k < 12; ++k) {
    const Vector12 one = stencil * Vector12::Unit(k), two = 2 * one;
    const Vector12 near_ahead = law(v + one), near_behind = law(v - one);
    const Vector12 far_ahead = law(v + two), far_behind = law(v - two);
    result.matrix.col(k) =
        (8 * (near_ahead - near_behind) - (far_ahead - far_behind)) / (12 * stencil);
    for (const Vector12& f : {near_ahead, near_behind, far_ahead, far_behind})
      largest.observe(f.norm());
  }
  result.rounding = epsilon * largest.value() / stencil;
  return result;
}

Vector12 stack(const std::array<Vector3, 4>& vectors) {
  Vector12 result;
  for (int k = 0; k < 4; ++k) result.segment<3>(3 * k) = vectors[k];
  return result;
}

/// The subject's linear damping, stiffened with the square of the true rate d(theta)/dt: by the
/// same factor for all four corners.
Law stiffened_together(const Probe& probe, const State& s, const Vector12& gradient) {
  return [&probe, &s, gradient](const Vector12& v) {
    const double part = gradient.dot(v) / rate_scale;
    const PerParticle3 f = probe.damping(s, v.reshaped(3, 4));
    return Vector12((1 + part * part) * f.reshaped());
  };
}

/// The same, each corner by its own part of the rate.
Law stiffened_one_by_one(const Probe& probe, const State& s, const Vector12& gradient) {
  return [&probe, &s, gradient](const Vector12& v) {
    PerParticle3 f = probe.damping(s, v.reshaped(3, 4));
    for (int k = 0; k < 4; ++k) {
      const double part = gradient.segment<3>(3 * k).dot(v.segment<3>(3 * k)) / rate_scale;
      f.col(k) *= 1 + part * part;
    }
    return Vector12(f.reshaped());
  };
}

double relative_asymmetry(const Matrix12& J) {
  return (J - J.transpose()).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / J.cwiseAbs().maxCoeff();
}

/// Largest eigenvalue of the symmetric part [N s/m]; at most 0 if the rule dissipates more as v
/// grows.
double largest_eigenvalue(const Matrix12& J) {
  const Matrix12 symmetric = (J + J.transpose()) / 2;
  return oracles::symmetric_eigenvalues(symmetric)[11];
}

Finding nonlinear_damping_stays_symmetric(const Subject& subject) {
  Table measured = roundings_of("largest |F| over the differences' width, thinness");
  measured.add({"cubic part over the linear one", "1"});
  measured.add({"corner by corner", "1"});
  for (Specimen& hinge : hinges_of_all_angles()) {
    hinge.scene.bending = damped_bending_variants()[0];
    const Probe probe(subject, hinge.scene);
    const Corners x = corners_of(hinge.scene.mesh.hinges[0], hinge.state.x);
    const Vector12 gradient = stack(oracles::theta_gradient_autodiff(x).value),
                   v = hinge.state.v.reshaped();
    const Jacobian together = jacobian_of(stiffened_together(probe, hinge.state, gradient), v);
    const double unit = together.rounding * aspect_ratio(x);
    Worst worst;
    worst.observe(relative_asymmetry(together.matrix) * together.matrix.cwiseAbs().maxCoeff() /
                  unit);
    // negative where there is nothing to see
    worst.observe(largest_eigenvalue(together.matrix) / (12 * unit));
    measured.row(hinge.name, worst.value(), std::pow(gradient.dot(v) / rate_scale, 2),
                 relative_asymmetry(
                     jacobian_of(stiffened_one_by_one(probe, hinge.state, gradient), v).matrix));
  }
  return judge_worst(
      measured, "measured", 64,
      "an entry is a difference of forces of about forty roundings each, magnified by the "
      "triangles' thinness",
      "The law is the subject's damping times 1 + (rate/" + std::to_string(int(rate_scale)) +
          " rad/s)^2, the rate by exact differentiation: symmetric only if the forces point along "
          "its gradient. Corner by corner: asymmetry over the largest entry when each corner is "
          "stiffened by its own share of the rate. Positive eigenvalues, where there are any, "
          "count as asymmetry does.");
}

/// A flat sheet with the rest angles of pleats: unfolded, free, damped, without gravity.
Scene unfolded_pleats(double rest_share) {
  constexpr double angle = 1.1;  // between neighbouring panels [rad]
  Scene scene = scene_at_rest(make_sheet({SheetPattern::union_jack, 0.24, 0.09, 8, 3}), 0.19);
  scene.rest_angles = hinge_angles(scene.mesh, pleated_positions(scene.mesh, 2, angle));
  for (double& rest : scene.rest_angles) rest *= rest_share;
  scene.stretch = StretchMaterial{7.3, 0.043, 1};
  scene.bending = BendingMaterial{0.0061, 0.0029, Weighting::rest, DampingFactor::edge, "sine"};
  scene.integrator = "C";
  return scene;
}

/// sqrt(sum over the hinges of (theta - theta0)^2) [rad].
double unfolding(const Scene& scene, const PerParticle3& x, const std::vector<double>& angles) {
  double sum = 0;
  for (size_t h = 0; h < scene.mesh.hinges.size(); ++h) {
    const double theta = oracles::hinge_angle_50(corners_of(scene.mesh.hinges[h], x)).value;
    sum += std::pow(theta - angles[h], 2);
  }
  return std::sqrt(sum);
}

/// Unfolding that is left after `duration` [s], over that at the start [1].
double left_after(const Subject& subject, const Scene& scene, const std::vector<double>& angles,
                  double duration) {
  Stepper stepper(subject, scene, scene.integrator);
  const State start = stepper.start();
  const int steps = int(std::ceil(duration / (0.5 * elastic_limit(build_system(scene), start))));
  const State end = stepper.run(start, duration / steps, steps);
  return unfolding(scene, end.x, angles) / unfolding(scene, start.x, angles);
}

Finding unfolded_pleats_return(const Subject& subject) {
  const Scene scene = unfolded_pleats(1);
  Table left("time [s]; left of the unfolding [1]; left with rest angles of zero [1]");
  for (const double time : {0.1, 0.3, 1.0})
    left.row(time, left_after(subject, scene, scene.rest_angles, time),
             left_after(subject, unfolded_pleats(0), scene.rest_angles, time));
  return {{left.numbers("left of the unfolding").back(), 0.01, 0, "1",
           "the rest decays exponentially; a hundredth separates a shape that returns from one "
           "that stays or goes elsewhere"},
          left,
          "The sheet starts flat and free; its rest angles are those of pleats. Measured over all "
          "hinges, as the root of the sum of squares of theta - theta0, over that at the start."};
}

}  // namespace

std::vector<Check> bending_shape_checks() {
  return {{"bending.nonlinear-damping-stays-symmetric",
           "A damping that grows with the cube of the angle's rate, alike for all four forces, has "
           "a symmetric Jacobian without a positive eigenvalue.",
           "BMF03 section 4", nonlinear_damping_stays_symmetric},
          {"bending.flattened-pleats-fold-back",
           "A sheet with the rest angles of pleats, held flat and released, folds back into them.",
           "BMF03 section 4", unfolded_pleats_return}};
}

}  // namespace foldproof
