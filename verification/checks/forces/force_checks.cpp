#include "reference/dynamics/system.h"
#include "reference/forces/bending.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/check.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/random.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

const Vector3 field(1.3, -9.7, 2.9);  // m/s^2

/// A third of each triangle's area times the density, by Heron's formula in extended precision
/// [kg].
PerParticle masses_by_heron(const TriangleMesh& mesh, double density) {
  PerParticle masses = PerParticle::Zero(mesh.particles());
  for (const auto& [i, j, k] : mesh.triangles) {
    const auto length = [&](int from, int to) -> long double {
      return (mesh.rest.col(to).cast<long double>() - mesh.rest.col(from).cast<long double>())
          .norm();
    };
    const long double a = length(i, j), b = length(j, k), c = length(k, i), half = (a + b + c) / 2;
    const double share =
        double(std::sqrt(half * (half - a) * (half - b) * (half - c)) * density / 3);
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
  Table measured = roundings_of("m_i |g|");
  for (const Specimen& sheet : heavy_sheets()) {
    const PerParticle masses = masses_by_heron(sheet.scene.mesh, sheet.scene.density);
    const PerParticle3 difference =
        Probe(subject, sheet.scene).elastic(sheet.state) - field * masses.transpose();
    const PerParticle relative =
        difference.colwise().norm().transpose().cwiseQuotient(epsilon * field.norm() * masses);
    measured.row(sheet.name, relative.maxCoeff<Eigen::PropagateNaN>());
  }
  return judge_worst(measured, 32, "about eight areas of a few roundings each are added to a mass");
}

Finding gravity_energy(const Subject& subject) {
  Table measured = roundings_of("sum m_i |g||x_i|");
  for (const Specimen& sheet : heavy_sheets()) {
    const PerParticle masses = masses_by_heron(sheet.scene.mesh, sheet.scene.density);
    const double expected = -field.dot(sheet.state.x * masses);
    const double scale = field.norm() * sheet.state.x.colwise().norm().dot(masses);
    const double error = std::abs(Probe(subject, sheet.scene).energy(sheet.state) - expected);
    measured.row(sheet.name, error / (epsilon * scale));
  }
  return judge_worst(measured, 64,
                     "masses take about 16 roundings, and about 40 particles are added one by one");
}

/// The stiffness matrix by central differences of the forces, scaled with the masses: M^-1/2 K
/// M^-1/2 [1/s^2].
Eigen::MatrixXd scaled_stiffness(const Probe& probe, const State& s, const PerParticle& mass,
                                 double step) {
  const Eigen::MatrixXd K =
      -central_differences([&](const State& at) { return probe.elastic(at); }, s, step);
  const Eigen::VectorXd roots =
      mass.transpose().replicate(3, 1).reshaped().cwiseSqrt().cwiseInverse();
  return roots.asDiagonal() * K * roots.asDiagonal();
}

/// Largest elastic angular frequency [rad/s]; the uncertainty from halving the step of
/// the differences.
oracles::Estimate largest_frequency(const Probe& probe, const State& s, const PerParticle& mass) {
  std::array<double, 2> found{};
  for (int k = 0; k < 2; ++k) {
    const Eigen::MatrixXd K = scaled_stiffness(probe, s, mass, 2e-7 * (2 - k));
    found[k] = std::sqrt(oracles::symmetric_eigenvalues(0.5 * (K + K.transpose())).maxCoeff());
  }
  return {found[1], std::abs(found[1] - found[0])};
}

/// Two triangles ten times as high as their common edge is long; ordinary ones at rest.
Specimen tall_hinge(double angle) {
  const double edge = 0.031, height1 = 9.4 * edge, height2 = 9.8 * edge;
  const auto corners = [&](double shrink, double folded) -> Corners {
    return {Vector3(0.57 * edge, shrink * height1, 0),
            Vector3(0.48 * edge, -shrink * height2 * std::cos(folded),
                    -shrink * height2 * std::sin(folded)),
            Vector3(0, 0, 0), Vector3(edge, 0, 0)};
  };
  return {"tall hinge", hinge_scene(corners(0.08, 0.4), 0.74 * angle), state_of(corners(1, angle))};
}

std::vector<Specimen> stiff_cases() {
  std::vector<Specimen> list = small_crumpled_sheets();
  const auto bent = [](Specimen specimen, const std::string& what,
                       std::optional<BendingMaterial> bending,
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
    cases.push_back(bent(tall_hinge(angle), "bending at " + std::to_string(angle) + " rad",
                         bending_variants()[0], {}));
  unsigned seed = 300;
  for (const double angle : {0.01, 1.3, -2.3, 3.0, 3.14, -3.1415}) {
    cases.push_back(bent(random_hinge(seed++, angle),
                         "bending at " + std::to_string(angle) + " rad", bending_variants()[0],
                         {}));
    cases.push_back(bent(random_hinge(seed++, angle), "cubic at " + std::to_string(angle) + " rad",
                         bending_variants()[2], {}));
  }
  return cases;
}

Finding bound_is_a_bound(const Subject& subject) {
  Table measured("case; largest frequency over the bound [1]; largest frequency [rad/s]");
  for (const Specimen& specimen : stiff_cases()) {
    const System system = build_system(specimen.scene);
    const double bound = frequency_bound(system.forces, specimen.state, system.inverse_mass);
    const oracles::Estimate largest =
        largest_frequency(Probe(subject, specimen.scene), specimen.state, system.mass);
    measured.row(specimen.name,
                 oracles::Estimate{largest.value / bound, largest.uncertainty / bound},
                 largest.value);
  }
  return judge_worst(measured, "largest frequency over the bound", 1,
                     "an upper bound may not be exceeded");
}

/// Hinges far from their rest angles, whose forces change more through the geometric factors than
/// through the angle: at a half turn the slope of the sine vanishes.
std::vector<Specimen> far_from_rest() {
  std::vector<Specimen> cases;
  unsigned seed = 340;
  for (const double angle : {3.1415, -3.14, 2.9, -1.7, 0.6})
    for (const BendingMaterial& material : {bending_variants()[0], bending_variants()[2]}) {
      Specimen hinge = random_hinge(seed++, angle);
      hinge.scene.bending = material;
      hinge.scene.rest_angles = {angle > 0 ? -2.8 : 2.7};
      hinge.name +=
          ", " + std::string(material.law) + " at " + std::to_string(angle) + " rad, far from rest";
      cases.push_back(hinge);
    }
  return cases;
}

/// Bound on each particle's row from its springs and hinges [N/m].
PerParticle row_bounds(const Specimen& specimen) {
  const System system = build_system(specimen.scene);
  PerParticle rows = PerParticle::Zero(specimen.state.x.cols());
  for (const Force& force : system.forces) {
    if (const auto* springs = std::get_if<StretchSprings>(&force))
      springs->add_stiffness_bound(specimen.state, springs->shapes_at(specimen.state.x), rows);
    if (const auto* bending = std::get_if<Bending>(&force))
      bending->add_stiffness_bound(specimen.state, bending->shapes_at(specimen.state.x), rows);
  }
  return rows;
}

/// The row sums of the reference's derivative, particle by particle, of the largest stretch of each
/// 3 x 3 block [N/m].
PerParticle row_sums(const Specimen& specimen) {
  const Eigen::MatrixXd K = force_derivative(specimen.scene, specimen.state);
  PerParticle sums = PerParticle::Zero(specimen.state.x.cols());
  for (Eigen::Index i = 0; i < sums.size(); ++i)
    for (Eigen::Index j = 0; j < sums.size(); ++j) {
      const Eigen::MatrixXd block = K.block<3, 3>(3 * i, 3 * j);
      sums[i] += std::sqrt(oracles::symmetric_eigenvalues(block * block.transpose()).maxCoeff());
    }
  return sums;
}

Finding rows_are_covered() {
  Table measured{{"case", ""}, {"largest sum of a row over its bound", "1"}};
  std::vector<Specimen> cases = stiff_cases();
  for (const Specimen& specimen : far_from_rest()) cases.push_back(specimen);
  for (Specimen& specimen : cases) {
    if (specimen.scene.bending) specimen.scene.bending->damping = 0;
    const PerParticle share = row_sums(specimen).cwiseQuotient(row_bounds(specimen));
    measured.row(specimen.name, share.maxCoeff<Eigen::PropagateNaN>());
  }
  return judge_worst(measured, 1 + 1e-9,
                     "an upper bound may not be exceeded, but for rounding in thin triangles");
}

/// Hinges at rest, where only the rank-one part remains: there the bound equals the sum.
Finding rows_are_reached() {
  Table measured{{"case", ""}, {"largest |sum of a row over its bound - 1|", "1"}};
  std::vector<Specimen> cases;
  unsigned seed = 370;
  for (const double angle : {0.3, -1.9, 2.6}) {
    cases.push_back(random_hinge(seed++, angle));
    cases.back().scene.bending = bending_variants()[0];
    cases.back().scene.bending->damping = 0;
    cases.back().scene.rest_angles = hinge_angles(cases.back().scene.mesh, cases.back().state.x);
  }
  for (const Specimen& specimen : cases) {
    const PerParticle share = row_sums(specimen).cwiseQuotient(row_bounds(specimen));
    measured.row(specimen.name, (share.array() - 1).abs().maxCoeff<Eigen::PropagateNaN>());
  }
  return judge_worst(measured, 1e-7,
                     "a rest angle is met to a rounding, which thin triangles magnify; a missing "
                     "term or a wrong factor is of order 1");
}

/// The same hinge seen from its other side: x1 and x2 exchanged, and x3 and x4.
Corners turned_round(const Corners& x) { return {x[1], x[0], x[3], x[2]}; }

Finding rows_follow_their_particles() {
  Table measured{{"case", ""}, {"largest difference over a row's bound", "epsilon"}};
  Random random(380);
  for (const double angle : {0.4, -1.6, 2.8}) {
    const Corners rest = random_corners(random, 0.5 * angle), x = random_corners(random, angle);
    const auto bounds_of = [&](const Corners& rest_corners, const Corners& corners) {
      Specimen hinge{"", hinge_scene(rest_corners, -angle), state_of(corners)};
      hinge.scene.bending = bending_variants()[0];
      return row_bounds(hinge);
    };
    const PerParticle one = bounds_of(rest, x),
                      other = bounds_of(turned_round(rest), turned_round(x));
    for (int k = 0; k < 4; ++k) {
      const int same = std::array{1, 0, 3, 2}[size_t(k)];
      measured.row("particle " + std::to_string(k + 1) + " at " + std::to_string(angle) + " rad",
                   std::abs(other[same] / one[k] - 1) / epsilon);
    }
  }
  return judge_worst(
      measured, 3000,
      "a bound has some thirty roundings, which thin triangles magnify by their shape, sides of up "
      "to ten to one twice; terms of the wrong particle differ by the sides");
}

Finding unknown_laws_are_rejected() {
  Table measured{{"case", ""}, {"names that are taken or refused wrongly", "1"}};
  for (const BendingLaw& law : bending_laws())
    measured.row(std::string(law.name), bending_law(law.name).magnitude == law.magnitude ? 0 : 1);
  for (const std::string name : {"square", "", "sin", "Sine"}) {
    const std::string said = rejection_message([&] { bending_law(name); });
    const bool is_told =
        said.find("'" + name + "'") != std::string::npos && said.ends_with("known: sine, cubic");
    measured.row("'" + name + "'", is_told ? 0 : 1);
  }
  return judge_worst(measured, 0,
                     "a law is one of the list, or refused with its name and the list");
}

}  // namespace

std::vector<Check> force_checks() {
  return {{"gravity.force-is-weight",
           "Gravity pulls on each particle with its share of the triangles' mass times g.",
           "Newton", gravity_is_weight},
          {"gravity.energy-is-as-defined", "The energy of gravity is -sum m_i g.x_i.", "Newton",
           gravity_energy},
          {"forces.frequency-bound-holds",
           "The reference's bound on the elastic frequency exceeds the largest frequency of "
           "crumpled sheets and sharp folds.",
           "Gershgorin's theorem; the automatic step rests on it", bound_is_a_bound},
          {"bending.unknown-laws-are-rejected",
           "A bending law that the reference does not know is refused by name.",
           "a rule of this suite: bad input is refused in words", unknown_laws_are_rejected},
          {"forces.row-bounds-cover-every-row",
           "No row of the stiffness matrix exceeds the reference's bound for its particle, however "
           "far a hinge is from its rest angle.",
           "Gershgorin's theorem; the automatic step rests on it", rows_are_covered},
          {"forces.row-bounds-swap-with-the-sides-of-a-hinge",
           "A hinge seen from the other side, its particles exchanged in pairs, has the same "
           "bounds, exchanged.",
           "the angle about an edge does not depend on the direction of view along it",
           rows_follow_their_particles},
          {"forces.row-bounds-are-tight-at-rest",
           "At a hinge's rest angle the bound on each particle's row is the row's own sum.",
           "calculus: there the matrix is -ke c u u^T / 2", rows_are_reached}};
}

}  // namespace foldproof
