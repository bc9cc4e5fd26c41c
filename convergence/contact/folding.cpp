// folding: a strip between two ends that move together, with and without a limit on compression.
#include <cmath>

#include "convergence/contact/section_profile.h"
#include "convergence/study.h"
#include "convergence/contact/wrinkle_measure.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/random.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

constexpr int columns = 12;
constexpr double length = 0.2, edge = length / columns;  // of the strip and of its edges [m]
// between the clamps: from the middle of two columns, offset rows on average [m]
constexpr double clear = length - 1.5 * edge;
constexpr double nearer = 0.04;     // by how much the clamps come together [m]
constexpr double duration = 0.5;    // s
constexpr double tolerance = 1e-3;  // of the sweeps, in rest lengths [1]

struct Hinges {
  std::string name;
  double stiffness;  // ke [J]
};

/// A strip of equilateral triangles whose clamped ends come together.
struct Strip {
  double length;  // m
  int columns, rows;
  StretchMaterial stretch;
  double ke, relaxation;   // J, s: of the hinges, kd = ke relaxation
  double nearer, seconds;  // by how much, within which time [m], [s]
  double noise;            // m
  bool is_limited;         // to 0 % compression
};

Scene scene_of_strip(const Strip& strip) {
  const double edge = strip.length / strip.columns;
  Scene scene = scene_at_rest(
      make_sheet({SheetPattern::equilateral, strip.length, 0, strip.columns, strip.rows}), 0.2);
  scene.stretch = strip.stretch;
  add_flat_hinges(scene, strip.ke, strip.relaxation * strip.ke);
  if (strip.is_limited) {
    StrainLimits limits;
    limits.order = SweepOrder::alternating;
    limits.sweeps = 1000;
    limits.tolerance = tolerance;
    scene.strain_limits = limits;
  }
  Motion inwards;
  inwards.velocity = Vector3(strip.nearer / strip.seconds, 0, 0);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    if (scene.x(0, i) < 1.01 * edge) scene.prescribed.push_back({int(i), scene.x.col(i), inwards});
    if (scene.x(0, i) > strip.length - 1.01 * edge)
      scene.prescribed.push_back({int(i), scene.x.col(i), Motion{}});
  }
  Random random(8);
  scene.x += random.vectors(scene.x.cols(), strip.noise);
  for (PrescribedParticle& p : scene.prescribed) p.start = scene.x.col(p.particle);
  scene.schedule.end = strip.seconds;
  scene.schedule.frame_interval = strip.seconds / 10;
  return scene;
}

/// A run's last state.
struct FoldedSheet {
  std::string name;
  bool is_limited;
  double area_lost = nan;                        // over that at rest [1]
  double height = nan;                           // between the highest and the lowest particle [m]
  double wavelength = nan;                       // along the strip's middle, at rest [m]
  double steps = nan, sweeps = nan, left = nan;  // 1, 1 a step, over the rest length
};

FoldedSheet fold(const Hinges& hinges, bool is_limited) {
  const Scene scene = scene_of_strip({length,
                                      columns,
                                      5,
                                      {5, 0.002, 1},
                                      hinges.stiffness,
                                      0.005,
                                      nearer,
                                      duration,
                                      1e-6,
                                      is_limited});
  FoldedSheet result{hinges.name, is_limited};
  const RunResult run =
      simulate(build_system(scene), integrator_named("C"), start_state(scene), scene.schedule, {});
  if (run.stop) return result;
  const PerParticle3& x = run.last.x;
  const double at_rest = triangle_areas(scene.mesh.triangles, scene.mesh.rest).sum();
  const PerParticle z = x.row(2).transpose();
  constexpr int samples = 80;
  result.area_lost = 1 - triangle_areas(scene.mesh.triangles, x).sum() / at_rest;
  result.height = z.maxCoeff() - z.minCoeff();
  result.wavelength =
      dominant_wavelength(along(section_of(scene.mesh, 1), z, samples), length / (samples - 1));
  result.steps = double(run.steps);
  result.sweeps = double(run.work.strain_sweeps) / result.steps;
  result.left = run.work.strain_left;
  return result;
}

