// hanging-chain: limp strips between two points, against the catenary, and how they swing.

#include "convergence/validation/comparison.h"
#include "convergence/study.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/chains_and_ribbons.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

constexpr double chain_resolution = 0.01;  // of each number [1]
constexpr double length = 0.61;            // L [m]
constexpr double density = 0.17;           // kg/m^2
constexpr double g = 9.80665;              // m/s^2

/// A strip of alternating squares along x, two cells wide, without bending, its springs stretched
/// by a ten-thousandth of its length per weight.
Scene limp_strip(int cells) {
  const double cell = length / cells;
  Scene scene =
      scene_at_rest(make_sheet({SheetPattern::alternating, length, 2 * cell, cells, 2}), density);
  scene.stretch = StretchMaterial{1e4 * density * g * length, 0, 1};
  scene.gravity = Vector3(0, 0, -g);
  return scene;
}

int row_of(const Scene& scene, Eigen::Index i, int cells) {
  return int(std::lround(scene.mesh.rest(0, i) / length * cells));
}

/// Mean places of rows.
Eigen::Matrix3Xd rows_of(const Scene& scene, const PerParticle3& x, int cells) {
  Eigen::Matrix3Xd rows = Eigen::Matrix3Xd::Zero(3, cells + 1);
  for (Eigen::Index i = 0; i < x.cols(); ++i) rows.col(row_of(scene, i, cells)) += x.col(i) / 3;
  return rows;
}

struct AtRest {
  State state;
  double speed;  // what is left, over that of a fall by the length [1]
};

/// Backward Euler's own damping brings it to rest.
AtRest settle(Stepper& stepper, State s) {
  const double fall = std::sqrt(2 * g * length), h = 0.3 * length / fall;
  double speed = 1;
  for (int k = 0; k < 600 && !(speed < 1e-7); ++k) {
    s = stepper.step(s, h);
    speed = s.v.colwise().norm().maxCoeff() / fall;
  }
  return {s, speed};
}

// ---- between two points

struct HungTest {
  const char *name, *words;
  oracles::HungChain chain;
};
constexpr HungTest hung_tests[] = {{"level", "two points at one height", {0.8, 0}},
                                   {"slanting", "two points at two heights", {0.6, 0.35}}};

/// The lowest point below the first end and the pulls on the first end, over L and the weight.
struct HungStrip {
  double sag, pull_across, pull_up, speed;
  Eigen::Matrix3Xd rows;  // over L
};

/// The lowest point of the parabola through the lowest row and its neighbours.
double lowest_of(const Eigen::Matrix3Xd& rows) {
  Eigen::Index low = 1;
  for (Eigen::Index i = 1; i + 1 < rows.cols(); ++i)
    if (rows(2, i) < rows(2, low)) low = i;
  const Eigen::Vector3d a = rows.col(low - 1), b = rows.col(low), c = rows.col(low + 1);
  // z over x, by divided differences, as the rows are not evenly spaced across
  const double first = (b.z() - a.z()) / (b.x() - a.x()),
               second = ((c.z() - b.z()) / (c.x() - b.x()) - first) / (c.x() - a.x());
  const double x = (a.x() + b.x()) / 2 - first / (2 * second);
  return a.z() + first * (x - a.x()) + second * (x - a.x()) * (x - b.x());
}

