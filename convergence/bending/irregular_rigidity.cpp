#include "convergence/bending/bending_rigidity.h"

#include <array>
#include <cmath>
#include <numbers>

#include "reference/mesh/shapes.h"
#include "verification/seeds.h"

namespace foldproof {

namespace {

constexpr double equilateral = 0.25;  // D/ke without disorder: the homogenised cell says so

/// How a mesh is made irregular.
struct Disorder {
  std::string name, words;
  SheetPattern pattern;
  double jitter;  // [1]
};

std::vector<Disorder> disorders() {
  return {{"jittered-10", "equilateral, jittered by 10 %", SheetPattern::jittered, 0.1},
          {"jittered-20", "equilateral, jittered by 20 %", SheetPattern::jittered, 0.2},
          {"jittered-30", "equilateral, jittered by 30 %", SheetPattern::jittered, 0.3},
          {"random", "random vertices, Delaunay", SheetPattern::random_delaunay, 0}};
}

/// One rigidity from several meshes, each a mean over directions.
struct Mean {
  std::vector<double> values;

  double value() const {
    double sum = 0;
    for (const double v : values) sum += v;
    return sum / double(values.size());
  }

  /// Of the mean, from the scatter of the meshes.
  double standard_error() const {
    double squares = 0;
    for (const double v : values) squares += (v - value()) * (v - value());
    return std::sqrt(squares / (double(values.size()) * (double(values.size()) - 1)));
  }
};

/// D/ke of one kind of mesh at one size, and how far single sheets are from what the
/// oracle says of them.
struct Sample {
  Mean forced, relaxed;
  Worst forced_error, relaxed_error;  // relative
};

constexpr std::array directions = {11.0, 56.0, 101.0, 146.0};  // of the curvature [degree]

/// How many meshes of each size, and how many of them let their vertices settle, which
/// costs a solve each.
struct Effort {
  std::vector<int> sizes;  // cells along a side
  int meshes, settled;
};

TriangleMesh mesh_of(const Disorder& disorder, int cells, unsigned seed) {
  Sheet sheet{disorder.pattern, gentle_side,       gentle_side, cells, cells,
              disorder.jitter,  shifted_seed(seed)};
  if (disorder.pattern == SheetPattern::jittered) {
    sheet.rows = int(std::lround(cells * 2 / std::numbers::sqrt3));
    sheet.height = 0;
  }
  return make_sheet(sheet);
}

Sample sample_of(const Subject& subject, const Disorder& disorder, int cells,
                 const Effort& effort) {
  Sample sample;
  for (int seed = 1; seed <= effort.meshes; ++seed) {
    const GentleSheet sheet(subject, mesh_of(disorder, cells, unsigned(seed)), gentle_side / cells);
    double forced = 0, relaxed = 0;
    for (const double degrees : directions) {
      const double angle = degrees * pi / 180, own = sheet.forced(angle);
      forced += own / directions.size();
      sample.forced_error.observe(
          std::abs(own / oracles::forced_cylinder_rigidity(sheet.flat(), angle) - 1));
      if (seed > effort.settled) continue;
      const double settled = sheet.relaxed(angle);
      relaxed += settled / directions.size();
      sample.relaxed_error.observe(
          std::abs(settled / oracles::relaxed_cylinder_rigidity(sheet.flat(), angle) - 1));
    }
    sample.forced.values.push_back(forced);
    if (seed <= effort.settled) sample.relaxed.values.push_back(relaxed);
  }
  return sample;
}

/// All sizes of one kind of mesh.
struct Row {
  Disorder disorder;
  std::vector<double> widths;  // m
  std::vector<Sample> samples;
};

NamedFinding as_the_oracle(const std::vector<Row>& rows) {
  Worst worst;
  std::vector<std::string> names;
  std::vector<double> widths, forced, relaxed;
  for (const Row& row : rows) {
    for (size_t i = 0; i < row.samples.size(); ++i) {
      names.push_back(row.disorder.words);
      widths.push_back(row.widths[i]);
      forced.push_back(row.samples[i].forced_error.value());
      relaxed.push_back(row.samples[i].relaxed_error.value());
      worst.observe(forced.back());
      worst.observe(relaxed.back());
    }
  }
  const Verdict verdict{worst.value(), gentle_bound, 0, "1",
                        "the surfaces' slopes change angles by their square, relatively"};
  return {"bending-rigidity.irregular.matches-homogenisation",
          "On jittered and random meshes too, the energy is what the hinges' definition gives, "
          "with all vertices on the surface and with those inside settled.",
          {verdict,
           {{"mesh", "", names},
            {"width of a cell", "m", widths},
            {"worst error, forced", "1", forced},
            {"worst error, relaxed", "1", relaxed}},
           "settled: conjugate gradients on the subject's forces; the oracle solves its own sparse "
           "system"}};
}

NamedFinding excess_stays(const Row& row) {
  const Mean& coarse = row.samples[row.samples.size() - 2].forced;
  const Mean& fine = row.samples.back().forced;
  const double excess = fine.value() - equilateral,
               change = std::abs(fine.value() - coarse.value());
  const double uncertainty = std::hypot(coarse.standard_error(), fine.standard_error());
  std::vector<double> values, errors;
  for (const Sample& sample : row.samples) {
    values.push_back(sample.forced.value());
    errors.push_back(sample.forced.standard_error());
  }
  const Verdict verdict{excess > 0 ? change / excess : nan, 0.5, uncertainty / excess, "1",
                        "an excess that vanished in proportion to the width would change by its "
                        "own size when the cells are halved; half of that tells the two apart"};
  return {"bending-rigidity.irregular.excess-persists-under-refinement." + row.disorder.name,
          "The excess of D over that of equilateral triangles stays when the cells are halved: " +
              row.disorder.words + ".",
          {verdict,
           {{"width of a cell", "m", row.widths},
            {"D/ke, forced, mean", "1", values},
            {"standard error", "1", errors}},
           "measured is the last change over the excess, NaN without one; the uncertainty is the "
           "standard error of the means over meshes"}};
}

void show(const std::vector<Row>& rows, StudyResult& result) {
  Figure figure{"irregular",
                "Flexural rigidity of irregular meshes",
                {"width of a cell", "m", Scale::log},
                {"D/ke", "1", Scale::linear},
                nan,
                "Means over meshes and directions. Forced: all vertices on the cylinder; settled: "
                "those inside leave it. Equilateral triangles have 0.25.",
                {}};
  std::vector<std::string> names;
  std::array<std::vector<double>, 4> numbers;
  for (const Row& row : rows) {
    std::array<std::vector<double>, 2> curves;
    for (size_t i = 0; i < row.samples.size(); ++i) {
      const Sample& sample = row.samples[i];
      curves[0].push_back(sample.forced.value());
      curves[1].push_back(sample.relaxed.value());
      names.push_back(row.disorder.words);
      numbers[0].push_back(row.widths[i]);
      numbers[1].push_back(sample.forced.value());
      numbers[2].push_back(sample.forced.standard_error());
      numbers[3].push_back(sample.relaxed.value());
    }
    figure.curves.push_back({row.disorder.words + ", forced", row.widths, curves[0], nan, {}});
    figure.curves.push_back({row.disorder.words + ", settled", row.widths, curves[1], nan, {}});
  }
  result.figures.push_back(std::move(figure));
  result.tables.push_back(
      {"irregular",
       "D/ke of irregular meshes: means over meshes and directions; settled: of the first mesh",
       {{"mesh", "", names},
        {"width of a cell", "m", numbers[0]},
        {"forced", "1", numbers[1]},
        {"standard error", "1", numbers[2]},
        {"settled", "1", numbers[3]}}});
}

}  // namespace

void add_irregular_rigidity(const Subject& subject, Tier tier, const Progress& progress,
                            StudyResult& result) {
  const Effort effort = tier == Tier::quick ? Effort{{14, 28}, 10, 1} : Effort{{14, 28, 56}, 24, 1};
  std::vector<Row> rows;
  for (const Disorder& disorder : disorders()) {
    Row row{disorder, {}, {}};
    for (const int cells : effort.sizes) {
      row.widths.push_back(gentle_side / cells);
      row.samples.push_back(sample_of(subject, disorder, cells, effort));
    }
    rows.push_back(std::move(row));
    progress(0.5 + 0.5 * double(rows.size()) / double(disorders().size()));
  }
  result.findings.push_back(as_the_oracle(rows));
  for (const Row& row : rows) result.findings.push_back(excess_stays(row));
  show(rows, result);
}

}  // namespace foldproof
