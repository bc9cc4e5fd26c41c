// bending-rigidity: what a sheet resists to bending, by the pattern of its triangles, its direction
// and their size.
#include <cmath>
#include <numbers>

#include "convergence/bending/bending_rigidity.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/homogenised_bending.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

/// A regular way to cut a sheet into triangles, and the same in the oracle's words.
struct RegularPattern {
  std::string name, words;
  SheetPattern pattern;
  double cell_height;               // over a cell's width; 0: as equilateral triangles have it [1]
  double longest_edge;              // over a cell's width [1]
  oracles::PeriodicMesh (*cell)();  // with cells one metre wide
  // whether a vertex is one of the cell's second kind
  bool (*second_site)(double column, double row);
};

// height of an equilateral triangle over its edge
const double row_ratio = std::numbers::sqrt3 / 2;

bool one_kind(double, double) { return false; }
bool odd_row(double, double row) { return std::lround(row) % 2 != 0; }
bool odd_square(double column, double row) {
  return (std::lround(column) + std::lround(row)) % 2 != 0;
}
bool between_columns(double column, double) { return std::abs(column - std::round(column)) > 0.25; }

oracles::PeriodicMesh one_diagonal_cell() { return oracles::split_rectangles({}); }
oracles::PeriodicMesh rectangle_cell() {
  return oracles::split_rectangles({1, 0.25, 1, 1, nullptr});
}
oracles::PeriodicMesh alternating_cell() {
  return oracles::split_rectangles({1, 1, 1, 2, [](int, int j) { return j % 2 == 0; }});
}
oracles::PeriodicMesh union_jack_cell() {
  return oracles::split_rectangles({1, 1, 2, 2, [](int i, int j) { return (i + j) % 2 == 0; }});
}
oracles::PeriodicMesh criss_cross_cell() { return oracles::crossed_squares(1); }
oracles::PeriodicMesh equilateral_cell() { return oracles::equilateral_triangles(1); }

const std::vector<RegularPattern>& regular_patterns() {
  static const double diagonal = std::numbers::sqrt2;
  static const std::vector<RegularPattern> patterns = {
      {"equilateral", "equilateral", SheetPattern::equilateral, 0, 1, equilateral_cell, one_kind},
      {"one-diagonal", "squares, one diagonal", SheetPattern::one_diagonal, 1, diagonal,
       one_diagonal_cell, one_kind},
      {"alternating", "squares, rows of alternating diagonal", SheetPattern::alternating, 1,
       diagonal, alternating_cell, odd_row},
      {"union-jack", "squares, union jack", SheetPattern::union_jack, 1, diagonal, union_jack_cell,
       odd_square},
      {"criss-cross", "squares, criss-cross", SheetPattern::criss_cross, 1, 1, criss_cross_cell,
       between_columns},
      {"rectangles", "4:1 rectangles, one diagonal", SheetPattern::one_diagonal, 0.25,
       std::sqrt(17.0) / 4, rectangle_cell, one_kind}};
  return patterns;
}

/// How a flat sheet is laid on a cylinder: the sheet's plane touches it along the line
/// through the origin.
struct Wrap {
  double direction = 0;  // of the curvature, from x [rad]
  double curvature = 0;  // [1/m]
  double offset = 0;     // of the vertices of the second kind, outward [m]
};

/// Where the cylinder takes a vertex.
Vector3 wrap_position(const Wrap& wrap, const Vector3& rest, bool second) {
  const Vector3 along(std::cos(wrap.direction), std::sin(wrap.direction), 0),
      across(-along.y(), along.x(), 0);
  const double turn = wrap.curvature * along.dot(rest), half = std::sin(turn / 2);
  const double offset = second ? wrap.offset : 0, radius = 1 / wrap.curvature + offset;
  const double rise = offset * std::cos(turn) - 2 * half * half / wrap.curvature;
  return radius * std::sin(turn) * along + across.dot(rest) * across + rise * Vector3::UnitZ();
}