// ---- wrinkles: the same on an elastic bed, which lets cloth rise in short waves only

constexpr double bed_length = 0.3;  // of the strip on the bed [m]

/// A bed of springs under a long narrow strip, and the waves that it is pushed into.
struct WrinkledSheet {
  double bed = nan;         // K [N/m^3]
  double wavelength = nan;  // along the strip's middle, at rest [m]
  double expected = nan;    // 2 pi (D/K)^(1/4) [m]
  double height = nan;      // between the highest and the lowest particle [m]
};

/// -K z and critical drag for the bed alone, on each particle's part of the cloth. bed: K [N/m^3].
CustomForce elastic_bed(double bed, double density, const PerParticle& mass) {
  const PerParticle pull = bed / density * mass;                 // N/m
  const PerParticle drag = 2 * std::sqrt(bed / density) * mass;  // N s/m
  CustomForce force;
  force.elastic = [pull](const State& s, PerParticle3& f) {
    f.row(2) -= (pull.array() * s.x.row(2).transpose().array()).matrix().transpose();
  };
  force.damping = [=](const State&) -> DampingOperator::Custom {
    return {[=](const PerParticle3& v, PerParticle3& f) {
              f.row(2) -= (drag.array() * v.row(2).transpose().array()).matrix().transpose();
            },
            {}};
  };
  return force;
}

WrinkledSheet wrinkle(double wavelength) {
  // of a narrow strip of equilateral triangles [J]
  constexpr double ke = 1e-4, rigidity = 2. / 9 * ke;
  WrinkledSheet result;
  result.expected = wavelength;
  result.bed = rigidity * std::pow(2 * pi / wavelength, 4);
  const Scene scene = scene_of_strip(
      {bed_length, 24, 3, {1, 0.001, 1}, ke, 0.002, 0.05 * bed_length, 0.4, 1e-5, true});
  System system = build_system(scene);
  system.forces.push_back(elastic_bed(result.bed, scene.density, system.mass));
  const RunResult run =
      simulate(system, integrator_named("C"), start_state(scene), scene.schedule, {});
  if (run.stop) return result;
  const PerParticle z = run.last.x.row(2).transpose();
  constexpr int samples = 120;
  result.height = z.maxCoeff() - z.minCoeff();
  result.wavelength =
      dominant_wavelength(along(section_of(scene.mesh, 1), z, samples), bed_length / (samples - 1));
  return result;
}

Table evidence_of(const std::vector<WrinkledSheet>& runs) {
  Table table{{"bed", "N/m^3"}, {"wavelength", "mm"}, {"2 pi (D/K)^(1/4)", "mm"}, {"height", "mm"}};
  for (const WrinkledSheet& run : runs)
    table.row(run.bed, 1e3 * run.wavelength, 1e3 * run.expected, 1e3 * run.height);
  return table;
}

NamedFinding wavelength_finding(const std::vector<WrinkledSheet>& runs) {
  Worst worst;
  for (const WrinkledSheet& run : runs)
    worst.observe(run.height > 1e-3 ? std::abs(run.wavelength / run.expected - 1) : nan);
  return {"folding.wrinkle-length-matches-theory",
          "With 0 % compression, a strip on an elastic bed folds into waves of length 2 pi "
          "(D/K)^(1/4), those of the least energy, to a sixth.",
          {{worst.value(), 1. / 6, 0, "1",
            "the spectrum has whole waves only, five and three in the strip: half a wave in three"},
           evidence_of(runs),
           "waves lower than a millimetre count as none"}};
}

Table evidence_of(const std::vector<FoldedSheet>& runs) {
  Table table{{"hinges", ""},         {"limit on compression", ""}, {"area lost", "1"},
              {"height", "mm"},       {"wavelength", "mm"},         {"steps", "1"},
              {"sweeps a step", "1"}, {"violation left", "1"}};
  for (const FoldedSheet& run : runs)
    table.row(run.name, run.is_limited ? "0 %" : "none", run.area_lost, 1e3 * run.height,
              1e3 * run.wavelength, run.steps, run.sweeps, run.left);
  return table;
}

