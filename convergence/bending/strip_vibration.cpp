// strip-vibration: the lowest frequencies of a clamped strip, from its stiffness and
// from its steps.

#include "convergence/bending/row_strip.h"
#include "convergence/study.h"
#include "reference/dynamics/integrator.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/oracles/gsl.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

// of the flat strip [m]: linear, and large enough for differences
constexpr double disturbance = 1e-6;

/// beta L of the n-th mode of a clamped-free beam (n = 1, 2): cos(beta L) cosh(beta L) = -1.
double clamped_free_root(int n) {
  const auto characteristic = [](double b) { return std::cos(b) + 1 / std::cosh(b); };
  return oracles::bracketed_root(characteristic, (n - 1) * pi + 0.5, n * pi, 0).value;
}

/// The frequencies of the continuous strip with the rigidity of the homogenised cell [rad/s].
double exact_frequency(int n) {
  return std::pow(clamped_free_root(n) / strip_length, 2) * std::sqrt(strip_D / strip_density);
}

using Modes = oracles::SymmetricModes;

/// Modes of K x = omega^2 M x; only the symmetric part of K counts, the rest is rounding.
Modes modes_of(const Eigen::MatrixXd& K, const Eigen::VectorXd& masses) {
  return oracles::symmetric_modes(0.5 * (K + K.transpose()), masses);
}

/// Forces across a strip held cylindrical when its free rows rise by `heights` [m]; one of
/// each per row [N].
Eigen::VectorXd pull(const RowStrip& strip, const Eigen::VectorXd& heights) {
  const StripAtRest flat = level(strip);
  Eigen::Matrix2Xd rows = strip.rows(flat.slopes, flat.lengths);
  rows.row(1).tail(heights.size()) = heights.transpose();
  return strip.forces(rows).row(1).tail(heights.size()).transpose();
}

/// omega of the first two modes [rad/s] of a strip held cylindrical: shapes from the stiffness
/// row by row, frequencies from Rayleigh's quotient of those shapes, which rounding of the
/// stiffness leaves alone.
Eigen::Vector2d frequencies(const RowStrip& strip) {
  constexpr double amplitude = 1e-5;  // m
  const Eigen::Index n = strip.panels();
  const double small = 1e-5 * strip.spacing();
  Eigen::MatrixXd K(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::VectorXd up = small * Eigen::VectorXd::Unit(n, k);
    K.col(k) = (pull(strip, -up) - pull(strip, up)) / (2 * small);
  }
  Eigen::VectorXd masses =
      Eigen::VectorXd::Constant(n, strip_density * strip.width() * strip.spacing());
  masses[n - 1] /= 2;  // the last row has cells on one side only
  const Modes modes = modes_of(K, masses);
  Eigen::Vector2d omega;
  for (Eigen::Index mode = 0; mode < 2; ++mode) {
    const Eigen::VectorXd shape = amplitude * modes.vectors.col(mode).normalized();
    omega[mode] = std::sqrt(-shape.dot(pull(strip, shape)) / shape.dot(masses.cwiseProduct(shape)));
  }
  return omega;
}

NamedFinding order_of(int mode, Table modes) {
  const Convergence error = convergence_of(modes, "relative error");
  modes.add({"order", "1", row_orders(error)});
  const Verdict verdict =
      order_verdict(error, 2, 1, 0.1,
                    "another order is off by 1; the third term of the error is smaller than "
                    "the second by the number of panels over the mode's number");
  const std::string number = std::to_string(mode);
  return {
      "strip-vibration.is-second-order.mode-" + number,
      "Mode " + number +
          " of a clamped strip held cylindrical tends with second order to the beam's frequency.",
      {verdict, std::move(modes), "measured is |order - 2| of the last pair"}};
}

NamedFinding is_the_beam(const std::array<Table, 2>& modes) {
  Table frequencies{{"omega", "rad/s"}, {"clamped-free beam", "rad/s"}};
  for (const size_t mode : {0, 1})
    frequencies.row(modes[mode].numbers("omega").back(), exact_frequency(int(mode) + 1));
  const double worst = largest_deviation(frequencies, "omega", "clamped-free beam");
  const Verdict verdict{
      worst, 0.01, 0, "1",
      "a rigidity off by a fiftieth would show; meshes in the table of rigidities differ by more"};
  return {"strip-vibration.matches-the-beam",
          "At the finest mesh the first two frequencies of a clamped strip are the beam's within "
          "one percent.",
          {verdict, frequencies}};
}

// --- steps ---

/// A strip of one-diagonal squares, free to twist and to curve across; rows 0 and 1 are held.
Scene free_strip() {
  constexpr int along = 9, across = 2;
  const double cell = strip_length / (along - 0.5);
  Scene scene = scene_at_rest(
      make_sheet({SheetPattern::one_diagonal, along * cell, across * cell, along, across}),
      strip_density);
  add_flat_hinges(scene, strip_ke, 0);
  for (int i = 0; i < scene.mesh.particles(); ++i) {
    if (scene.mesh.rest(0, i) < 1.5 * cell)
      scene.prescribed.push_back({i, scene.mesh.rest.col(i), {}});
  }
  return scene;
}