/// Sheets of one pattern in two widths and two heights, n and 2 n cells. On a cylinder, equal cells
/// lie alike wherever they are; the energy is therefore a n_x n_y + b n_x + c n_y + d, and the
/// mixed difference of four sheets is that of the cells in their inner parts, without any border.
class FourSheets {
 public:
  /// n even, so that whole periods are added. width: of a cell [m]; ke [J].
  FourSheets(const Subject& subject, const RegularPattern& pattern, int n, double width, double ke)
      : pattern_(pattern), width_(width) {
    height_ = width * (pattern.cell_height > 0 ? pattern.cell_height : row_ratio);
    area_ = n * width_ * n * height_;
    for (const int columns : {n, 2 * n}) {
      for (const int rows : {n, 2 * n}) {
        Scene scene = scene_at_rest(
            make_sheet({pattern.pattern, columns * width_, rows * height_, columns, rows}), 0.17);
        add_flat_hinges(scene, ke, 0);
        specimens_.push_back(
            {scene.mesh.rest, Probe(subject, scene), columns == rows ? 1.0 : -1.0});
      }
    }
  }

  /// Energy per area of the inner cells when each vertex of the flat sheet goes where `bend` says
  /// [J/m^2]. bend: (rest position [m], of the second kind) -> position [m].
  double energy_per_area(const std::function<Vector3(const Vector3&, bool)>& bend) const {
    double sum = 0;
    for (const Specimen& specimen : specimens_) {
      PerParticle3 x(3, specimen.rest.cols());
      for (Eigen::Index i = 0; i < x.cols(); ++i) {
        const Vector3 rest = specimen.rest.col(i);
        x.col(i) = bend(rest, pattern_.second_site(rest.x() / width_, rest.y() / height_));
      }
      sum += specimen.sign * specimen.probe.energy(resting_state(std::move(x)));
    }
    return sum / area_;
  }
  double energy_per_area(const Wrap& wrap) const {
    return energy_per_area(
        [&wrap](const Vector3& rest, bool second) { return wrap_position(wrap, rest, second); });
  }

 private:
  struct Specimen {
    PerParticle3 rest;  // 3 x N [m]
    Probe probe;
    double sign;  // in the mixed difference
  };
  const RegularPattern& pattern_;
  double width_, height_;  // of a cell [m]
  double area_;            // of the inner cells [m^2]
  std::vector<Specimen> specimens_;
};

/// D/ke with all vertices on the cylinder [1]; wrap.offset is not used.
double forced_rigidity_of(const FourSheets& sheets, Wrap wrap, double ke) {
  wrap.offset = 0;
  return 2 * sheets.energy_per_area(wrap) / (ke * wrap.curvature * wrap.curvature);
}

/// D/ke with the vertices of the second kind at the offset of least energy, from three of them [1];
/// wrap.offset is the distance at which they are tried.
double relaxed_rigidity_of(const FourSheets& sheets, Wrap wrap, double ke) {
  const double reach = wrap.offset;
  const auto rigidity = [&](double offset) {
    wrap.offset = offset;
    return 2 * sheets.energy_per_area(wrap) / (ke * wrap.curvature * wrap.curvature);
  };
  const double inner = rigidity(-reach), middle = rigidity(0), outer = rigidity(reach);
  const double slope = (outer - inner) / 2, bend = outer - 2 * middle + inner;
  return bend > 0 ? middle - slope * slope / (2 * bend) : middle;  // all alike: nothing to relax
}

/// The oracle's R from the energies of six small quadratic surfaces, `curvature` [1/m] large [1].
Eigen::Matrix3d measured_tensor(const FourSheets& sheets, double curvature, double ke) {
  const auto energy = [&](const Eigen::Vector3d& k) {
    return sheets.energy_per_area([&k](const Vector3& rest, bool) {
      const double x = rest.x(), y = rest.y();
      return Vector3(x, y, 0.5 * (k[0] * x * x + k[1] * y * y + k[2] * x * y));
    });
  };
  Eigen::Matrix3d R;
  for (int i = 0; i < 3; ++i) R(i, i) = energy(curvature * Eigen::Vector3d::Unit(i));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < i; ++j) {
      const Eigen::Vector3d both = Eigen::Vector3d::Unit(i) + Eigen::Vector3d::Unit(j);
      R(i, j) = R(j, i) = (energy(curvature * both) - R(i, i) - R(j, j)) / 2;
    }
  }
  return 2 / (ke * curvature * curvature) * R;
}

constexpr double whole_side = 0.31;  // m

