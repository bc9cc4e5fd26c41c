// buckling: the load at which a compressed strip leaves its plane, and how fast it does so beyond.

#include "convergence/study.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

constexpr double edge = 0.01;        // m
constexpr double young = 100;        // Y [N/m]
constexpr double bending = 1.37e-3;  // ke [J]
constexpr double density = 0.2;      // kg/m^2
constexpr int columns = 2;

/// A strip of equilateral triangles between two clamps of two held rows each.
struct Strip {
  int rows;
  double strain;  // by which it is shortened [1]

  double row() const { return std::sqrt(0.75) * edge; }  // m
  // from half a row before each clamp's line [m]
  double length() const { return (rows - 1) * row(); }
  double width() const { return columns * edge; }  // m
};

/// Shortened along y, and widened by Poisson's ratio 1/3 so that no force remains but along y.
Scene scene_of_strip(const Strip& strip) {
  Scene scene = scene_at_rest(
      make_sheet({SheetPattern::equilateral, strip.width(), 0, columns, strip.rows}), density);
  scene.stretch = StretchMaterial{young, 0.01, 1};
  add_flat_hinges(scene, bending, 0);
  scene.x.row(0) *= 1 + strip.strain / 3;
  scene.x.row(1) *= 1 - strip.strain;
  for (int i = 0; i < scene.mesh.particles(); ++i) {
    const double row = scene.mesh.rest(1, i) / strip.row();
    if (row < 1.5 || row > strip.rows - 1.5) scene.prescribed.push_back({i, scene.x.col(i), {}});
  }
  return scene;
}

/// A strip at rest in its plane under the compression, and what its forces say there.
struct CompressedStrip {
  State rest;
  double load;  // N/m
  // the least eigenvalue of M^{-1/2} K_zz M^{-1/2}, K_zz across the plane [1/s^2]
  double stiffness;
  PerParticle mode;  // its displacement along z, N [m]; zero where held
};

/// Lets the motion in the plane die out: springs are damped, and nothing leaves the plane exactly.
State settle(Stepper& stepper) {
  constexpr double h = 1e-4;  // s: a third of the elastic limit
  constexpr int steps = 800;
  State s = stepper.run(stepper.start(), h, steps);
  s.v.setZero();
  return s;
}

/// M^{-1/2} K_zz M^{-1/2} over the free particles, by central differences of the subject's
/// forces [1/s^2].
Eigen::MatrixXd stiffness_across(const Stepper& stepper, State s) {
  constexpr double shift = 1e-8;  // m
  const Scene& scene = stepper.scene();
  const std::vector<int> free = free_particles(scene);
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  Eigen::MatrixXd matrix(free.size(), free.size());
  for (size_t j = 0; j < free.size(); ++j) {
    s.x(2, free[j]) = shift;
    const PerParticle3 ahead = stepper.elastic_forces(s);
    s.x(2, free[j]) = -shift;
    const PerParticle3 behind = stepper.elastic_forces(s);
    s.x(2, free[j]) = 0;
    for (size_t i = 0; i < free.size(); ++i)
      matrix(Eigen::Index(i), Eigen::Index(j)) = (behind(2, free[i]) - ahead(2, free[i])) /
                                                 (2 * shift) /
                                                 std::sqrt(mass[free[i]] * mass[free[j]]);
  }
  return (matrix + matrix.transpose()) / 2;
}

CompressedStrip compress(const Subject& subject, const Strip& strip) {
  Stepper stepper(subject, scene_of_strip(strip), "C");
  const Scene& scene = stepper.scene();
  CompressedStrip result{settle(stepper), 0, 0, PerParticle::Zero(scene.mesh.particles())};
  const PerParticle3 force = stepper.elastic_forces(result.rest);
  for (int i = 0; i < scene.mesh.particles(); ++i)  // what the lower clamp holds back
    if (scene.mesh.rest(1, i) < 1.5 * strip.row()) result.load -= force(1, i) / strip.width();

  const oracles::SymmetricModes modes =
      oracles::symmetric_modes(stiffness_across(stepper, result.rest));
  result.stiffness = modes.values[0];
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  const std::vector<int> free = free_particles(scene);
  for (size_t i = 0; i < free.size(); ++i)
    result.mode[free[i]] = modes.vectors(Eigen::Index(i), 0) / std::sqrt(mass[free[i]]);
  result.mode.normalize();
  return result;
}

/// The strain at which the stiffness against the slowest mode vanishes, by the secant rule: it is
/// nearly linear in the strain.
Strip critical_strip(const Subject& subject, int rows) {
  const double euler = pi * pi * bending / (std::pow(Strip{rows, 0}.length(), 2) * young);
  Strip before{rows, 0.6 * euler}, strip{rows, 0.9 * euler};
  double stiffness_before = compress(subject, before).stiffness;
  for (int i = 0; i < 4; ++i) {
    const double stiffness = compress(subject, strip).stiffness;
    const double next =
        strip.strain - stiffness * (strip.strain - before.strain) / (stiffness - stiffness_before);
    if (!(std::abs(next - strip.strain) > 1e-9 * euler)) break;
    before = strip;
    stiffness_before = stiffness;
    strip.strain = next;
  }
  return strip;
}

