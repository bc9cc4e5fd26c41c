// preset-drape: two fabric presets of a public solver in the drape test. They bend nearly alike,
// but drape unlike: is it their stretch, or their mesh?

#include "convergence/study.h"
#include "convergence/validation/comparison.h"
#include "convergence/validation/drape_test.h"

namespace foldproof {

namespace {

/// B over the density for bend 1: rigidity 1.28e-5 bend density/(A0 + A1) L^2 of a hinge.
constexpr double rigidity_of_bend = 1.28e-5;  // N m/(kg/m^2)

/// A preset, and the drape coefficient that its authors got.
struct Preset {
  const char* name;
  double bend, young;  // in the solver's units; young: Young's modulus over the density [m^2/s^2]
  double published;    // 1
};

// ppf-contact-solver, calibration/cusick_drape/results.csv of commit d2a85068
constexpr Preset silk{"Silk", 1.42, 500, 0.330}, leather{"Leather", 1.8, 13000, 0.547};

constexpr double wanted_error = 0.02;  // of a coefficient: two points of drape [1]

/// The drapes of a bending with a stretch on one mesh, from several starts.
struct Rests {
  double least = INFINITY, most = -INFINITY, sum = 0;
  int stable = 0;

  double mean() const { return stable > 0 ? sum / stable : nan; }
  void add(const Drape& one) {
    if (!one.stable) return;
    ++stable;
    sum += one.coefficient;
    least = std::min(least, one.coefficient);
    most = std::max(most, one.coefficient);
  }
};

/// A bending with a stretch, coarse to fine.
struct Cloth {
  const Preset& bending;
  const Preset& stretch;
  std::vector<Rests> meshes = {};

