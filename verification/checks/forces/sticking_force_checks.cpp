// The forces of sticking against their definition in 50 digits, what they conserve, how they fade.
#include <fmt/format.h>

#include "reference/dynamics/system.h"
#include "reference/forces/degenerate.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/sticking_scenes.h"

namespace foldproof {

namespace {

std::vector<StuckSpecimen> all_specimens() {
  std::vector<StuckSpecimen> all = stuck_layers();
  all.push_back(stuck_to_turning_surface());
  return all;
}

/// A rounding of a position, as a force [N].
double force_rounding(const StuckSpecimen& specimen) {
  return epsilon * specimen.patch().stiffness * extent(specimen.state.x);
}

const std::string some_roundings =
    "positions are good to a rounding of their size; a target is a sum of a dozen rounded terms, "
    "magnified by the triangles' thinness of up to 3";

Finding force_finding(const Subject& subject) {
  Table measured = roundings_of("of k times the extent");
  for (const StuckSpecimen& specimen : stuck_layers()) {
    const PerParticle3 force = Probe(subject, specimen.scene).elastic(specimen.state);
    measured.row(specimen.name,
                 largest_difference(force, expected_elastic(specimen)) / force_rounding(specimen));
  }
  return judge_worst(measured, 64, some_roundings);
}

Finding energy_finding(const Subject& subject) {
  Table measured = roundings_of("of k far times the extent, a particle");
  for (const StuckSpecimen& specimen : all_specimens()) {
    const double difference =
        Probe(subject, specimen.scene).energy(specimen.state) - expected_energy(specimen);
    measured.row(specimen.name,
                 std::abs(difference) / (force_rounding(specimen) * specimen.patch().far *
                                         double(specimen.stuck.size())));
  }
  return judge_worst(measured, 64, some_roundings);
}

Finding damping_finding(const Subject& subject) {
  Table measured = roundings_of("of the largest entry");
  for (const StuckSpecimen& specimen : all_specimens()) {
    const Eigen::MatrixXd D = damping_matrix(Probe(subject, specimen.scene), specimen.state),
                          expected = expected_damping(specimen);
    const double scale = epsilon * specimen.patch().stiffness * specimen.patch().forecast_time /
                         specimen.patch().far * extent(specimen.state.x);
    measured.row(specimen.name, largest_entry(D - expected) / scale);
  }
  return judge_worst(measured, 64,
                     "k depends on the distance, good to a rounding of positions over far; the "
                     "matrix, G^T G, on frames as the force does",
                     "The expected matrix is -k tau_s G^T G: symmetric, and it can only resist.");
}

Finding resists_finding(const Subject& subject) {
  Table measured = roundings_of("of the largest eigenvalue");
  for (const StuckSpecimen& specimen : all_specimens()) {
    const Eigen::MatrixXd D = damping_matrix(Probe(subject, specimen.scene), specimen.state);
    const Eigen::VectorXd values = oracles::symmetric_eigenvalues((D + D.transpose()) / 2);
    const double largest = values.cwiseAbs().maxCoeff();
    measured.row(specimen.name + ", largest eigenvalue", values.maxCoeff() / (epsilon * largest));
    measured.row(specimen.name + ", asymmetry",
                 largest_entry(D - D.transpose()) / (epsilon * largest));
  }
  return judge_worst(measured, 128,
                     "a rounding of each of the 54 rows and columns that an eigenvalue sums over");
}

Finding momentum_finding(const Subject& subject) {
  Table measured = roundings_of("of the sum of the forces");
  for (const StuckSpecimen& specimen : stuck_layers()) {
    const Probe probe(subject, specimen.scene);
    measured.row(specimen.name + ", elastic", net_force(probe.elastic(specimen.state)));
    measured.row(specimen.name + ", damping",
                 net_force(probe.damping(specimen.state, specimen.state.v)));
  }
  return judge_worst(
      measured, 32,
      "weights sum to 1 and slopes to 0 within a rounding each, and a dozen products are summed");
}

/// The sum of x_i x F_i about the origin.
Vector3 torque_of(const PerParticle3& x, const PerParticle3& f) {
  Vector3 sum = Vector3::Zero();
  for (Eigen::Index i = 0; i < x.cols(); ++i) sum += Vector3(x.col(i)).cross(Vector3(f.col(i)));
  return sum;
}

/// sum k tau_s (x - x_t) x (v_t - v).
Vector3 expected_torque(const StuckSpecimen& specimen) {
  Vector3 sum = Vector3::Zero();
  for (size_t k = 0; k < specimen.stuck.size(); ++k) {
    const oracles::StickingAnswer answer = oracles::sticking_answer(specimen.stuck[k]);
    const std::vector<int>& particles = specimen.particles[k];
    Vector3 approach = -specimen.state.v.col(particles[0]);
    for (size_t j = 1; j < particles.size(); ++j)
      approach += answer.derivative.block<3, 3>(0, Eigen::Index(3 * (j - 1))) *
                  specimen.state.v.col(particles[j]);
    const Vector3 arm = specimen.stuck[k].x - answer.target;
    sum += answer.stiffness * specimen.patch().forecast_time * arm.cross(approach);
  }
  return sum;
}

Finding torque_finding(const Subject& subject) {
  Table measured = roundings_of("of the sum of |x||F|");
  std::vector<double> torques;
  for (const StuckSpecimen& specimen : stuck_layers()) {
    const Probe probe(subject, specimen.scene);
    const PerParticle3& x = specimen.state.x;
    const PerParticle3 elastic = probe.elastic(specimen.state),
                       damping = probe.damping(specimen.state, specimen.state.v);
    const auto size = [&](const PerParticle3& f) {
      return epsilon * x.colwise().norm().dot(f.colwise().norm());
    };
    measured.row(specimen.name + ", elastic", torque_of(x, elastic).norm() / size(elastic));
    measured.row(specimen.name + ", damping",
                 (torque_of(x, damping) - expected_torque(specimen)).norm() / size(damping));
    torques.push_back(expected_torque(specimen).norm() / (size(damping) / epsilon));
  }
  return judge_worst(measured, 64,
                     "the torque's sum is rounded as the forces are; the frames turn with the "
                     "corners, so that nothing else is left",
                     fmt::format("The damping's torque k tau_s (x - x_t) x (v_t - v) is up to "
                                 "{:.2g} of the sum of |x||F|.",
                                 signed_largest(torques)));
}

/// A particle at rest that sticks to the origin, pulled away by d [m].
StuckSpecimen stretched_bonds(double d) {
  StuckSpecimen specimen;
  specimen.scene = scene_at_rest(
      make_triangle_mesh((PerParticle3(3, 3) << 0, 1, 0, 0, 0, 1, 0, 0, 0).finished(), {{0, 1, 2}}),
      0.3);
  StickyPatch patch = palm(specimen.scene, 0.2, Motion{});
  patch.stiffness = 23;
  patch.forecast_time = 0.011;
  patch.near = 0.01;
  patch.far = 0.037;
  specimen.scene.sticky = {patch};
  specimen.state = start_state(specimen.scene);
  specimen.state.x.col(0) = d * Vector3(2, -3, 6) / 7;
  specimen.state.bonds = {{0, 0, 0, Vector3(0, 0.5, 0)}};  // the square's middle
  return specimen;
}

/// Changes of the force and of its slope over `width`, over those allowed by a stiffness k0 and a
/// curvature 8 k0/far: the largest |k0 (1 - r^2)(1 - 5 r^2)| and |k0/far (20 r^3 - 12 r)| for r in
/// [0, 1].
Finding fade_finding(const Subject& subject) {
  Table measured{{"case", ""}, {"change over what is allowed", "1"}};
  const StuckSpecimen one = stretched_bonds(0);
  const Probe probe(subject, one.scene);
  const double far = one.patch().far, k = one.patch().stiffness;
  const auto force = [&](double d) {
    return probe.elastic(stretched_bonds(d).state).col(0).norm();
  };
  for (const double width : {1e-2, 1e-3, 1e-4}) {
    const double step = width * far;
    Worst first, second;
    for (double d = 0.9 * far; d < 1.05 * far; d += step) {
      const double f0 = force(d), f1 = force(d + step), f2 = force(d + 2 * step);
      first.observe(std::abs(f1 - f0) / (k * step));
      second.observe(std::abs(f2 - 2 * f1 + f0) / (8 * k / far * step * step));
    }
    measured.row(fmt::format("force over {} of far", width), first.value());
    measured.row(fmt::format("slope over {} of far", width), second.value());
  }
  measured.row(
      "force half way over its largest share .286 k far",
      std::abs(force(far / std::sqrt(5.0)) / (k * far * 16 / 25 / std::sqrt(5.0)) - 1) / 1e-12);
  return judge_worst(
      measured, 1 + 1e-6,
      "a force whose slope never jumps changes this little over so short a distance; a jump of the "
      "force or of its slope grows without bound as the distance shrinks");
}

Finding surface_finding(const Subject& subject) {
  const StuckSpecimen specimen = stuck_to_turning_surface();
  const Probe probe(subject, specimen.scene);
  const StickyPatch& patch = specimen.patch();
  PerParticle3 expected = expected_elastic(specimen);
  const PerParticle3 corner_velocities = patch.velocity(specimen.state.time);
  for (size_t k = 0; k < specimen.stuck.size(); ++k) {
    const oracles::StickingAnswer answer = oracles::sticking_answer(specimen.stuck[k]);
    const int i = specimen.particles[k][0];
    Vector3 velocity = Vector3::Zero();
    for (size_t b = 0; b < specimen.stuck[k].corners.size(); ++b) {
      const Triangle& triangle = patch.triangles[size_t(specimen.state.bonds[2 * k + b].triangle)];
      for (size_t c = 0; c < 3; ++c)
        velocity += answer.derivative.block<3, 3>(0, Eigen::Index(9 * b + 3 * c)) *
                    corner_velocities.col(triangle[c]);
    }
    expected.col(i) +=
        answer.stiffness * patch.forecast_time * (velocity - specimen.state.v.col(i));
  }
  const PerParticle3 force =
      probe.elastic(specimen.state) + probe.damping(specimen.state, specimen.state.v);
  Table measured = roundings_of("of k times the extent");
  measured.row(specimen.name, largest_difference(force, expected) / force_rounding(specimen));
  return judge_worst(measured, 64, some_roundings);
}

Finding derivative_finding(const Subject& subject) {
  Table measured{{"case", ""}, {"largest difference over the largest entry", "1"}};
  for (StuckSpecimen specimen : all_specimens())
    for (const double tau : {0.019, 0.0}) {
      specimen.scene.sticky[0].forecast_time = tau;
      const Probe probe(subject, specimen.scene);
      const Eigen::MatrixXd expected =
          differences_of_forces(probe, specimen.state, 1e-4 * specimen.patch().far);
      const double size = largest_entry(expected);
      measured.row(
          fmt::format("{}, tau_s = {} s", specimen.name, tau),
          largest_entry(force_derivative(specimen.scene, specimen.state) - expected) / size);
    }
  return judge_worst(
      measured, 1e-6,
      "differences over 1e-4 of far, extrapolated: their error is of fourth order, 1e-8 here with "
      "roundings of 1e-12 over the step; a missing term is of order 1");
}

Finding bound_finding(const Subject& subject) {
  Table measured{{"case", ""}, {"largest eigenvalue over its bound", "1"}};
  for (StuckSpecimen specimen : all_specimens()) {
    specimen.scene.sticky[0].forecast_time = 0.017;
    const Probe probe(subject, specimen.scene);
    const System system = build_system(specimen.scene);
    const Eigen::VectorXd root =
        system.inverse_mass.cwiseSqrt().transpose().replicate(3, 1).reshaped();
    const auto largest = [&](const Eigen::MatrixXd& matrix) {
      const Eigen::MatrixXd scaled =
          root.asDiagonal() * (matrix + matrix.transpose()) * root.asDiagonal() / -2;
      return oracles::symmetric_eigenvalues(scaled).maxCoeff();
    };
    Work uncounted;
    const DampingOperator damping = *damping_at(system.forces, specimen.state, uncounted);
    measured.row(specimen.name + ", damping", largest(damping_matrix(probe, specimen.state)) /
                                                  damping_rate_bound(damping, system.inverse_mass));
    specimen.scene.sticky[0].forecast_time = 0;
    const double omega = frequency_bound(system.forces, specimen.state, system.inverse_mass);
    measured.row(specimen.name + ", stiffness",
                 largest(force_derivative(specimen.scene, specimen.state)) / (omega * omega));
  }
  return judge_worst(measured, 1 + 1e-12,
                     "Gershgorin: no eigenvalue exceeds the largest row sum of the blocks' norms; "
                     "where no particle shares a bond it is that sum, to roundings");
}

Finding beyond_reach_finding(const Subject& subject) {
  Table measured{{"case", ""}, {"largest force [N] or entry of its derivative [N/m]", "N or N/m"}};
  for (StuckSpecimen specimen : stuck_layers()) {
    specimen.scene.sticky[0].forecast_time = 0;
    for (const std::vector<int>& bond : specimen.particles)
      specimen.state.x.col(bond[0]) += 2.3 * specimen.patch().far * Vector3(0.6, 0.48, 0.64);
    const PerParticle3 force = Probe(subject, specimen.scene).elastic(specimen.state);
    measured.row(specimen.name + ", force", largest_entry(force));
    measured.row(specimen.name + ", derivative",
                 largest_entry(force_derivative(specimen.scene, specimen.state)));
  }
  return judge_worst(
      measured, 0,
      "beyond the distance at which bonds break there is no spring, not even a weak one");
}

/// 0 if `act` throws DegenerateElement naming the particle, else 1.
int is_silent(int particle, const std::function<void()>& act) {
  try {
    act();
  } catch (const DegenerateElement& error) {
    return std::ranges::find(error.particles, particle) == error.particles.end();
  }
  return 1;
}

Finding lost_triangles_finding(const Subject& subject) {
  Table measured{{"case", ""}, {"questions answered without a report", "1"}};
  for (StuckSpecimen specimen : stuck_layers()) {
    const Probe probe(subject, specimen.scene);
    const int particle = specimen.particles[0][0];
    // two corners coincide in the triangle that the first particle sticks to
    PerParticle3& x = specimen.state.x;
    x.col(specimen.particles[0][3]) = x.col(specimen.particles[0][1]);
    measured.row(specimen.name + ", forces",
                 is_silent(particle, [&] { probe.elastic(specimen.state); }));
    measured.row(specimen.name + ", energy",
                 is_silent(particle, [&] { probe.energy(specimen.state); }));
  }
  StickyPatch line;
  line.name = "line";
  line.triangles = {{0, 1, 2}};
  line.place = [](double) -> PerParticle3 {
    return PerParticle3{{0.1, 0.3, 0.5}, {0, 0, 0}, {0, 0, 0}};
  };
  line.particles = {0};
  line.stiffness = 3.7;
  line.near = 0.05;
  line.far = 0.09;
  State s = resting_state(PerParticle3{{0.2}, {0.01}, {0.02}});
  measured.row("a bond about to form", is_silent(0, [&] { Sticking{{line}}.update_bonds(s); }));
  return judge_worst(
      measured, 0,
      "forces, energy and new bonds must throw DegenerateElement naming the particle that sticks");
}

}  // namespace

std::vector<Check> sticking_force_checks() {
  const std::string source = "BMF03 section 6";
  return {{"sticking.force-is-minus-gradient-of-energy",
           "Cloth stuck to cloth: the forces on particles and corners are minus the gradient of "
           "the spring's energy, the target being the mean place in the triangles' frames: 50 "
           "digits, autodiff.",
           source, force_finding},
          {"sticking.energy-is-as-defined",
           "The energy of sticking is the integral of k(d) d over d.", source, energy_finding},
          {"sticking.damping-is-as-defined",
           "What forecasts add is -k tau_s G^T G, G the derivative of target less particle: 50 "
           "digits, autodiff.",
           source, damping_finding},
          {"sticking.damping-dissipates",
           "The damping of sticking is symmetric and takes energy from every motion.",
           "our reading of BMF03 section 6", resists_finding},
          {"sticking.a-moving-surface-pulls-with-its-velocity",
           "A target on a surface that turns and drifts pulls with the surface's velocity: the "
           "whole force is k (x_t + tau_s v_t - x - tau_s v).",
           source, surface_finding},
          {"sticking.linear-momentum-is-conserved",
           "Cloth stuck to cloth exchanges equal and opposite impulses.", "Newton's third law",
           momentum_finding},
          {"sticking.only-damping-exerts-torque",
           "The spring exerts no torque, and the damping k tau_s (x - x_t) x (v_t - v).",
           "our reading of BMF03 section 6", torque_finding},
          {"sticking.force-fades-without-a-jump",
           "Neither the force nor its slope jumps at the distance at which bonds break.", source,
           fade_finding},
          {"sticking.differential-matches-forces",
           "The reference's derivative of sticking forces by the positions is that of the "
           "subject's forces.",
           "calculus; the fully implicit methods need it", derivative_finding},
          {"sticking.force-ends-where-bonds-break",
           "Beyond the distance at which bonds break a particle feels no force, and moving it does "
           "not change that.",
           source, beyond_reach_finding},
          {"sticking.degenerate-triangles-are-reported",
           "A triangle that is stuck to and has lost its area is reported with the particle that "
           "sticks to it.",
           "a rule of this suite: nothing fails in silence", lost_triangles_finding},
          {"sticking.frequency-and-damping-bounds-hold",
           "The reference's bounds on frequencies and damping rates hold where cloth sticks.",
           "Gershgorin 1931", bound_finding}};
}

}  // namespace foldproof