HungStrip hung(const Subject& subject, const HungTest& test, int cells) {
  Scene scene = limp_strip(cells);
  const oracles::HungChain& chain = test.chain;
  // starts as a parabola through the two points, of about the right length
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double at = double(row_of(scene, i, cells)) / cells;
    scene.x(0, i) = chain.across * at * length;
    scene.x(2, i) = (chain.up * at - 1.2 * at * (1 - at)) * length;
    if (at == 0 || at == 1) scene.prescribed.push_back({int(i), scene.x.col(i), Motion{}});
  }
  Stepper stepper(subject, scene, "linear-backward-euler");
  const AtRest rest = settle(stepper, stepper.start());
  HungStrip strip{0, 0, 0, rest.speed, rows_of(scene, rest.state.x, cells) / length};
  strip.sag = strip.rows(2, 0) - lowest_of(strip.rows);
  const PerParticle3 force = stepper.elastic_forces(rest.state);
  const double weight = density * length * 2 * length / cells * g;
  for (Eigen::Index i = 0; i < force.cols(); ++i)
    if (row_of(scene, i, cells) == 0) {
      strip.pull_across += force(0, i) / weight;
      strip.pull_up += force(2, i) / weight;
    }
  return strip;
}

NamedFinding shape_agrees(const Subject& subject, const HungTest& test, Tier tier, Figure& shapes) {
  std::vector<int> cells{16, 32, 64};
  if (tier == Tier::full) cells.push_back(128);
  Ladder sags, across, up;
  HungStrip strip;
  for (const int count : cells) {
    strip = hung(subject, test, count);
    sags.values.push_back(strip.sag);
    across.values.push_back(strip.pull_across);
    up.values.push_back(strip.pull_up);
    for (Ladder* ladder : {&sags, &across, &up}) update_worst(ladder->floor, 1e3 * strip.speed);
  }
  const oracles::Catenary catenary = oracles::catenary(test.chain, linear_range(0, 1, 2001));
  double lowest = 0;
  for (const oracles::CatenaryPoint& point : catenary.points) lowest = std::min(lowest, point.up);
  Table table = no_comparisons("1");
  const auto compare = [&](const char* words, const Ladder& ladder, const Estimate& should) {
    add_comparison(table, compare_ladder(words, ladder, should), chain_resolution);
  };
  // the lowest of 2001 points is above the lowest by a millionth at most
  compare("sag below the first end over L", sags, {-lowest, catenary.uncertainty + 1e-6});
  compare("pull across over the weight", across, catenary.pull_across);
  compare("pull up over the weight", up, catenary.pull_up);
  Curve exact{std::string("catenary, ") + test.words},
      simulated{std::string("simulated, ") + test.words};
  for (std::size_t i = 0; i < catenary.points.size(); i += 20)
    exact.point(catenary.points[i].across, catenary.points[i].up);
  for (Eigen::Index i = 0; i < strip.rows.cols(); i += 4)
    simulated.point(strip.rows(0, i), strip.rows(2, i));
  shapes.curves.push_back(exact);
  shapes.curves.push_back(simulated);
  return {fmt::format("hanging-chain.sag-and-pull-agree.{}", test.name),
          fmt::format("A limp strip between {} sags and pulls as a catenary does, within one "
                      "percent of its length and weight.",
                      test.words),
          judge_comparisons(std::move(table), chain_resolution,
                            "a hundredth of the length, which a ruler reads, and of the weight",
                            "S at the finest mesh")};
}

// ---- from one end

struct Swing {
  Eigen::VectorXd frequencies;  // over sqrt(g/L), ascending
  double speed;
};