  double finest() const { return meshes.back().mean(); }
  double change() const { return std::abs(finest() - meshes.front().mean()); }
};

struct Presets {
  std::vector<int> rows;
  std::vector<Cloth> cloths{{silk, silk}, {silk, leather}, {leather, silk}, {leather, leather}};
  Table table{"drapes",
              "Bending of one preset with the stretch of one; means and ranges over the starts",
              {{"bending of", ""},
               {"stretch of", ""},
               {"bending length", "mm"},
               {"rows of triangles", "1"},
               {"stable rests", "1"},
               {"drape coefficient", "1"},
               {"least", "1"},
               {"most", "1"}}};
};

DrapeTest test_of(const Cloth& cloth, int rows, int waves) {
  const double weight = gravity * (specimen_radius - plate_radius);  // over the density
  return {{cloth.bending.name, rigidity_of_bend * cloth.bending.bend, 1},
          rows,
          waves,
          cloth.stretch.young / weight};
}

Presets all_drapes(const Subject& subject, Tier tier, const Progress& progress) {
  const bool quick = tier == Tier::quick;
  Presets all;
  while (quick && all.cloths.size() > 2) all.cloths.pop_back();
  all.rows = quick ? std::vector{5, 7} : std::vector{7, 10, 14, 20};
  const std::vector<int> starts = quick ? std::vector{8} : std::vector{6, 8, 10};
  int done = 0;
  for (Cloth& cloth : all.cloths)
    for (const int rows : all.rows) {
      Rests rests;
      for (const int waves : starts) rests.add(drape(subject, test_of(cloth, rows, waves)));
      all.table.row(cloth.bending.name, cloth.stretch.name,
                    1e3 * bending_length(test_of(cloth, rows, 0).fabric), rows, rests.stable,
                    rests.mean(), rests.least, rests.most);
      cloth.meshes.push_back(rests);
      progress(double(++done) / double(all.cloths.size() * all.rows.size()));
    }
  return all;
}

/// What the authors got, and the same numbers here.
Table beside_the_published(const Presets& all) {
  Table table{"published",
              "The presets' published coefficients, and those of the same numbers here",
              {{"preset", ""},
               {"published", "1"},
               {"here, coarsest mesh", "1"},
               {"here, finest mesh", "1"}}};
  for (const Cloth& cloth : all.cloths)
    if (&cloth.bending == &cloth.stretch)
      table.row(cloth.bending.name, cloth.bending.published, cloth.meshes.front().mean(),
                cloth.finest());
  return table;
}

NamedFinding stiff_stretch_locks(const Presets& all) {
  return {"preset-drape.stiff-stretch-locks-coarse-meshes",
          "The coarsest mesh is further from the finest where the cloth hardly stretches.",
          {{all.cloths[0].change() / all.cloths[1].change(), 0.8, 0, "1",
            "triangles that are larger than a fold's radius can only stretch; cloth of one stretch "
            "has 1"},
           all.table,
           "change of Silk's coefficient with its own stretch, over that with Leather's"}};
}

/// In the full tier.
NamedFinding mesh_error_is_two_points(const Presets& all) {
  Table changes{{"bending of", ""}, {"stretch of", ""}, {"change by the last mesh", "1"}};
  for (const Cloth& cloth : all.cloths)
    if (&cloth.stretch == &silk)
      changes.row(cloth.bending.name, cloth.stretch.name,
                  std::abs(cloth.finest() - cloth.meshes[cloth.meshes.size() - 2].mean()));
  return {"preset-drape.mesh-error-is-two-points",
          "With Silk's stretch, the last mesh changes the coefficient by two hundredths at most.",
          judge_worst(changes, wanted_error, "the margin that is quoted for the test")};
}

/// In the full tier.
NamedFinding silk_is_as_published(const Presets& all) {
  return {"preset-drape.silk-is-as-published",
          "Silk's numbers give the published drape coefficient.",
          {{std::abs(all.cloths[0].finest() - silk.published), wanted_error, 0, "1",
            "the margin that is quoted for the test"},
           beside_the_published(all),
           ""}};
}

/// In the full tier.
NamedFinding leather_is_a_coarse_mesh_s(const Presets& all) {
  const Cloth& cloth = all.cloths[3];
  return {"preset-drape.leather-is-as-published-on-a-coarse-mesh",
          "Leather's published drape coefficient is nearer to that of a coarse mesh than of a fine "
          "one.",
          {{std::abs(cloth.meshes.front().mean() - leather.published) /
                std::abs(cloth.finest() - leather.published),
            1, 0, "1", "a coefficient of the fabric would be approached by finer meshes"},
           beside_the_published(all),
           "distance from the published one on the coarsest mesh, over that on the finest"}};
}

StudyResult run_preset_drape(const Subject& subject, Tier tier, const Progress& progress) {
  const Presets all = all_drapes(subject, tier, progress);
  StudyResult result;
  result.add({stiff_stretch_locks(all)});
  if (tier == Tier::full)
    result.add({mesh_error_is_two_points(all), silk_is_as_published(all),
                leather_is_a_coarse_mesh_s(all)});
  Figure figure{"meshes",
                "Drape coefficient by mesh",
                {"rows of triangles", "1"},
                {"drape coefficient", "1"},
                "Means over the starts. Silk's and Leather's bending lengths are 12.3 and 13.3 mm; "
                "Leather's stretch is 26 times as stiff. Published: 0.330 and 0.547."};
  for (const Cloth& cloth : all.cloths) {
    Curve curve{
        fmt::format("bending of {}, stretch of {}", cloth.bending.name, cloth.stretch.name)};
    for (size_t k = 0; k < all.rows.size(); ++k) curve.point(all.rows[k], cloth.meshes[k].mean());
    figure.curves.push_back(std::move(curve));
  }
  result.figures = {figure};
  return result;
}

}  // namespace

Study preset_drape_study() {
  return {"preset-drape",
          "A fabric preset that hardly stretches drapes less on a coarse mesh than on a fine one.",
          {"stiff-stretch-locks-coarse-meshes"},
          "ppf-contact-solver, calibration/cusick_drape, commit d2a85068",
          "A public solver ships fabric presets with the drape coefficients that it gets. Silk and "
          "Leather have bending lengths of 12.3 and 13.3 mm by its formulas, nearly alike, and "
          "coefficients of 0.330 and 0.547. Here the disc of cusick-drape has the bending of one "
          "and the stretch of one, on meshes of 7 to 20 rows of triangles, from starts of 6, 8 and "
          "10 waves. Young's modulus is read as one over the density: Leather's ring could bear "
          "22,000 times its weight per width, Silk's 850 times. The solver itself, which needs a "
          "GPU, was not run; its triangles are linear, and so are springs on equilateral "
          "triangles for small strains.",
          run_preset_drape,
          "validation"};
}

}  // namespace foldproof
