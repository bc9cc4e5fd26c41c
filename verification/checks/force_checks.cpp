#include "verification/checks/force_checks.h"

#include <cmath>

#include "reference/dynamics/system.h"
#include "verification/checks/measured.h"
#include "verification/checks/specimens.h"
#include "verification/oracles/dense_algebra.h"

namespace foldproof {

namespace {

const Vector3 field(1.3, -9.7, 2.9);  // m/s^2

/// A third of each triangle's area times the density, by way of Heron's formula in extended precision [kg].
PerParticle masses_by_heron(const TriangleMesh& mesh, double density) {
  PerParticle masses = PerParticle::Zero(mesh.particles());
  for (const auto& [i, j, k] : mesh.triangles) {
    const auto length = [&](int from, int to) -> long double {
      return (mesh.rest.col(to).cast<long double>() - mesh.rest.col(from).cast<long double>()).norm();
    };
    const long double a = length(i, j), b = length(j, k), c = length(k, i), half = (a + b + c) / 2;
    const double share = double(std::sqrt(half * (half - a) * (half - b) * (half - c)) * density / 3);
    for (const int particle : {i, j, k}) masses[particle] += share;
  }
  return masses;
}

std::vector<Specimen> heavy_sheets() {
  std::vector<Specimen> sheets = crumpled_sheets();
  for (Specimen& sheet : sheets) sheet.scene.gravity = field;
  return sheets;
}

Finding gravity_is_weight(const Subject& subject) {
  Measured measured = roundings_of("m_i |g|");
  for (const Specimen& sheet : heavy_sheets()) {
    const PerParticle masses = masses_by_heron(sheet.scene.mesh, sheet.scene.density);
    const PerParticle3 difference =
        Probe(subject, sheet.scene).elastic(sheet.state) - field * masses.transpose();
    const PerParticle relative =
        difference.colwise().norm().transpose().cwiseQuotient(epsilon * field.norm() * masses);
    measured.see(sheet.name, relative.maxCoeff<Eigen::PropagateNaN>());
  }
  return measured.judged(32, "about eight areas of a few roundings each are added to a mass");
}

Finding gravity_energy(const Subject& subject) {
  Measured measured = roundings_of("sum m_i |g||x_i|");
  for (const Specimen& sheet : heavy_sheets()) {
    const PerParticle masses = masses_by_heron(sheet.scene.mesh, sheet.scene.density);
    const double expected = -field.dot(sheet.state.x * masses);
    const double scale = field.norm() * sheet.state.x.colwise().norm().dot(masses);
    const double error = std::abs(Probe(subject, sheet.scene).energy(sheet.state) - expected);
    measured.see(sheet.name, error / (epsilon * scale));
  }
  return measured.judged(64, "masses take about 16 roundings, and about 40 particles are added one by one");
}

/// The stiffness matrix by central differences of the forces, scaled with the masses: M^-1/2 K M^-1/2
/// [1/s^2].
Eigen::MatrixXd scaled_stiffness(const Probe& probe, const State& s, const PerParticle& mass, double step) {
  const Eigen::Index size = s.x.size();
  Eigen::MatrixXd K(size, size);
  State moved = s;
  for (Eigen::Index k = 0; k < size; ++k) {
    moved.x.reshaped()[k] = s.x.reshaped()[k] + step;
    const PerParticle3 ahead = probe.elastic(moved);
    moved.x.reshaped()[k] = s.x.reshaped()[k] - step;
    const PerParticle3 column = (probe.elastic(moved) - ahead) / (2 * step);
    moved.x.reshaped()[k] = s.x.reshaped()[k];
    K.col(k) = column.reshaped();
  }
  const Eigen::VectorXd roots = mass.transpose().replicate(3, 1).reshaped().cwiseSqrt().cwiseInverse();
  return roots.asDiagonal() * K * roots.asDiagonal();
}

/// Largest elastic angular frequency [rad/s]; the uncertainty from halving the step of the differences.
oracles::Estimate largest_frequency(const Probe& probe, const State& s, const PerParticle& mass) {
  std::array<double, 2> found{};
  for (int k = 0; k < 2; ++k) {
    const Eigen::MatrixXd K = scaled_stiffness(probe, s, mass, 1e-6 * (2 - k));
    found[k] = std::sqrt(oracles::symmetric_eigenvalues(0.5 * (K + K.transpose())).maxCoeff());
  }
  return {found[1], std::abs(found[1] - found[0])};
}

/// Two triangles ten times as high as their common edge is long, at rest as regular as most.
Specimen tall_hinge(double angle) {
  const double edge = 0.031, height1 = 9.4 * edge, height2 = 9.8 * edge;
  const auto corners = [&](double shrink, double folded) -> Corners {
    return {Vector3(0.57 * edge, shrink * height1, 0),
            Vector3(0.48 * edge, -shrink * height2 * std::cos(folded), -shrink * height2 * std::sin(folded)),
            Vector3(0, 0, 0), Vector3(edge, 0, 0)};
  };
  return {"tall hinge", hinge_scene(corners(0.08, 0.4), 0.74 * angle), state_of(corners(1, angle))};
}

std::vector<Specimen> stiff_cases() {
  std::vector<Specimen> list = small_crumpled_sheets();
  const auto bent = [](Specimen specimen, const std::string& what, std::optional<BendingMaterial> bending,
                       std::optional<StretchMaterial> stretch) {
    specimen.name += ", " + what;
    specimen.scene.bending = bending;
    specimen.scene.stretch = stretch;
    return specimen;
  };
  std::vector<Specimen> cases;
  for (const Specimen& sheet : list) {
    cases.push_back(bent(sheet, "springs", {}, StretchMaterial{47.0, 0, 0.91}));
    cases.push_back(bent(sheet, "bending", bending_variants()[0], {}));
    cases.push_back(bent(sheet, "cubic bending", bending_variants()[2], {}));
    cases.push_back(bent(sheet, "both", bending_variants()[0], StretchMaterial{0.31, 0, 1.07}));
  }
  for (const double angle : {2.2, -2.9})
    cases.push_back(
        bent(tall_hinge(angle), "bending at " + std::to_string(angle) + " rad", bending_variants()[0], {}));
  unsigned seed = 300;
  for (const double angle : {0.01, 1.3, -2.3, 3.0, 3.14, -3.1415}) {
    cases.push_back(bent(random_hinge(seed++, angle), "bending at " + std::to_string(angle) + " rad",
                         bending_variants()[0], {}));
    cases.push_back(bent(random_hinge(seed++, angle), "cubic at " + std::to_string(angle) + " rad",
                         bending_variants()[2], {}));
  }
  return cases;
}

Finding bound_is_a_bound(const Subject& subject) {
  Measured measured("largest frequency over the bound", "1");
  std::vector<double> frequencies;
  for (const Specimen& specimen : stiff_cases()) {
    const System system = build_system(specimen.scene);
    const double bound = frequency_bound(system.forces, specimen.state, system.inverse_mass);
    const oracles::Estimate largest =
        largest_frequency(Probe(subject, specimen.scene), specimen.state, system.mass);
    measured.see(specimen.name, {largest.value / bound, largest.uncertainty / bound});
    frequencies.push_back(largest.value);
  }
  Finding finding = measured.judged(1, "an upper bound may not be exceeded");
  finding.evidence.push_back({"largest frequency", "rad/s", frequencies});
  return finding;
}

}  // namespace

std::vector<Check> force_checks() {
  std::vector<Check> checks = spring_checks();
  const std::vector<Check> own = {
      {"gravity.force-is-weight",
       "Gravity pulls on each particle with its share of the triangles' mass times g.", "Newton",
       gravity_is_weight},
      {"gravity.energy-is-potential", "The energy of gravity is -sum m_i g.x_i.", "Newton", gravity_energy},
      {"forces.frequency-bound-is-a-bound",
       "The reference's bound on the elastic frequency exceeds the largest frequency of crumpled sheets and "
       "sharp folds.",
       "Gershgorin's theorem; the automatic step rests on it", bound_is_a_bound}};
  checks.insert(checks.end(), own.begin(), own.end());
  return checks;
}

}  // namespace foldproof
