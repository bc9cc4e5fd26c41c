#include "verification/checks/forces/spring_sheet.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "verification/evidence.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

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

/// Energy per area and squared strain [N/m] of a homogeneous strain, turned by `direction` [rad]
/// and `size` large; the mean of both signs, which leaves an error relative size^2.
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

}  // namespace

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

}  // namespace foldproof