/// D/ke of a whole square sheet of n x n cells, its border included, curved along x by 0.3 1/m [1].
double whole_sheet_rigidity(const Subject& subject, const RegularPattern& pattern, int n,
                            double ke) {
  Scene scene = scene_at_rest(make_sheet({pattern.pattern, whole_side, whole_side, n, n}), 0.17);
  add_flat_hinges(scene, ke, 0);
  const Wrap wrap{0, 0.3, 0};
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
    scene.x.col(i) = wrap_position(wrap, scene.mesh.rest.col(i), false);
  const double energy = Probe(subject, scene).energy(resting_state(scene.x));
  return 2 * energy / (ke * std::pow(whole_side * wrap.curvature, 2));
}

constexpr double ke = 0.0043;    // J
constexpr double width = 0.013;  // of a cell [m]
// curvature times the width of a cell, where its error is far below 1e-5 [1]
constexpr double gentle = 1e-3;
constexpr int cells = 4;          // of the smaller sheets, each way; whole periods of every pattern
constexpr int degrees_apart = 5;  // directions of the curvature

double radians(double degrees) { return degrees * pi / 180; }

Wrap gentle_wrap(double degrees) {
  return {radians(degrees), gentle / width, 0.1 * gentle * width};
}

/// D/ke over the directions, measured and by the oracle [1].
Table measure(const Subject& subject, const RegularPattern& pattern) {
  const FourSheets sheets(subject, pattern, cells, width, ke);
  const Eigen::Matrix3d forced = oracles::forced_rigidity(pattern.cell()),
                        relaxed = oracles::relaxed_rigidity(pattern.cell());
  Table rigidity(
      "direction of the curvature [degree]; D/ke, forced [1]; oracle, forced [1]; D/ke, relaxed "
      "[1]; oracle, relaxed [1]");
  for (int degrees = 0; degrees <= 180; degrees += degrees_apart)
    rigidity.row(degrees, forced_rigidity_of(sheets, gentle_wrap(degrees), ke),
                 oracles::cylinder_rigidity(forced, radians(degrees)),
                 relaxed_rigidity_of(sheets, gentle_wrap(degrees), ke),
                 oracles::cylinder_rigidity(relaxed, radians(degrees)));
  return rigidity;
}

NamedFinding as_homogenised(const RegularPattern& pattern, const Table& rigidity) {
  Worst worst;
  worst.observe(largest_deviation(rigidity, "D/ke, forced", "oracle, forced"));
  worst.observe(largest_deviation(rigidity, "D/ke, relaxed", "oracle, relaxed"));
  const Verdict verdict{worst.value(), std::pow(gentle * pattern.longest_edge, 2), 0, "1",
                        "angles on a cylinder differ relatively from those at small curvature by "
                        "the square of longest edge times curvature, with factors below 1"};
  return {"bending-rigidity.matches-homogenisation." + pattern.name,
          "On a gentle cylinder, the energy per area of " + pattern.words +
              " is that of the homogenised cell, in every direction.",
          {verdict, rigidity,
           "forced: every vertex on the cylinder; relaxed: the vertices of the cell's second kind, "
           "if it has one, leave it until the energy is least"}};
}

// --- the same pattern, finer ---

/// D/ke of a cylinder of fixed curvature as the cells become smaller, and how far it is from the
/// homogenised one, relatively.
Table refined_rigidity(const Subject& subject, const RegularPattern& pattern, int levels) {
  constexpr double curvature = 17, degrees = 25, coarsest = 0.021;  // 1/m, of the curvature, m
  const double exact =
      oracles::cylinder_rigidity(oracles::forced_rigidity(pattern.cell()), radians(degrees));
  return refine(
      {{"width of a cell", "m"}, {"D/ke", "1"}, {"error", "1"}}, halving_range(coarsest, levels),
      [&](double size) {
        const FourSheets sheets(subject, pattern, cells, size, ke);
        const double rigidity = forced_rigidity_of(sheets, {radians(degrees), curvature, 0}, ke);
        return std::tuple{size, rigidity, std::abs(rigidity / exact - 1)};
      });
}

NamedFinding size_does_not_matter(const std::vector<Table>& refinements) {
  Worst worst;
  Table patterns("pattern; D/ke, coarsest [1]; D/ke, finest [1]; order of the last pair [1]");
  for (size_t i = 0; i < refinements.size(); ++i) {
    const Convergence error = convergence_of(refinements[i], "error");
    worst.observe(order_deviation(error, 2, 2).value);
    const std::vector<double>& rigidity = refinements[i].numbers("D/ke");
    patterns.row(regular_patterns()[i].words, rigidity.front(), rigidity.back(),
                 pair_orders(error).back());
  }
  const Verdict verdict{worst.value(), 0.05, 0, "1",
                        "errors are a series in the square of curvature times width; at the last "
                        "pairs the second term is below a hundredth of the first"};
  return {"bending-rigidity.does-not-depend-on-cell-size",
          "The same pattern with smaller cells tends to its homogenised rigidity with second "
          "order: ke means the same at every size.",
          {verdict, patterns,
           "measured is the worst |order - 2| of the last two pairs over all patterns; curvature "
           "17 1/m along 25 degrees"}};
}

