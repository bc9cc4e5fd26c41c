// Cost of self-collision, and the effect of thickness, step and rounds on the result.

#include "convergence/study.h"
#include "reference/filters/pair_search.h"
#include "reference/mesh/shapes.h"
#include "verification/processor_time.h"
#include "verification/specimens/layered_cloth.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

/// Flat sheets above each other, within the thickness, n x n particles each, cells of 1 cm.
TriangleMesh stacked_sheets(int n, int layers, double gap) {
  Sheet sheet;
  sheet.pattern = SheetPattern::equilateral;
  sheet.width = 0.01 * (n - 1);
  sheet.height = 0.01 * (n - 1);
  sheet.columns = sheet.rows = n - 1;
  const TriangleMesh one = make_sheet(sheet);
  PerParticle3 rest(3, one.rest.cols() * layers);
  std::vector<Triangle> triangles;
  for (int k = 0; k < layers; ++k) {
    const int first = int(k * one.rest.cols());
    rest.middleCols(first, one.rest.cols()) =
        one.rest.colwise() + Vector3(0.0013 * k, 0.0021 * k, gap * k);
    for (const Triangle& t : one.triangles)
      triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return make_triangle_mesh(std::move(rest), std::move(triangles));
}

/// The search for close pairs in stacks of sheets: boxes compared, and the least
/// processor time of five.
Table searches() {
  return {{"layers", "1"},
          {"particles", "1"},
          {"close pairs", "1"},
          {"box tests", "1"},
          {"processor time", "s"}};
}

void add_search(int n, int layers, Table& searches) {
  const TriangleMesh mesh = stacked_sheets(n, layers, 0.0015);
  const ClothTree cloth = make_cloth_tree(mesh);
  PairSearch search;
  double least = INFINITY;
  for (int k = 0; k < 5; ++k) {
    const double start = processor_seconds();
    search = counted_near_pairs(cloth, mesh.rest, mesh.rest, 0.002);
    least = std::min(least, processor_seconds() - start);
  }
  searches.row(layers, mesh.particles(), search.pairs.size(), search.box_tests, least);
}

/// The exponent of growth of a column with the particles, from the first row to the last.
double growth(const Table& of, std::string_view column) {
  const std::vector<double>&counts = of.numbers(column), &particles = of.numbers("particles");
  return std::log(counts.back() / counts.front()) / std::log(particles.back() / particles.front());
}

/// The exponent of n log n over the same particles.
double growth_with_depth(const Table& of) {
  const std::vector<double>& particles = of.numbers("particles");
  const double first = std::log(particles.front()), last = std::log(particles.back());
  return 1 + std::log(last / first) / (last - first);
}

NamedFinding search_work(const Table& by_size) {
  Table evidence = with_columns(by_size, {"particles"});
  evidence.add({"pairs", "1", by_size.numbers("close pairs")});
  evidence.add(by_size.column("box tests"));
  evidence.add(by_size.column("processor time"));
  return {"self-collision-cost.search-work-is-nearly-linear",
          "In two layers the search for close pairs compares boxes nearly in proportion to the "
          "number of particles.",
          {{growth(by_size, "box tests"), growth_with_depth(by_size), 0, "1",
            "the exponent of n log n over these particles: each has the same number of neighbours, "
            "and the tree is as deep as the logarithm of n"},
           std::move(evidence),
           "box tests repeat to the last one; the processor times, the least of five searches, "
           "stand beside them and are not judged"}};
}

void add_searches(Tier tier, StudyResult& result) {
  Table by_size = searches(), by_layers = searches();
  for (const int n : {23, 45, 71, 141}) add_search(n, 2, by_size);
  if (tier == Tier::full) add_search(224, 2, by_size);
  for (const int layers : {1, 2, 4, 8}) add_search(45, layers, by_layers);
  result.findings.push_back(search_work(by_size));
  result.figures.push_back({"search",
                            "The search for close pairs, two layers",
                            {"particles", "1", Scale::log},
                            {"box tests", "1", Scale::log},
                            1,
                            "Pairs of boxes that one search compares, against particles.",
                            {curve_of("search", by_size, "particles", "box tests")}});
  result.tables.push_back(
      {"layers", "The search for close pairs in stacks of 2025 particles a layer", by_layers});
}

/// How many particles move in zones, after so many rounds of impulses, in layers that fly
/// through each other.
void add_zones(const Subject& subject, StudyResult& result) {
  Table rounds("rounds [1]; zones [1]; particles in zones [1]; impulses [1]");
  for (const int count : {1, 2, 4, 8, 16}) {
    Work work;
    for (const unsigned seed : {31u, 32u, 33u}) {
      const Scene scene = layered_scene({4, 0.003, 0.001, 3, {0.002, 0, 0.2, count, true}, seed});
      const auto prepared = require_offered(subject.prepare, "prepare")(scene);
      const State start = start_state(scene);
      require_offered(subject.step, "step")(*prepared, {&start, 1}, 0.004, work);
    }
    rounds.row(count, work.zones, work.zone_particles, work.crossings);
  }
  const std::vector<double>& particles = rounds.numbers("particles in zones");
  result.findings.push_back({"self-collision-cost.impulse-rounds-reduce-rigid-zones",
                             "Rounds of impulses leave less to rigid zones.",
                             {{particles[3] / particles[0], 0.5, 0, "1",
                               "each round resolves pairs that would otherwise be merged into "
                               "zones: eight rounds leave less than half of what one leaves"},
                              rounds,
                              "Three steps of four layers of 42 particles each that fly through "
                              "each other at 3 m/s, 4 ms long."}});
  result.tables.push_back(
      {"zones", "Particles left to rigid zones after so many rounds of impulses, of 504", rounds});
}

/// The mean gap under a sheet that has come to rest on a held one [m].
double resting_gap(const Subject& subject, double thickness, double h) {
  Scene scene = layered_scene({2, 1.1 * thickness, 0, 0, {thickness, 8, 0.3, 8, true}, 7});
  scene.gravity = Vector3(0, 0, -9.81);
  scene.stretch = StretchMaterial{20, 0.02, 1};
  for (int i = 0; i < 42; ++i) scene.prescribed.push_back({i, scene.x.col(i), Motion{}});
  Stepper stepper(subject, scene, "C");
  const State end = stepper.run(stepper.start(), h, int(std::lround(0.3 / h)));
  return end.x.rightCols(42).row(2).mean();
}

void add_rest(const Subject& subject, StudyResult& result) {
  Table gaps("thickness [m]; step [s]; gap at rest [m]");
  Worst spread, outside;
  for (const double thickness : {0.002, 0.003, 0.004}) {
    double least = INFINITY, most = 0;
    for (const double h : {0.001, 0.002}) {
      const double gap = resting_gap(subject, thickness, h);
      gaps.row(thickness, h, gap);
      least = std::min(least, gap);
      most = std::max(most, gap);
      outside.observe(std::max(gap / thickness, 0.5 * thickness / gap));
    }
    spread.observe((most - least) / thickness);
  }
  result.findings.push_back(
      {"self-collision-cost.sheet-rests-within-the-thickness",
       "A sheet comes to rest on another at half of the thickness or more, and at no more than it.",
       {{outside.value(), 1, 0, "1",
         "above the thickness nothing supports it; repulsion springs carry its weight at a small "
         "part of the overlap, and half of the overlap is left for the impact"},
        gaps}});
  result.findings.push_back(
      {"self-collision-cost.gap-does-not-depend-on-the-step",
       "The gap at which a sheet rests on another does not depend on the step.",
       {{spread.value(), 0.05, 0, "1",
         "one step of free fall adds g h^2, 0.02 of the least thickness for the longest step; as "
         "much again for the phase of the last bounce makes 0.04, rounded up"},
        gaps}});
}

}  // namespace

Study self_collision_cost_study() {
  return {"self-collision-cost",
          "With two layers the search for close pairs compares boxes nearly in proportion to the "
          "particles; layers come to rest between half and the whole of the thickness apart.",
          {"search-work-is-nearly-linear", "sheet-rests-within-the-thickness"},
          "BMF03 section 5; Bridson, Fedkiw, Anderson 2002",
          "Sheets in layers: the cost of the search for close pairs by particles and layers, how "
          "much rounds of impulses leave to rigid zones, and the distance at which layers come to "
          "rest by thickness and step.",
          [](const Subject& subject, Tier tier, const Progress& progress) {
            StudyResult result;
            add_searches(tier, result);
            progress(0.4);
            add_zones(subject, result);
            progress(0.5);
            add_rest(subject, result);
            return result;
          }};
}

}  // namespace foldproof
