#include "verification/checks/forces/damping_laws.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/check.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

/// A specimen with one of the damped materials.
struct Damped {
  std::string name;
  Specimen specimen;
};

std::vector<Damped> with_damping(const std::vector<Specimen>& specimens) {
  std::vector<Damped> cases;
  for (const Specimen& specimen : specimens) {
    for (const BendingMaterial& material : damped_bending_variants()) {
      cases.push_back({describe(specimen, material), specimen});
      cases.back().specimen.scene.bending = material;
    }
  }
  return cases;
}

/// For each particle the sum over its hinges of kd s max |u| sum |u_j||v_j| times the thinness [N].
PerParticle damping_scale(const Specimen& specimen, const PerParticle3& v) {
  const BendingMaterial& material = *specimen.scene.bending;
  PerParticle scale = PerParticle::Zero(v.cols());
  for (const Hinge& hinge : specimen.scene.mesh.hinges) {
    const Corners x = corners_of(hinge, specimen.state.x);
    const HingeShape shape = hinge_shape(x[0], x[1], x[2], x[3]);
    const double s = material.damping_factor == DampingFactor::edge
                         ? shape.edge
                         : shape.edge * shape.edge / shape.area_sum;
    const Eigen::Vector4d u = bending_mode(shape).colwise().norm();
    double rate = 0;
    for (int k = 0; k < 4; ++k) rate += u[k] * v.col(hinge.particles[k]).norm();
    for (int k = 0; k < 4; ++k)
      scale[hinge.particles[k]] += material.damping * s * u.maxCoeff() * rate * aspect_ratio(x);
  }
  return scale;
}

Finding damping_is_as_defined(const Subject& subject) {
  Table measured = roundings_of("kd s |u| sum |u_j||v_j| thinness");
  for (const Damped& damped : with_damping(sheets_and_hinges())) {
    const Specimen& specimen = damped.specimen;
    const PerParticle3 f = Probe(subject, specimen.scene).damping(specimen.state, specimen.state.v);
    PerParticle3 expected = PerParticle3::Zero(3, f.cols());
    PerParticle uncertainty = PerParticle::Zero(f.cols());
    for (size_t h = 0; h < specimen.scene.mesh.hinges.size(); ++h) {
      const auto force = oracles::bending_damping_50(hinge_input(specimen, h));
      for (int k = 0; k < 4; ++k) {
        const int i = specimen.scene.mesh.hinges[h].particles[k];
        expected.col(i) += force.value[k];
        uncertainty[i] += force.uncertainty + epsilon * expected.col(i).norm();
      }
    }
    const PerParticle unit = epsilon * damping_scale(specimen, specimen.state.v);
    const PerParticle error = (f - expected).colwise().norm().transpose().cwiseQuotient(unit);
    measured.row(damped.name, oracles::Estimate{error.maxCoeff<Eigen::PropagateNaN>(),
                                                uncertainty.cwiseQuotient(unit).maxCoeff()});
  }
  return judge_worst(measured, 64,
                     "a hinge's damping force takes fewer than 64 roundings, magnified by the "
                     "triangles' thinness");
}

Finding damping_dissipates(const Subject& subject) {
  Table powers = no_powers();
  for (const Damped& damped : with_damping(sheets_and_hinges())) {
    const auto [power, share] =
        damping_power_of(Probe(subject, damped.specimen.scene), damped.specimen.state);
    powers.row(damped.name, share, power);
  }
  return dissipation(powers);
}

/// The worst particle's force over epsilon times its scale.
double force_in_roundings(const Probe& probe, const Specimen& specimen, const PerParticle3& v) {
  const PerParticle3 f = probe.damping(specimen.state, v);
  const PerParticle unit = epsilon * damping_scale(specimen, v);
  return f.colwise().norm().transpose().cwiseQuotient(unit).maxCoeff<Eigen::PropagateNaN>();
}

Finding leaves_rigid_motion_alone(const Subject& subject) {
  Table measured = roundings_of("kd s |u| sum |u_j||v_j| thinness");
  for (const Damped& damped : with_damping(sheets_and_hinges())) {
    const Specimen& specimen = damped.specimen;
    const PerParticle3& x = specimen.state.x;
    const PerParticle3 v = rigid_velocity(x, Vector3(0.4, -0.9, 0.3), Vector3(-3.1, 1.9, 4.7));
    measured.row(damped.name, force_in_roundings(Probe(subject, specimen.scene), specimen, v));
  }
  return judge_worst(measured, 32,
                     "u.v of a rigid motion is a sum of fewer than 32 terms' roundings, magnified "
                     "by the thinness");
}