/// The greatest difference over directions or patterns, against what refining once more changes.
NamedFinding refining_does_not_cure(const std::string& name, const std::string& claim,
                                    const std::vector<double>& values, double drift) {
  Worst difference;
  for (const double one : values) {
    for (const double other : values) difference.observe(one - other);
  }
  const Verdict verdict{
      drift / difference.value(), 0.01, 0, "1",
      "a difference 100 times the change from halving the cells will not vanish by refinement; a "
      "property of the material alone would leave only that change"};
  return {name,
          claim,
          {verdict,
           Table{{"greatest difference of D/ke", "1"}, {"change of D/ke by halving the cells", "1"}}
               .with_row(difference.value(), drift),
           "measured is the change over the difference"}};
}

double last_change(const Table& refinement) {
  const std::vector<double>& D = refinement.numbers("D/ke");
  return std::abs(D[D.size() - 1] - D[D.size() - 2]);
}

// --- whole sheets, free strips ---

/// A whole square sheet of n cells: its border has no hinges, so that its energy lacks
/// a share of 1/n.
NamedFinding border_is_first_order(const Subject& subject, int levels, Figure& figure) {
  const RegularPattern& pattern = regular_patterns()[1];
  const Table sheets = refine({{"width of a cell", "m"}, {"1 - D/(ke/4)", "1"}},
                              doubling_range(6, 6 << (levels - 1)), [&](int n) {
                                const double D = whole_sheet_rigidity(subject, pattern, n, ke);
                                return std::tuple{whole_side / n, std::abs(D / 0.25 - 1)};
                              });
  const Convergence whole = convergence_of(sheets, "1 - D/(ke/4)");
  figure.curves.push_back(curve_of("a whole sheet with its border, " + pattern.words, whole));
  const Verdict verdict =
      order_verdict(whole, 1, 2, 0.02,
                    "n rows of cells have n - 1 lines of hinges: the missing share is 1/n "
                    "exactly, and the curvature adds about 1e-5 of that");
  return {"bending-rigidity.border-effect-is-first-order",
          "A whole sheet lacks the hinges of its border: its energy tends to the rigidity with "
          "first order.",
          {verdict, sheets, "D/ke of this pattern and direction is 1/4, by the homogenised cell"}};
}

NamedFinding free_strip(const Subject& subject, const RegularPattern& pattern) {
  constexpr double curvature = gentle / 10 / width;
  const FourSheets sheets(subject, pattern, cells, width, ke);
  const double measured = oracles::strip_rigidity(measured_tensor(sheets, curvature, ke), 0);
  const double exact = oracles::strip_rigidity(oracles::relaxed_rigidity(pattern.cell()), 0);
  const Verdict verdict{std::abs(measured / exact - 1),
                        std::pow(2 * cells * width * 3 * curvature, 2), 0, "1",
                        "the surfaces' slopes, at most 3 times curvature times the sheets' side, "
                        "change angles by the square of the slope"};
  return {"bending-rigidity.free-strip-is-softer." + pattern.name,
          "A narrow strip of " + pattern.words +
              " with free edges is softer than a forced cylinder: it curves across and twists.",
          {verdict,
           Table("B/ke of the strip [1]; oracle [1]; D/ke of the cylinder [1]")
               .with_row(measured, exact,
                         oracles::cylinder_rigidity(oracles::relaxed_rigidity(pattern.cell()), 0)),
           "from the energies of six quadratic surfaces"}};
}

// --- what is shown ---

