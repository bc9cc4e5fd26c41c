// Comparisons with measurements: drapes and wrinkles.
#include <catch2/catch.hpp>

#include "convergence/contact/wrinkle_measure.h"
#include "convergence/study.h"
#include "convergence/validation/comparison.h"
#include "convergence/validation/drape_test.h"
#include "reference/bodies/level_set_provider.h"
#include "verification/files/stored_run_file.h"
#include "verification/files/trajectory_file.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/subject.h"

using namespace foldproof;

TEST_CASE("a comparison agrees, differs or cannot tell, by both uncertainties together") {
  const auto of = [](double simulated, double numerical, double scatter) {
    return agreement_of({"", simulated, numerical, {5, scatter}}, .7);
  };
  CHECK(of(5.4, .3, .4) == Agreement::agrees);  // u = .5
  CHECK(of(4.6, .3, .4) == Agreement::agrees);
  CHECK(of(5.6, .3, .4) == Agreement::differs);
  CHECK(of(4.4, .3, .4) == Agreement::differs);
  CHECK(of(5.6, .6, .8) == Agreement::cannot_tell);  // u = 1
  CHECK(of(6.1, .6, .8) == Agreement::differs);      // more than even this u explains
  CHECK(of(std::nan(""), .3, .4) == Agreement::cannot_tell);
  CHECK(of(5.1, INFINITY, .4) == Agreement::cannot_tell);
  const auto judged = [](double simulated, double numerical) {
    Table table = no_comparisons("m");
    add_comparison(table, {"height", 2.99, .01, {3, 0}}, .4);
    add_comparison(table, {"width", simulated, numerical, {3, 0}}, .4);
    return outcome_of(judge_comparisons(table, .4, "why", "").verdict);
  };
  CHECK(judged(3.2, .1) == Outcome::holds);
  CHECK(judged(3.2, .3) == Outcome::inconclusive);
  CHECK(judged(3.6, .1) == Outcome::fails);
  CHECK(judged(std::nan(""), .1) == Outcome::fails);
}

TEST_CASE("findings of a validation say their kind") {
  const auto run = [](const Subject&, Tier, const Progress&) {
    return StudyResult{{{"loop.height", "", {{1, 2, 0, "1", "why"}, {}, ""}}}, {}, {}, {}};
  };
  for (const std::string kind : {"validation", "study"})
    CHECK(run_study({"loop", "", {}, "", "", run, kind}, {}, Tier::quick, [](double) {})
              .first.at(0)
              .kind == kind);
}

TEST_CASE("the level ring has the whole area and no folds; a waved one what its wave gives") {
  const Scene scene = ring_of_cloth({drape_fabrics()[0], 20});
  const auto waved = [&](double height) {  // five waves, the higher the nearer to the edge
    PerParticle3 x = scene.mesh.rest;
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      const double radius = x.col(i).norm(), angle = std::atan2(x(1, i), x(0, i));
      const double part = (radius - plate_radius) / (specimen_radius - plate_radius);
      x.col(i) *= 1 + part * height * std::cos(5 * angle) / radius;
    }
    return oracles::outline_of(x, scene.mesh.triangles, plate_radius, 1440);
  };
  // a polygon of 276 corners
  CHECK(oracles::drape_coefficient(waved(0), drape_radii) == Approx(1).epsilon(0.002));
  CHECK(oracles::folds_of(waved(0), least_fold) == 0);
  const double more = 0.02 * 0.02 / 2 / (std::pow(specimen_radius, 2) - std::pow(plate_radius, 2));
  CHECK(oracles::drape_coefficient(waved(0.02), drape_radii) == Approx(1 + more).epsilon(0.003));
  CHECK(oracles::folds_of(waved(0.02), least_fold) == 5);
  CHECK(oracles::folds_of(waved(0.001), least_fold) == 0);
}

TEST_CASE("a fold that reaches further than the edge throws the shadow") {
  const Scene scene = ring_of_cloth({drape_fabrics()[0], 8});
  PerParticle3 x = scene.mesh.rest;
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    if (x.col(i).norm() > 0.14) x.col(i) *= 0.1 / x.col(i).norm();  // turned under
  for (const double reach : oracles::outline_of(x, scene.mesh.triangles, plate_radius, 360))
    CHECK(reach > 0.13);
}

TEST_CASE("the dominant wavelength is that of the largest wave, whatever line lies under it") {
  std::vector<double> samples;
  for (int k = 0; k < 200; ++k)
    samples.push_back(0.7 * std::sin(2 * pi * k / 25 + 0.4) + 0.5 * std::cos(2 * pi * k / 8.0) + 3 +
                      0.2 * k);
  CHECK(dominant_wavelength(samples, 0.01) == Approx(0.25));
  CHECK(std::isnan(dominant_wavelength(std::vector<double>(200, 0.0), 0.01)));
  CHECK(std::isnan(dominant_wavelength({1, -1, 1, -1}, 0.01)));
}

TEST_CASE("a stored simulation is read back bit for bit, overrides and all") {
  const ScratchFolder folder;
  const Scene scene = read_scene_text(
      "[cloth]\nshape = \"sheet\"\nwidth = 0.3\nheight = 0.2\ncolumns = 3\nrows = 2\n"
      "density = 0.2\n[[object]]\nshape = \"sphere\"\nradius = 0.1\n[time]\nend = 0.1\n",
      "small.toml", {"cloth.width=0.45", "object.0.radius=0.25"});
  const BuiltScene built = build(scene, computing_provider());
  State s = built.start;
  {
    TrajectoryFile file(folder.file("small.h5"), scene, built.system, built.objects, {});
    file.add_frame(s);
    s.time = 0.1;
    s.x.array() += 0.1234567;
    s.v.array() -= 1.0 / 3;
    file.add_frame(s);
    file.finish("", 0, {});
  }
  const StoredRun run = read_stored_run(folder.file("small.h5"));
  CHECK(run.scene.mesh.rest == scene.mesh.rest);
  CHECK(run.scene.text == scene.text);
  CHECK(run.scene.objects.size() == 1);
  CHECK(run.times == std::vector<double>{0, 0.1});
  CHECK(run.frame(1).x == s.x);
  CHECK(run.frame(1).v == s.v);
  CHECK_THROWS_WITH(read_stored_run(folder.file("missing.h5")), Catch::Contains("missing.h5"));
}