/// Rows swing as one across the strip's plane; their stiffness by central differences of forces.
Swing swing_of(const Subject& subject, int cells) {
  Scene scene = limp_strip(cells);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double along = scene.mesh.rest(0, i);
    scene.x.col(i) = Vector3(0, scene.mesh.rest(1, i), -along);
    if (row_of(scene, i, cells) == 0) scene.prescribed.push_back({int(i), scene.x.col(i), {}});
  }
  Stepper stepper(subject, scene, "linear-backward-euler");
  const AtRest rest = settle(stepper, stepper.start());
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(cells, cells);
  Eigen::VectorXd masses = Eigen::VectorXd::Zero(cells);
  const double shift = 1e-7 * length;
  // every fifth row moves at once: a row feels its neighbours alone
  const auto forces = [&](int first, double by) {
    State s = rest.state;
    for (Eigen::Index i = 0; i < s.x.cols(); ++i) {
      const int row = row_of(scene, i, cells);
      if (row > 0 && row % 5 == first) s.x(0, i) += by;
    }
    return stepper.elastic_forces(s);
  };
  for (int first = 0; first < 5; ++first) {
    const PerParticle3 change = forces(first, shift) - forces(first, -shift);
    for (Eigen::Index i = 0; i < change.cols(); ++i) {
      const int felt = row_of(scene, i, cells);
      if (felt == 0) continue;
      const int moved = felt - (felt - first + 7) % 5 + 2;  // the nearest that moves
      if (moved > 0 && moved <= cells) K(felt - 1, moved - 1) -= change(0, i) / (2 * shift);
    }
  }
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
    if (const int row = row_of(scene, i, cells); row > 0) masses[row - 1] += mass[i];
  const Eigen::MatrixXd symmetric = (K + K.transpose()) / 2;
  return {oracles::symmetric_modes(symmetric, masses).values.cwiseSqrt() * std::sqrt(length / g),
          rest.speed};
}

std::vector<NamedFinding> frequencies_agree(const Subject& subject, Tier tier) {
  std::vector<int> cells{32, 64, 128};
  if (tier == Tier::full) cells.push_back(256);
  constexpr int modes = 3;
  std::array<Ladder, modes> ladders;
  for (const int count : cells) {
    const Swing swing = swing_of(subject, count);
    for (int k = 0; k < modes; ++k) {
      ladders[std::size_t(k)].values.push_back(swing.frequencies[k]);
      update_worst(ladders[std::size_t(k)].floor, 1e-6 + 1e2 * swing.speed);
    }
  }
  std::vector<NamedFinding> findings;
  for (int k = 0; k < modes; ++k) {
    const oracles::Estimate should = oracles::chain_frequency_by_series(k + 1);
    const double scale = chain_resolution * should.value;
    findings.push_back(
        {fmt::format("hanging-chain.frequency-agrees.mode-{}", k + 1),
         fmt::format("A limp strip that hangs from one end swings in mode {} as often as a chain, "
                     "within one percent.",
                     k + 1),
         judge_comparison(
             compare_ladder("frequency over sqrt(g/L)", ladders[std::size_t(k)], should), scale,
             "a hundredth of the frequency",
             "S from the forces' derivatives at the finest mesh, angular")});
  }
  return findings;
}

StudyResult run_hanging_chain(const Subject& subject, Tier tier, const Progress& progress) {
  StudyResult result;
  Figure shapes{"shapes",
                "Limp strips between two points",
                {"across from the first point", "L"},
                {"height over the first point", "L"},
                "Every fourth row of the finest mesh beside the catenary, to scale."};
  for (const HungTest& test : hung_tests) {
    result.findings.push_back(shape_agrees(subject, test, tier, shapes));
    progress(double(result.findings.size()) / 3);
  }
  result.add(frequencies_agree(subject, tier));
  progress(1);
  result.figures.push_back(std::move(shapes));
  return result;
}

}  // namespace

Study hanging_chain_study() {
  return {
      "hanging-chain",
      "A strip without bending sags and pulls between two points as a catenary does, and swings "
      "from one point as often as a chain.",
      {"sag-and-pull-agree", "frequency-agrees"},
      "our test of springs and gravity: catenary, and Bernoulli's hanging chain",
      "A strip two cells wide is held by its end rows and brought to rest by backward Euler. Its "
      "springs give by a ten-thousandth of its length per weight. S is the sag, the pull on a held "
      "row, or the frequency of rows that swing as one, at the finest of three meshes (four in the "
      "full tier) of 16, 32, 64 cells along, twice as many for the frequencies; D is the catenary "
      "by hyperbolic functions and half the roots of Bessel's J0, which checks hold against GSL.",
      run_hanging_chain,
      "validation"};
}

}  // namespace foldproof
