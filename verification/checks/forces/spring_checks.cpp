// Springs, and the moduli of a sheet of equilateral triangles.
#include <numbers>

#include "verification/checks/forces/damping_laws.h"
#include "verification/checks/forces/work.h"
#include "verification/oracles/definitions.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/check.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

StretchMaterial soft() { return {37.0, 0.043, 1}; }
StretchMaterial stiff_and_shrunk() { return {2900.0, 1.7, 0.93}; }

/// Crumpled sheets with springs of both materials in turn.
std::vector<Specimen> sprung_sheets() {
  std::vector<Specimen> sheets = crumpled_sheets();
  for (size_t k = 0; k < sheets.size(); ++k)
    sheets[k].scene.stretch = k % 2 == 0 ? soft() : stiff_and_shrunk();
  return sheets;
}

const char* const why_sums =
    "a spring's two forces are equal and opposite up to a rounding of each sum; about eight "
    "springs meet in a particle";

Finding forces_sum_to_zero(const Subject& subject) {
  Table measured = roundings_of("sum |F_i|");
  for (const Specimen& sheet : sprung_sheets())
    measured.row(sheet.name, net_force(Probe(subject, sheet.scene).elastic(sheet.state)));
  return judge_worst(measured, 16, why_sums);
}

Finding torques_sum_to_zero(const Subject& subject) {
  Table measured = roundings_of("sum |x_i||F_i|");
  for (const Specimen& sheet : sprung_sheets())
    measured.row(sheet.name,
                 net_torque(sheet.state.x, Probe(subject, sheet.scene).elastic(sheet.state)));
  return judge_worst(measured, 16, why_sums);
}

/// One edge of a sheet as oracle input.
oracles::SpringInput spring_input(const Specimen& sheet, size_t edge) {
  const auto& [a, b, triangles] = sheet.scene.mesh.edges[edge];
  const StretchMaterial& material = *sheet.scene.stretch;
  const double length = rest_lengths(sheet.scene.mesh)[edge], scale = material.rest_length_scale;
  oracles::SpringInput input;
  input.x = {sheet.state.x.col(a), sheet.state.x.col(b)};
  input.v = {sheet.state.v.col(a), sheet.state.v.col(b)};
  // A_e/L0^2 is that of the rest shape, at any scale of the rest lengths
  input.law = {material.stiffness, material.damping,
               scale * scale * edge_areas(sheet.scene.mesh)[edge], scale * length};
  return input;
}

using SpringOracle = oracles::VectorsEstimate<2> (*)(const oracles::SpringInput&);

/// Size of a spring's terms before they cancel [N].
double elastic_scale(const oracles::SpringInput& input) {
  const double strain = (input.x[1] - input.x[0]).norm() / input.law.rest_length;
  return input.law.young * input.law.area / input.law.rest_length * (1 + strain);
}

double damping_scale(const oracles::SpringInput& input) {
  return input.law.damping * input.law.area / std::pow(input.law.rest_length, 2) *
         (input.v[0] - input.v[1]).norm();
}

/// The worst particle's difference from the sum of the oracle's forces, over epsilon times the sum
/// of its springs' scales.
oracles::Estimate difference_from(const Specimen& sheet, const PerParticle3& f, SpringOracle oracle,
                                  double (*scale_of)(const oracles::SpringInput&)) {
  PerParticle3 expected = PerParticle3::Zero(3, f.cols());
  PerParticle scale = PerParticle::Zero(f.cols()), uncertainty = scale;
  for (size_t e = 0; e < sheet.scene.mesh.edges.size(); ++e) {
    const oracles::SpringInput input = spring_input(sheet, e);
    const auto force = oracle(input);
    const std::array<int, 2> ends = {sheet.scene.mesh.edges[e].a, sheet.scene.mesh.edges[e].b};
    for (int k = 0; k < 2; ++k) {
      expected.col(ends[k]) += force.value[k];
      scale[ends[k]] += scale_of(input);
      uncertainty[ends[k]] += force.uncertainty + epsilon * expected.col(ends[k]).norm();
    }
  }
  const PerParticle error =
      (f - expected).colwise().norm().transpose().cwiseQuotient(epsilon * scale);
  return {error.maxCoeff<Eigen::PropagateNaN>(),
          uncertainty.cwiseQuotient(epsilon * scale).maxCoeff()};
}

Finding force_is_as_defined(const Subject& subject) {
  Table measured = roundings_of("Y A_e/L0 (1 + |d|/L0)");
  for (const Specimen& sheet : sprung_sheets()) {
    const PerParticle3 f = Probe(subject, sheet.scene).elastic(sheet.state);
    measured.row(sheet.name, difference_from(sheet, f, oracles::spring_elastic_50, elastic_scale));
  }
  return judge_worst(
      measured, 32,
      "lengths, areas and the product that is the force take fewer than 32 roundings");
}