/// Modes across the sheet from the subject's forces about the flat state.
Modes sheet_modes(const Probe& probe, const Scene& scene, const std::vector<int>& free) {
  const PerParticle all_masses = lumped_masses(scene.mesh, scene.density);
  const Eigen::Index n = Eigen::Index(free.size());
  Eigen::MatrixXd K(n, n);
  Eigen::VectorXd masses(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    PerParticle3 x = scene.x;
    x(2, free[size_t(k)]) = disturbance;
    const PerParticle3 ahead = probe.elastic(resting_state(x));
    x(2, free[size_t(k)]) = -disturbance;
    const PerParticle3 behind = probe.elastic(resting_state(x));
    for (Eigen::Index j = 0; j < n; ++j)
      K(j, k) = (behind(2, free[size_t(j)]) - ahead(2, free[size_t(j)])) / (2 * disturbance);
    masses[k] = all_masses[free[size_t(k)]];
  }
  return modes_of(K, masses);
}

/// A mode of the flat strip in motion: the worst difference of its amplitude from that of the exact
/// solution of the undamped scheme, over the amplitude, in one and a half periods.
double worst_difference(const Subject& subject, const Scene& scene, const std::string& scheme,
                        int mode) {
  constexpr double amplitude = 3e-5;  // m
  const std::vector<int> free = free_particles(scene);
  const Modes modes = sheet_modes(Probe(subject, scene), scene, free);
  const Eigen::VectorXd shape = modes.vectors.col(mode - 1);  // shape.M shape = 1
  const PerParticle masses = lumped_masses(scene.mesh, scene.density);
  const double omega = std::sqrt(modes.values[mode - 1]);
  const double h = 1 / std::sqrt(modes.values.tail<1>()[0]);  // half of the limit
  const double scale = amplitude / shape.norm();

  Stepper stepper(subject, scene, scheme);
  State s = stepper.start();
  for (size_t k = 0; k < free.size(); ++k) s.x(2, free[k]) += scale * shape[Eigen::Index(k)];
  const int steps = int(3 * pi / (omega * h));
  Worst worst;
  for (int n = 1; n <= steps; ++n) {
    s = stepper.step(s, h);
    double coordinate = 0;
    for (size_t k = 0; k < free.size(); ++k)
      coordinate += masses[free[k]] * shape[Eigen::Index(k)] * s.x(2, free[k]) / scale;
    worst.observe(std::abs(coordinate - std::cos(2 * n * std::asin(omega * h / 2))));
  }
  return worst.value();
}

NamedFinding steps_keep_the_frequency(const Subject& subject) {
  const Scene scene = free_strip();
  Table differences("scheme; mode [1]; worst difference [of the amplitude]");
  for (const Integrator& integrator : paper_schemes())
    for (const int mode : {1, 2})
      differences.row(integrator.name, mode,
                      worst_difference(subject, scene, std::string(integrator.name), mode));
  return {"strip-vibration.schemes-preserve-the-frequency",
          "A free, undamped strip released in its first or second mode of the linear stiffness "
          "oscillates with that mode's frequency, lowered or raised only as the scheme's exact "
          "solution says.",
          judge_worst(differences, 1e-5,
                      "the strip's slopes are about 1e-4, so nonlinearity enters at their square; "
                      "differenced forces are good to 1e-6",
                      "exact for schemes A, B and C without damping: x_n = x_0 cos(2 n asin(omega "
                      "h/2)), one and a half periods")};
}

/// Frequencies of both modes on strips of ever more panels.
std::array<Table, 2> refined_modes(const Subject& subject, const std::vector<int>& sizes,
                                   const Progress& progress) {
  const Table empty("spacing of the rows [m]; omega [rad/s]; relative error [1]");
  std::array<Table, 2> modes = {empty, empty};
  for (const int panels : sizes) {
    const RowStrip strip(subject, strip_patterns()[0], panels, {}, {});
    const Eigen::Vector2d omega = frequencies(strip);
    for (const int mode : {0, 1})
      modes[size_t(mode)].row(strip.spacing(), omega[mode],
                              std::abs(omega[mode] / exact_frequency(mode + 1) - 1));
    progress(0.8 * double(modes[0].rows()) / double(sizes.size()));
  }
  return modes;
}

StudyResult run_strip_vibration(const Subject& subject, Tier tier, const Progress& progress) {
  std::vector<int> sizes = {8, 16, 32, 64};
  if (tier == Tier::full) sizes.push_back(128);
  StudyResult result;
  const std::array<Table, 2> modes = refined_modes(subject, sizes, progress);
  Figure figure{"frequency",
                "Frequencies of a clamped strip",
                {"spacing of the rows", "m", Scale::log},
                {"relative error of omega", "1", Scale::log},
                2,
                "Against the clamped-free beam with D = ke/4; the length counts from half a cell "
                "before the first hinges."};
  for (const size_t mode : {0, 1}) {
    result.findings.push_back(order_of(int(mode) + 1, modes[mode]));
    figure.curves.push_back(curve_of("mode " + std::to_string(mode + 1),
                                     convergence_of(modes[mode], "relative error")));
  }
  result.add({is_the_beam(modes), steps_keep_the_frequency(subject)});
  result.figures.push_back(std::move(figure));
  return result;
}

}  // namespace

Study strip_vibration_study() {
  return {"strip-vibration",
          "The two lowest frequencies of a clamped strip are those of the clamped-free beam with "
          "the mesh's own rigidity, to second order.",
          {"is-second-order", "matches-the-beam"},
          "BMF03 section 4",
          "The stiffness across a strip held cylindrical is taken from differences of the solver's "
          "forces, its masses from the area; the two lowest frequencies are compared with beta^2 "
          "sqrt(D/rho). A strip that is free to twist is released in one of its own modes and "
          "stepped by each scheme.",
          run_strip_vibration};
}

}  // namespace foldproof
