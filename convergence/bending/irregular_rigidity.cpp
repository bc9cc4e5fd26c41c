#include "convergence/bending/bending_rigidity.h"

#include <array>
#include <cmath>
#include <numbers>

#include "convergence/order.h"
#include "convergence/tables.h"
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

/// All sizes of one kind of mesh: D/ke as means over meshes and directions; settled: of
/// the first meshes.
struct Row {
  Disorder disorder;
  Table samples;

  std::pair<double, double> last_two(std::string_view column) const {
    const std::vector<double>& values = samples.numbers(column);
    return {values[values.size() - 2], values.back()};
  }
};

Row row_of(const Subject& subject, const Disorder& disorder, const Effort& effort) {
  return {disorder, refine({{"width of a cell", "m"},
                            {"forced", "1"},
                            {"standard error", "1"},
                            {"settled", "1"},
                            {"worst error, forced", "1"},
                            {"worst error, relaxed", "1"}},
                           effort.sizes, [&](int cells) {
                             const Sample sample = sample_of(subject, disorder, cells, effort);
                             return std::tuple{gentle_side / cells,
                                               sample.forced.value(),
                                               sample.forced.standard_error(),
                                               sample.relaxed.value(),
                                               sample.forced_error.value(),
                                               sample.relaxed_error.value()};
                           })};
}

/// All kinds of meshes, one below the other.
Table all_meshes(const std::vector<Row>& rows) {
  std::vector<std::pair<std::string, Table>> meshes;
  for (const Row& row : rows) meshes.emplace_back(row.disorder.words, row.samples);
  return stacked({"mesh", ""}, meshes);
}

NamedFinding as_the_oracle(const std::vector<Row>& rows) {
  const Table all = all_meshes(rows);
  Worst worst;
  worst.observe(all.worst("worst error, forced"));
  worst.observe(all.worst("worst error, relaxed"));
  const Verdict verdict{worst.value(), gentle_bound, 0, "1",
                        "the surfaces' slopes change angles by their square, relatively"};
  return {"bending-rigidity.irregular.matches-homogenisation",
          "On jittered and random meshes too, the energy is what the hinges' definition gives, "
          "with all vertices on the surface and with those inside settled.",
          {verdict,
           with_columns(all,
                        {"mesh", "width of a cell", "worst error, forced", "worst error, relaxed"}),
           "settled: conjugate gradients on the subject's forces; the oracle solves its own sparse "
           "system"}};
}

NamedFinding excess_stays(const Row& row) {
  const auto [coarse, fine] = row.last_two("forced");
  const auto [coarse_error, fine_error] = row.last_two("standard error");
  const double excess = fine - equilateral, change = std::abs(fine - coarse);
  const double uncertainty = std::hypot(coarse_error, fine_error);
  Table means = with_columns(row.samples, {"width of a cell"});
  means.add({"D/ke, forced, mean", "1", row.samples.numbers("forced")});
  means.add(row.samples.column("standard error"));
  const Verdict verdict{excess > 0 ? change / excess : nan, 0.5, uncertainty / excess, "1",
                        "an excess proportional to the width would change by its own size when the "
                        "cells are halved; half of that separates the two"};
  return {"bending-rigidity.irregular.excess-persists-under-refinement." + row.disorder.name,
          "The excess of D over that of equilateral triangles stays when the cells are halved: " +
              row.disorder.words + ".",
          {verdict, means,
           "measured is the last change over the excess, NaN without one; the uncertainty is the "
           "standard error of the means over meshes"}};
}

void show(const std::vector<Row>& rows, StudyResult& result) {
  Figure figure{"irregular",
                "Flexural rigidity of irregular meshes",
                {"width of a cell", "m", Scale::log},
                {"D/ke", "1"},
                "Means over meshes and directions. Forced: all vertices on the cylinder; settled: "
                "those inside leave it. Equilateral triangles have 0.25."};
  for (const Row& row : rows)
    for (const char* kind : {"forced", "settled"})
      figure.curves.push_back(
          curve_of(row.disorder.words + ", " + kind, row.samples, "width of a cell", kind));
  result.figures.push_back(std::move(figure));
  result.tables.push_back(
      {"irregular",
       "D/ke of irregular meshes: means over meshes and directions; settled: of the first mesh",
       with_columns(all_meshes(rows),
                    {"mesh", "width of a cell", "forced", "standard error", "settled"})});
}

}  // namespace

void add_irregular_rigidity(const Subject& subject, Tier tier, const Progress& progress,
                            StudyResult& result) {
  const Effort effort = tier == Tier::quick ? Effort{{14, 28}, 10, 1} : Effort{{14, 28, 56}, 24, 1};
  std::vector<Row> rows;
  for (const Disorder& disorder : disorders()) {
    rows.push_back(row_of(subject, disorder, effort));
    progress(0.5 + 0.5 * double(rows.size()) / double(disorders().size()));
  }
  result.findings.push_back(as_the_oracle(rows));
  for (const Row& row : rows) result.findings.push_back(excess_stays(row));
  show(rows, result);
}

}  // namespace foldproof