Finding damping_is_as_defined(const Subject& subject) {
  Table measured = roundings_of("kd_s A_e/L0^2 |v_b - v_a|");
  for (const Specimen& sheet : sprung_sheets()) {
    const PerParticle3 f = Probe(subject, sheet.scene).damping(sheet.state, sheet.state.v);
    measured.row(sheet.name, difference_from(sheet, f, oracles::spring_damping_50, damping_scale));
  }
  return judge_worst(
      measured, 32,
      "lengths, areas and the product that is the force take fewer than 32 roundings");
}

Finding force_is_minus_gradient(const Subject& subject) {
  Table measured = roundings_of("(integral |F||dx| + |E|)");
  for (const Specimen& sheet : sprung_sheets()) {
    const double size = 0.05 * rest_lengths(sheet.scene.mesh).minCoeff();
    measured.row(sheet.name, energy_against_work(Probe(subject, sheet.scene),
                                                 random_line(sheet.state.x, size, 61)));
  }
  return judge_worst(measured, 64,
                     "80 to 640 forces and two energies enter the balance, each good to a few "
                     "roundings of its scale; the quadrature's own error is the uncertainty");
}

Finding energy_is_as_defined(const Subject& subject) {
  Table measured = roundings_of("Y A_e (1 + (|d|/L0)^2)");
  for (const Specimen& sheet : sprung_sheets()) {
    double energy = 0, scale = 0;
    for (size_t e = 0; e < sheet.scene.mesh.edges.size(); ++e) {
      const oracles::SpringInput input = spring_input(sheet, e);
      energy += oracles::spring_energy_50(input).value;
      scale += input.law.young * input.law.area *
               (1 + (input.x[1] - input.x[0]).squaredNorm() / std::pow(input.law.rest_length, 2));
    }
    measured.row(sheet.name, std::abs(Probe(subject, sheet.scene).energy(sheet.state) - energy) /
                                 (epsilon * scale));
  }
  return judge_worst(
      measured, 32,
      "a spring's energy takes about ten roundings, and the springs are added one by one");
}

Finding rest_gives_no_force(const Subject& subject) {
  Table measured = roundings_of("sum Y A_e/L0");
  for (Specimen& shape : curved_shapes()) {
    shape.scene.stretch = StretchMaterial{410.0, 0.37, 1};
    const PerParticle3 f = Probe(subject, shape.scene).elastic(shape.state);
    const double scale =
        410.0 *
        edge_areas(shape.scene.mesh).cwiseQuotient(rest_lengths(shape.scene.mesh)).maxCoeff();
    measured.row(shape.name,
                 f.colwise().norm().maxCoeff<Eigen::PropagateNaN>() / (epsilon * scale));
  }
  return judge_worst(
      measured, 16,
      "two ways to a length differ by a few roundings; about eight springs meet in a particle");
}

/// Y A_e/L0^2 is that of the rest shape, so a scale only changes the length at which a spring has
/// no force.
Finding rest_length_scale_is_kept(const Subject& subject) {
  Table measured = roundings_of("of the size");
  Specimen sheet = crumpled_sheets()[4];
  for (const double scale : {0.83, 0.97, 1.0, 1.21}) {
    sheet.scene.stretch = StretchMaterial{530.0, 0.29, scale};
    const Probe probe(subject, sheet.scene);
    const PerParticle3 at_ease = scale * sheet.scene.mesh.rest;
    const Eigen::VectorXd areas = edge_areas(sheet.scene.mesh);
    const double energy = 0.5 * 530.0 * (1 - scale) * (1 - scale) * areas.sum();
    const double force_scale =
        530.0 * areas.cwiseQuotient(rest_lengths(sheet.scene.mesh)).maxCoeff();
    const std::string name = "rest lengths times " + std::to_string(scale);
    measured.row(
        name + ", force at ease",
        probe.elastic(resting_state(at_ease)).colwise().norm().maxCoeff<Eigen::PropagateNaN>() /
            (epsilon * force_scale));
    measured.row(name + ", energy at the unscaled rest shape",
                 std::abs(probe.energy(resting_state(sheet.scene.mesh.rest)) - energy) /
                     (epsilon * 530.0 * areas.sum()));
  }
  return judge_worst(measured, 32,
                     "two ways to a length differ by a few roundings; springs are added one by one",
                     "the size of a force is the largest Y A_e/L0, that of an energy sum Y A_e");
}