/// Critical strains and loads, mesh by mesh; D/ke at the critical load N = 4 pi^2 D/L^2 of a strip
/// clamped at both ends.
NamedFinding load_finding(const Table& found) {
  constexpr double narrow = 2.0 / 9,
                   cylinder = 1.0 / 4;  // D/ke of equilateral triangles: free edges, cylinder
  const double finest_rows = found.numbers("rows").back(),
               finest = found.numbers("rigidity D").back();
  const double discrete = cylinder * std::pow(2 * pi / (finest_rows - 1), 2) / 12;
  const double over = finest - cylinder, under = narrow - finest;
  Worst outside;
  outside.observe(over);
  outside.observe(under);
  return {"buckling.load-matches-euler",
          "A strip of equilateral triangles between clamps buckles at Euler's load 4 pi^2 D/L^2, "
          "its rigidity D between 2/9 ke (free edges) and 1/4 ke (bent to a cylinder).",
          {{outside.value(), discrete, 0, "ke",
            "outside the two rigidities by at most the share of a cosine's curvature that n rows "
            "miss, (2 pi/(n - 1))^2/12, on the finest mesh"},
           found,
           "measured is the distance from the range, 0 within it"}};
}

/// The amplitude of the mode over time beyond the critical load, and its rate of growth.
struct Growth {
  Table history{{"time", "s"}, {"amplitude", "m"}};
  double expected, measured;  // 1/s
};

Growth growth_beyond(const Subject& subject, const Strip& strip) {
  const CompressedStrip at = compress(subject, strip);
  Stepper stepper(subject, scene_of_strip(strip), "C");
  Growth growth{.expected = std::sqrt(-at.stiffness), .measured = nan};
  State s = at.rest;
  s.x.row(2) += 1e-9 * at.mode.transpose();
  s.v.row(2) += growth.expected * 1e-9 * at.mode.transpose();
  const double h = 1e-4, duration = 5 / growth.expected;  // s
  const int steps = int(duration / h);
  for (int i = 0; i <= steps; ++i) {
    if (i % (steps / 20) == 0) growth.history.row(i * h, s.x.row(2).dot(at.mode));
    s = stepper.step(s, h);
  }
  const std::vector<double>& amplitudes = growth.history.numbers("amplitude");
  growth.measured =
      std::log(amplitudes.back() / amplitudes.front()) / growth.history.numbers("time").back();
  return growth;
}

NamedFinding growth_finding(const Growth& growth) {
  return {"buckling.grows-at-the-linearised-rate",
          "Beyond the critical load a disturbance grows as exp(sigma t), where -sigma^2 is the "
          "negative eigenvalue of the linearised forces.",
          {{std::abs(growth.measured / growth.expected - 1), 0.01, 0, "1",
            "a wrong mass, load or rigidity shifts the rate by more; the schemes add (sigma "
            "h)^2/24, a millionth"},
           growth.history,
           "measured is the relative error of the rate"}};
}

Figure growth_figure(const Growth& growth) {
  Figure figure{"growth",
                "A strip leaves its plane at 1.4 times the critical strain",
                {"time", "s"},
                {"amplitude of the buckling mode", "m", Scale::log},
                "A straight line is exponential growth; the expected one follows from the forces' "
                "eigenvalue.",
                {curve_of("simulated", growth.history, "time", "amplitude")}};
  const double start = growth.history.numbers("amplitude").front();
  figure.curves.push_back(curve_over("expected", growth.history.numbers("time"), [&](double t) {
    return start * std::exp(growth.expected * t);
  }));
  return figure;
}

StudyResult run_buckling(const Subject& subject, Tier tier, const Progress& progress) {
  std::vector<int> meshes = {10, 20};
  if (tier == Tier::full) meshes.push_back(40);
  Table found("rows [1]; critical strain [1]; critical load [N/m]; rigidity D [ke]");
  Strip critical{0, 0};
  for (const int rows : meshes) {
    critical = critical_strip(subject, rows);
    const double load = compress(subject, critical).load;
    found.row(rows, critical.strain, load,
              load * std::pow(critical.length(), 2) / (4 * pi * pi * bending));
    progress(double(found.rows()) / double(meshes.size() + 1));
  }
  const Growth growth = growth_beyond(subject, {critical.rows, 1.4 * critical.strain});
  progress(1);
  return {{load_finding(found), growth_finding(growth)}, {growth_figure(growth)}, {}, {}};
}

}  // namespace

Study buckling_study() {
  return {"buckling",
          "A compressed strip buckles out of its plane at Euler's load, with a rigidity between "
          "those of its mesh with free edges and bent to a cylinder; beyond that load the buckle "
          "grows at the rate of the linearised forces.",
          {"load-matches-euler", "grows-at-the-linearised-rate"},
          "our test of BMF03 section 4",
          "A strip of equilateral triangles is shortened between two clamps; motion in its plane "
          "dies out, and none leaves it. Central differences of the forces normal to the plane "
          "give the stiffness against buckling. The critical load is the clamp's force at the "
          "strain where this stiffness vanishes.",
          run_buckling};
}

}  // namespace foldproof