Table rigidity_table(const std::vector<Table>& all) {
  Table table(
      "mesh; vertices; 0° [1]; 45° [1]; 90° [1]; 135° [1]; least [1]; greatest [1]; strip [1]");
  for (size_t p = 0; p < all.size(); ++p) {
    const RegularPattern& pattern = regular_patterns()[p];
    for (const bool relaxed : {false, true}) {
      if (relaxed && pattern.cell().sites.size() == 1) continue;
      const Eigen::Matrix3d R = relaxed ? oracles::relaxed_rigidity(pattern.cell())
                                        : oracles::forced_rigidity(pattern.cell());
      const std::vector<double>& D = all[p].numbers(relaxed ? "D/ke, relaxed" : "D/ke, forced");
      const auto at = [&](int degrees) { return D[size_t(degrees / degrees_apart)]; };
      const oracles::RigidityRange range = oracles::cylinder_range(R);
      table.row(pattern.words, relaxed ? "relaxed" : "forced", at(0), at(45), at(90), at(135),
                range.least, range.greatest, oracles::strip_rigidity(R, 0));
    }
  }
  return {"rigidity",
          "D/ke of cylinders curved along four directions (measured), its range over all "
          "directions and that of a narrow free strip along x (oracle)",
          table};
}

Figure direction_figure(const std::vector<Table>& all) {
  Figure figure{"direction",
                "Flexural rigidity by the direction of the curvature",
                {"direction of the curvature, from x", "degree"},
                {"D/ke", "1", Scale::log},
                "Vertices within a cell are free to settle. A property of the material would be "
                "one horizontal line."};
  for (size_t p = 0; p < all.size(); ++p)
    figure.curves.push_back(curve_of(regular_patterns()[p].words, all[p],
                                     "direction of the curvature", "D/ke, relaxed"));
  return figure;
}

StudyResult run_bending_rigidity(const Subject& subject, Tier tier, const Progress& progress) {
  const int levels = tier == Tier::quick ? 5 : 7;
  StudyResult result;
  std::vector<Table> all, refinements;
  Figure refined{"refinement",
                 "Error of the rigidity as the cells become smaller",
                 {"width of a cell", "m", Scale::log},
                 {"|D/D of the homogenised cell - 1|", "1", Scale::log},
                 2,
                 "Curvature 17 1/m along 25 degrees, inner cells; each pattern against its own "
                 "limit. The whole sheet has first order."};
  std::vector<double> at_zero;
  for (const RegularPattern& pattern : regular_patterns()) {
    all.push_back(measure(subject, pattern));
    refinements.push_back(refined_rigidity(subject, pattern, levels));
    result.findings.push_back(as_homogenised(pattern, all.back()));
    refined.curves.push_back(curve_of(pattern.words, convergence_of(refinements.back(), "error")));
    at_zero.push_back(all.back().numbers("D/ke, relaxed").front());
    progress(double(all.size()) / 12);
  }
  result.findings.push_back(size_does_not_matter(refinements));
  result.findings.push_back(
      refining_does_not_cure("bending-rigidity.depends-on-direction",
                             "Squares split along one diagonal resist differently by direction, "
                             "and refinement does not remove that.",
                             all[1].numbers("D/ke, relaxed"), last_change(refinements[1])));
  Worst drift;
  for (const Table& refinement : refinements) drift.observe(last_change(refinement));
  result.add({refining_does_not_cure("bending-rigidity.depends-on-pattern",
                                     "Curved along x, different patterns resist differently, and "
                                     "refinement does not remove that.",
                                     at_zero, drift.value()),
              border_is_first_order(subject, levels, refined)});
  for (const size_t p : {0, 1})
    result.findings.push_back(free_strip(subject, regular_patterns()[p]));
  result.tables.push_back(rigidity_table(all));
  result.figures.push_back(direction_figure(all));
  result.figures.push_back(std::move(refined));
  add_irregular_rigidity(subject, tier, progress, result);
  return result;
}

}  // namespace

Study bending_rigidity_study() {
  return {"bending-rigidity",
          "For a given ke the flexural rigidity inside a sheet does not depend on the size of its "
          "triangles, but it does depend on their pattern and on the direction, and refinement "
          "does not remove that.",
          {"does-not-depend-on-cell-size", "depends-on-direction", "depends-on-pattern",
           "irregular.excess-persists-under-refinement"},
          "BMF03 section 4: |E|^2/(|N1| + |N2|) makes the cloth's look independent of remeshing",
          "Flat sheets of many meshes are laid on cylinders, and the bending energy per area gives "
          "the flexural rigidity D. The oracle knows only how a hinge is defined: it adds up the "
          "hinges of one cell. A regular pattern keeps its rigidity at every size; which rigidity "
          "depends on the pattern and the direction, as the table shows.",
          run_bending_rigidity};
}

}  // namespace foldproof