Finding damping_dissipates(const Subject& subject) {
  Table powers = no_powers();
  for (const Specimen& sheet : sprung_sheets()) {
    const auto [power, share] = damping_power_of(Probe(subject, sheet.scene), sheet.state);
    powers.row(sheet.name, share, power);
  }
  return dissipation(powers);
}

Finding damping_leaves_rigid_motion_alone(const Subject& subject) {
  Table measured = roundings_of("kd_s A_e/L0^2 (|v_a| + |v_b|), largest over the springs");
  for (const Specimen& sheet : sprung_sheets()) {
    const PerParticle3 v =
        rigid_velocity(sheet.state.x, Vector3(-0.7, 0.2, 1.1), Vector3(2.3, -4.1, 1.3));
    const Eigen::VectorXd lengths = rest_lengths(sheet.scene.mesh);
    const double coefficient =
        sheet.scene.stretch->damping *
        edge_areas(sheet.scene.mesh).cwiseQuotient(lengths.cwiseAbs2()).maxCoeff();
    const double scale = coefficient * 2 * v.colwise().norm().maxCoeff();
    const PerParticle3 f = Probe(subject, sheet.scene).damping(sheet.state, v);
    measured.row(sheet.name,
                 f.colwise().norm().maxCoeff<Eigen::PropagateNaN>() / (epsilon * scale));
  }
  return judge_worst(measured, 16,
                     "d.(v_b - v_a) of a rigid motion cancels to a few roundings; about eight "
                     "springs meet in a particle");
}

Finding damping_is_symmetric_negative(const Subject& subject) {
  std::vector<DampedScene> cases;
  for (Specimen& sheet : small_crumpled_sheets()) {
    sheet.scene.stretch = cases.size() % 2 == 0 ? soft() : stiff_and_shrunk();
    cases.push_back({sheet.name, sheet.scene, sheet.state});
  }
  const Finding symmetry = asymmetry(subject, cases);
  Finding finding = largest_eigenvalue(subject, cases);
  finding.evidence.add(
      {"asymmetry", "epsilon largest |D_ij|", symmetry.evidence.numbers("measured")});
  Worst worst;
  worst.observe(finding.verdict.measured);
  worst.observe(symmetry.verdict.measured);
  finding.verdict.measured = worst.value();
  finding.verdict.unit = "epsilon of the matrix's size";
  finding.note =
      "the size is 3N times the largest |eigenvalue| for an eigenvalue, the largest |D_ij| for the "
      "asymmetry";
  finding.verdict.why_bound +=
      "; an entry of D and its mirror are the same product in another order";
  return finding;
}

constexpr int columns = 9, rows = 7;
constexpr double edge = 0.037;  // m
constexpr double young = 83.0;  // N/m

/// A parallelogram of whole equilateral triangles.
TriangleMesh equilateral_parallelogram() {
  PerParticle3 rest(3, (columns + 1) * (rows + 1));
  std::vector<Triangle> triangles;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i)
      rest.col(j * (columns + 1) + i) =
          edge * Vector3(i + 0.5 * j, 0.5 * std::numbers::sqrt3 * j, 0);
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int corner = j * (columns + 1) + i, above = corner + columns + 1;
      triangles.push_back({corner, corner + 1, above});
      triangles.push_back({corner + 1, above + 1, above});
    }
  }
  return make_triangle_mesh(rest, triangles);
}

/// A strain of the sheet's plane [1], along and across a direction.
struct Strain {
  double along, across;
};

/// Energy per area and squared strain [N/m] of a homogeneous strain, turned by `direction` [rad],
/// of amplitude `size`; the mean of both signs leaves a relative error of size^2.
double energy_density(const Probe& probe, const TriangleMesh& mesh, const Strain& strain,
                      double direction, double size) {
  const double area = columns * rows * edge * edge * 0.5 * std::numbers::sqrt3;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(direction, Vector3::UnitZ()).matrix();
  const Eigen::Matrix3d shape =
      turn * Eigen::DiagonalMatrix<double, 3>(strain.along, strain.across, 0) * turn.transpose();
  double sum = 0;
  for (const double sign : {1.0, -1.0}) {
    const PerParticle3 x = mesh.rest + sign * size * (shape * mesh.rest);
    sum += probe.energy(resting_state(x));
  }
  return sum / (2 * area * size * size);
}

/// The same for vanishing strain, by Richardson extrapolation.
oracles::Estimate stiffness(const Probe& probe, const TriangleMesh& mesh, const Strain& strain,
                            double direction) {
  const double size = 1e-3;
  const double coarsest = energy_density(probe, mesh, strain, direction, 4 * size);
  const double coarse = energy_density(probe, mesh, strain, direction, 2 * size);
  const double fine = energy_density(probe, mesh, strain, direction, size);
  const double value = fine + (fine - coarse) / 3, before = coarse + (coarse - coarsest) / 3;
  // an error of fourth order is a fifteenth of the difference
  return {value, std::abs(value - before) / 8};
}