NamedFinding area_finding(const std::vector<FoldedSheet>& runs) {
  Worst worst;
  for (const FoldedSheet& run : runs)
    if (run.is_limited) worst.observe(run.area_lost);
  return {"folding.limit-preserves-area",
          "With 0 % compression, a strip between ends that move together loses none of its area.",
          {{worst.value(), 2 * tolerance, 0, "of the area",
            "an acute triangle whose edges are no shorter than at rest, and no longer by more than "
            "a tenth, is no smaller; each edge may be short by the tolerance of the sweeps"},
           evidence_of(runs)}};
}

NamedFinding lost_finding(const std::vector<FoldedSheet>& runs) {
  const FoldedSheet& run = runs[1];  // stiff hinges, no limit
  const double least = 0.5 * nearer / length;
  return {"folding.area-is-lost-without-the-limit",
          "Without the limit, a strip whose hinges are stiff beside its springs stays in its plane "
          "and is compressed.",
          {{least / run.area_lost, 1, 0, "1",
            "measured is half the share by which the clamps come together, over the area lost: "
            "Poisson's ratio gives a third of it back"},
           evidence_of(std::vector{run})}};
}

/// The height, from trough to crest, of a cosine wave of this length [m] whose ends have come
/// nearer by so much [m], by bisection on its arc.
double cosine_height(double arc, double shortening) {
  const double span = arc - shortening;
  double low = 0, high = arc;
  for (int i = 0; i < 60; ++i) {
    const double height = (low + high) / 2;
    double sum = 0;
    constexpr int parts = 2000;
    for (int k = 0; k < parts; ++k)
      sum +=
          std::hypot(1, pi * height / span * std::sin(2 * pi * (k + 0.5) / parts)) * span / parts;
    (sum < arc ? low : high) = height;
  }
  return (low + high) / 2;
}

NamedFinding height_finding(const std::vector<FoldedSheet>& runs) {
  const FoldedSheet& run = runs[0];  // stiff hinges, 0 %
  const double expected = cosine_height(clear, nearer);
  return {"folding.arc-height-matches-its-length",
          "With 0 % compression, a strip of stiff hinges rises in one arc, as high as an arc of "
          "the strip's rest length.",
          {{std::abs(run.height / expected - 1), edge / (2 * clear), 0, "1",
            "the clamps, two columns of offset rows, leave the free length uncertain by half an "
            "edge; the arc is approximated by a cosine. A strip that is compressed stays flat"},
           evidence_of(std::vector{run})}};
}

StudyResult run_folding(const Subject&, Tier tier, const Progress& progress) {
  std::vector<Hinges> all = {{"stiff", 4.1e-3}, {"soft", 1e-6}};
  if (tier == Tier::full) all.push_back({"hardly any", 1e-8});
  std::vector<FoldedSheet> runs;
  for (const Hinges& hinges : all)
    for (const bool is_limited : {true, false}) {
      runs.push_back(fold(hinges, is_limited));
      progress(double(runs.size()) / double(2 * all.size()));
    }
  std::vector<WrinkledSheet> waves;
  for (const double wavelength : {0.06, 0.1}) waves.push_back(wrinkle(wavelength));
  return {{area_finding(runs), lost_finding(runs), height_finding(runs), wavelength_finding(waves)},
          {},
          {},
          {{"wrinkles", "What becomes of a long strip on an elastic bed", evidence_of(waves)},
           {"strips", "A strip whose ends move together by a fifth", evidence_of(runs)}}};
}

}  // namespace

Study folding_study() {
  return {"folding",
          "Cloth that may not be compressed folds and loses no area; without the limit it is "
          "compressed where its hinges are stiffer than its springs.",
          {"limit-preserves-area", "arc-height-matches-its-length", "wrinkle-length-matches-theory",
           "area-is-lost-without-the-limit"},
          "BMF03 section 3, after Provot 1995",
          "The clamped ends of a strip are moved together by a fifth of its length within half a "
          "second. With stiff hinges Euler's strain 4 pi^2 D/(Y L^2) is a quarter: the strip "
          "prefers compression. With soft ones it folds anyway. Wavelengths are those of the "
          "largest Fourier coefficient along the middle of the strip, in lengths at rest.",
          run_folding};
}

}  // namespace foldproof