/// x1 and x2 moving in the planes of their triangles, the edge stretching at `rates`
/// [1/s]: no angle changes.
PerParticle3 in_plane_velocity(const Corners& x, const std::array<double, 5>& rates) {
  const Vector3 edge = x[3] - x[2];
  PerParticle3 v(3, 4);
  v.col(0) = rates[0] * (x[0] - x[2]) + rates[1] * edge;
  v.col(1) = rates[2] * (x[1] - x[2]) + rates[3] * edge;
  v.col(2) = -rates[4] * edge;
  v.col(3) = rates[4] * edge;
  return v;
}

Finding leaves_in_plane_motion_alone(const Subject& subject) {
  const std::array<const char*, 5> names = {"x1 away from x3", "x1 along the edge",
                                            "x2 away from x3", "x2 along the edge",
                                            "stretch of the edge"};
  Table measured = roundings_of("kd s |u| sum |u_j||v_j| thinness");
  const std::vector<Damped> cases = with_damping(hinges_of_all_angles());
  for (size_t motion = 0; motion < names.size(); ++motion) {
    std::array<double, 5> rates{};
    rates[motion] = 2.7;
    Worst worst;
    for (const Damped& damped : cases) {
      const Specimen& hinge = damped.specimen;
      const Corners x = corners_of(hinge.scene.mesh.hinges[0], hinge.state.x);
      worst.observe(
          force_in_roundings(Probe(subject, hinge.scene), hinge, in_plane_velocity(x, rates)));
    }
    measured.row(names[motion], worst.value());
  }
  return judge_worst(measured, 32,
                     "u.v of an in-plane motion is a sum of fewer than 32 terms' roundings, "
                     "magnified by the thinness",
                     "A check of its own has the six rigid motions, which complete the eleven.");
}

std::vector<DampedScene> dense_cases() {
  std::vector<Specimen> specimens = small_crumpled_sheets();
  specimens.push_back(random_hinge(83, 2.2));
  std::vector<DampedScene> cases;
  for (const Damped& damped : with_damping(specimens)) {
    cases.push_back({damped.name, damped.specimen.scene, damped.specimen.state});
  }
  return cases;
}

Finding damping_is_symmetric(const Subject& subject) { return asymmetry(subject, dense_cases()); }

Finding damping_is_negative(const Subject& subject) {
  return largest_eigenvalue(subject, dense_cases());
}

Finding keeps_momentum(const Subject& subject) {
  Table measured = roundings_of("of the sum of sizes");
  for (const Damped& damped : with_damping(sheets_and_hinges())) {
    const Specimen& specimen = damped.specimen;
    const PerParticle3 f = Probe(subject, specimen.scene).damping(specimen.state, specimen.state.v);
    measured.row(damped.name + ", force", net_force(f));
    measured.row(damped.name + ", torque", net_torque(specimen.state.x, f));
  }
  return judge_worst(
      measured, 32,
      "each hinge's forces cancel to a few roundings and about 20 hinge forces are added to a "
      "particle, a rounding each",
      "the sum of sizes is sum |F_i| for the net force, sum |x_i||F_i| for the net torque");
}

}  // namespace

std::vector<Check> bending_damping_checks() {
  const char* const section = "BMF03 section 4";
  return {{"bending.damping-is-as-defined",
           "The damping force is the printed one to rounding, with either of its two factors.",
           "BMF03 section 4, evaluated in 50 digits", damping_is_as_defined},
          {"bending.damping-dissipates", "Bending damping takes energy out of every random motion.",
           section, damping_dissipates},
          {"bending.damping-leaves-rigid-motion-alone",
           "A sheet that moves as a rigid body feels no bending damping.", section,
           leaves_rigid_motion_alone},
          {"bending.damping-leaves-in-plane-motion-alone",
           "Motions of a hinge in the planes of its triangles feel no bending damping.", section,
           leaves_in_plane_motion_alone},
          {"bending.damping-is-symmetric", "The matrix of the bending damping is symmetric.",
           "BMF03 sections 3 and 4", damping_is_symmetric},
          {"bending.damping-is-negative-semidefinite",
           "The matrix of the bending damping has no positive eigenvalue.",
           "BMF03 sections 3 and 4", damping_is_negative},
          {"bending.damping-forces-conserve-momentum",
           "The bending damping's forces and torques sum to zero.", section, keeps_momentum}};
}

}  // namespace foldproof