/// From the energy under small homogeneous strains, against Y and 1/3: the worst relative error
/// over several directions.
Finding equilateral_moduli(const Subject& subject) {
  Scene scene = scene_at_rest(equilateral_parallelogram(), 0.21);
  scene.stretch = StretchMaterial{young, 0, 1};
  const Probe probe(subject, scene);
  const oracles::SheetModuli expected = oracles::equilateral_sheet_moduli(young);

  const std::string finding = "worse relative error of the two";
  Table measured{{"case", ""}, {finding, "1"}, {"Young's modulus", "N/m"}, {"Poisson ratio", "1"}};
  for (const double degrees : {0.0, 17.0, 30.0, 52.0, 90.0}) {
    const double direction = degrees * pi / 180;
    // energy per area: (C11 a^2 + 2 C12 a b + C22 b^2)/2 for strains a along and b across
    const oracles::Estimate along = stiffness(probe, scene.mesh, {1, 0}, direction);
    const oracles::Estimate across = stiffness(probe, scene.mesh, {0, 1}, direction);
    const oracles::Estimate both = stiffness(probe, scene.mesh, {1, 1}, direction);
    const double C11 = 2 * along.value, C22 = 2 * across.value,
                 C12 = both.value - along.value - across.value;
    const double found_young = C11 - C12 * C12 / C22, found_poisson = C12 / C22;
    Worst error;
    error.observe(std::abs(found_young / expected.young.value - 1));
    error.observe(std::abs(found_poisson / expected.poisson.value - 1));
    const double uncertainty =
        (along.uncertainty + across.uncertainty + both.uncertainty) * 4 / young;
    measured.row(std::to_string(int(degrees)) + " degrees",
                 oracles::Estimate{error.value(), uncertainty}, found_young, found_poisson);
  }
  return judge_worst(measured, finding, 1e-8,
                     "strains of 1e-3 and 2e-3, extrapolated, leave errors of their fourth power "
                     "times about ten, 2e-10; rounding leaves epsilon over the strain squared, as "
                     "much; what the extrapolation of three strains adds is ten times that");
}

}  // namespace

std::vector<Check> spring_checks() {
  const char* const source = "mesh-independent form of the springs, ours: BMF03 presumes springs";
  const char* const section3 = "BMF03 section 3";
  return {{"springs.forces-sum-to-zero",
           "The elastic spring forces on crumpled sheets sum to zero.", source, forces_sum_to_zero},
          {"springs.torques-sum-to-zero", "The torques of the elastic spring forces sum to zero.",
           source, torques_sum_to_zero},
          {"springs.force-is-as-defined", "The elastic spring force is Y (A_e/L0)(|d|/L0 - 1) d^.",
           source, force_is_as_defined},
          {"springs.damping-is-as-defined",
           "The spring damping force is kd_s (A_e/L0^2)((v_b - v_a).d^) d^.", source,
           damping_is_as_defined},
          {"springs.force-is-minus-gradient-of-energy",
           "The elastic spring force's work along a path is the energy's loss.", source,
           force_is_minus_gradient},
          {"springs.energy-is-as-defined",
           "The energy of the springs is the sum of Y A_e/2 (|d|/L0 - 1)^2.", source,
           energy_is_as_defined},
          {"springs.rest-shape-feels-no-force",
           "Flat or curved, a sheet in its rest shape feels no spring force.", source,
           rest_gives_no_force},
          {"springs.rest-length-scale-leaves-stiffness-alone",
           "Scaled rest lengths change the relaxed shape and not the springs' stiffness.", source,
           rest_length_scale_is_kept},

          {"springs.damping-dissipates", "Spring damping takes energy out of every random motion.",
           section3, damping_dissipates},
          {"springs.damping-leaves-rigid-motion-alone",
           "A sheet that moves as a rigid body feels no spring damping.", section3,
           damping_leaves_rigid_motion_alone},
          {"springs.damping-is-symmetric-negative-semidefinite",
           "The matrix of the spring damping is symmetric and has no positive eigenvalue.",
           section3, damping_is_symmetric_negative},
          {"springs.equilateral-sheet-has-modulus-Y-and-Poisson-ratio-one-third",
           "A sheet of equilateral triangles has Young's modulus Y and Poisson ratio 1/3 in every "
           "direction.",
           "derived from the springs' form", equilateral_moduli}};
}

}  // namespace foldproof
