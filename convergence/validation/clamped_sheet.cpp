#include "convergence/validation/clamped_sheet.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "convergence/validation/freedoms.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

constexpr int images = 2;       // rows and edges of images beyond the middle lines
constexpr double clamp = 0.75;  // edges from the border

/// A quarter of the sheet and images beyond its middle lines. x is along the tension, from the
/// border at a clamp; y from the middle line.
class Quarter {
 public:
  Quarter(const Subject& subject, const ClampedSheet& sheet)
      : sheet_(sheet),
        edge_(edge_of(sheet)),
        scene_(equilateral_sheet(sheet.rigidity, sheet.young, edge_,
                                 (sheet.half_edges + 1) / 2 + images + 1, sheet.rows + images)),
        probe_(subject, scene_) {
    const PerParticle3& rest = scene_.mesh.rest;
    for (int i = 0; i < int(rest.cols()); ++i) {
      row_.push_back(int(std::lround(rest(1, i) / row_height())) - images);
      place_.push_back(int(std::lround(2 * rest(0, i) / edge_)));
    }
    in_plane_ = freedoms_along({true, true, false});
    normal_ = freedoms_along({false, false, true});
    all_ = freedoms_along({true, true, true});
  }

  const Freedoms& in_plane() const { return in_plane_; }
  const Freedoms& normal() const { return normal_; }
  const Freedoms& all() const { return all_; }

  /// Every particle along with the clamps.
  PerParticle3 stretched(double strain) const {
    PerParticle3 x = scene_.mesh.rest;
    const double middle = sheet_.half_edges * edge_ / 2, from = clamp * edge_;
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      const bool held = place_[std::size_t(i)] <= 2;
      x(0, i) = middle + (held ? x(0, i) - middle - strain * (middle - from)
                               : (1 + strain) * (x(0, i) - middle));
    }
    return x;
  }

  Settled settled(const Freedoms& freedoms, PerParticle3 x, double strain) const {
    const Hessian hessian(build_system(scene_), freedoms);
    const double scale = sheet_.young * strain * edge_;  // N
    return settle(SheetSettling{probe_, hessian, freedoms, Eigen::VectorXd::Zero(freedoms.count),
                                Eigen::VectorXd::Constant(freedoms.count, scale), 1e-9, edge_ / 4},
                  std::move(x));
  }

  SparseMatrix stiffness(const Freedoms& freedoms, const PerParticle3& x) const {
    return Hessian(build_system(scene_), freedoms).at(resting_state(x), Definiteness::exact, 0);
  }

  /// Pull on the clamp over half the width.
  double tension(const PerParticle3& x) const {
    const PerParticle3 force = probe_.elastic(resting_state(x));
    double pull = 0;
    for (std::size_t i = 0; i < row_.size(); ++i)
      if (place_[i] <= 2 && row_[i] >= 0)
        pull += (row_[i] == 0 ? 0.5 : 1) * force(0, Eigen::Index(i));
    return pull / (sheet_.width / 2);
  }

  /// On the middle line, from the strains of the triangles beside it.
  void add_stresses(const PerParticle3& x, ClampedFlat& flat) const {
    std::vector<std::pair<double, double>> all;
    for (const Triangle& t : scene_.mesh.triangles) {
      std::array<int, 3> rows, places;
      for (std::size_t c = 0; c < 3; ++c) {
        rows[c] = row_[std::size_t(t[c])];
        places[c] = place_[std::size_t(t[c])];
      }
      const auto [least, most] = std::ranges::minmax(rows);
      if (least != 0 || most != 1 || std::ranges::max(places) > sheet_.half_edges ||
          std::ranges::max(places) <= 2)
        continue;
      const double place =
          (scene_.mesh.rest(0, t[0]) + scene_.mesh.rest(0, t[1]) + scene_.mesh.rest(0, t[2])) / 3;
      all.emplace_back((place - clamp * edge_) / length_of(sheet_), stress_across(t, x));
    }
    std::ranges::sort(all);
    for (const auto& [place, stress] : all) {
      flat.places.push_back(place);
      flat.stresses.push_back(stress);
    }
  }

  Section section(const PerParticle3& x) const {
    std::map<int, std::size_t> nearest;  // of each row, on the middle or half an edge before it
    for (std::size_t i = 0; i < row_.size(); ++i)
      if (row_[i] >= 0 && place_[i] <= sheet_.half_edges && place_[i] >= sheet_.half_edges - 1)
        nearest[row_[i]] = i;
    Section section;
    for (const auto& [row, i] : nearest) {
      section.places.push_back(x(1, Eigen::Index(i)) - images * row_height());
      section.heights.push_back(x(2, Eigen::Index(i)));
    }
    return section;
  }

  PerParticle3 with_heights(PerParticle3 x, const Eigen::VectorXd& heights) const {
    return normal_.moved(std::move(x), heights);
  }

 private:
  double row_height() const { return edge_ * std::numbers::sqrt3 / 2; }

  Freedoms freedoms_along(std::array<bool, 3> axes) const {
    const std::size_t n = row_.size();
    Freedoms freedoms{std::vector<std::array<Freedom, 3>>(n), std::vector<double>(n, 0), 0};
    std::map<std::array<int, 2>, std::size_t> inside;
    for (std::size_t i = 0; i < n; ++i) {
      if (row_[i] < 0 || place_[i] > sheet_.half_edges) continue;
      inside[{row_[i], place_[i]}] = i;
      const bool on_x = place_[i] == sheet_.half_edges, on_y = row_[i] == 0;
      freedoms.share[i] = (on_x ? 0.5 : 1) * (on_y ? 0.5 : 1);
      if (place_[i] <= 2) continue;
      const std::array<bool, 3> moves{!on_x, !on_y, true};
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (axes[axis] && moves[axis]) freedoms.of[i][axis].unknown = freedoms.count++;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const bool beyond_x = place_[i] > sheet_.half_edges, beyond_y = row_[i] < 0;
      if (!beyond_x && !beyond_y) continue;
      const auto original = inside.find(
          {std::abs(row_[i]), beyond_x ? 2 * sheet_.half_edges - place_[i] : place_[i]});
      if (original == inside.end()) continue;  // a border that no counted particle feels
      freedoms.of[i] = freedoms.of[original->second];
      if (beyond_x) freedoms.of[i][0].by = -1;
      if (beyond_y) freedoms.of[i][1].by = -1;
    }
    return freedoms;
  }

  double stress_across(const Triangle& t, const PerParticle3& x) const {
    const auto edges = [&](const PerParticle3& at) {
      Eigen::Matrix2d both;
      both << (at.col(t[1]) - at.col(t[0])).head<2>(), (at.col(t[2]) - at.col(t[0])).head<2>();
      return both;
    };
    const Eigen::Matrix2d F = edges(x) * edges(scene_.mesh.rest).inverse();
    const double along = F(0, 0) - 1, across = F(1, 1) - 1;
    const auto moduli = oracles::equilateral_sheet_moduli(sheet_.young);
    const double nu = moduli.poisson.value;
    return moduli.young.value / (1 - nu * nu) * (across + nu * along);
  }

  ClampedSheet sheet_;
  double edge_;  // m
  Scene scene_;
  Probe probe_;
  std::vector<int> row_, place_;  // of each particle; places in half edges from the border
  Freedoms in_plane_, normal_, all_;
};

struct Onset {
  double part = nan;     // of the flat rest's strain
  Eigen::VectorXd mode;  // the largest is 1
};

Onset onset_of(const Quarter& quarter, const PerParticle3& flat) {
  const SparseMatrix free = quarter.stiffness(quarter.normal(), quarter.stretched(0)),
                     pulled = quarter.stiffness(quarter.normal(), flat);
  SparseFactors factors;
  factors.analyzePattern(free);
  const auto stable = [&](double part) {
    factors.factorize((1 - part) * free + part * pulled);
    return positive_pivots(factors);
  };
  Onset onset;
  if (stable(1)) return onset;
  double lower = 0, upper = 1;
  for (int turn = 0; turn < 24; ++turn) {
    const double middle = (lower + upper) / 2;
    (stable(middle) ? lower : upper) = middle;
  }
  onset.part = lower;
  factors.factorize((1 - lower) * free + lower * pulled);
  onset.mode = Eigen::VectorXd::LinSpaced(free.rows(), 0, 1).array().square();
  for (int turn = 0; turn < 20; ++turn) onset.mode = factors.solve(onset.mode).normalized();
  onset.mode /= onset.mode.cwiseAbs().maxCoeff();
  return onset;
}

}  // namespace

double edge_of(const ClampedSheet& sheet) {
  return sheet.width / 2 / sheet.rows / (std::numbers::sqrt3 / 2);
}

double length_of(const ClampedSheet& sheet) {
  return (sheet.half_edges - 2 * clamp) * edge_of(sheet);
}

double wavelength_of(const Section& section) {
  double squares = 0, slopes = 0;
  for (std::size_t i = 0; i + 1 < section.places.size(); ++i) {
    const double a = section.heights[i], b = section.heights[i + 1];
    const double along = section.places[i + 1] - section.places[i];
    squares += along * (a * a + a * b + b * b) / 3;  // of straight pieces
    slopes += (b - a) * (b - a) / along;
  }
  return 2 * std::numbers::pi * std::sqrt(squares / slopes);
}

ClampedFlat clamped_flat(const Subject& subject, const ClampedSheet& sheet) {
  const Quarter quarter(subject, sheet);
  ClampedFlat flat;
  flat.x = quarter.settled(quarter.in_plane(), quarter.stretched(sheet.strain), sheet.strain).x;
  flat.tension = quarter.tension(flat.x);
  quarter.add_stresses(flat.x, flat);
  const Onset onset = onset_of(quarter, flat.x);
  flat.onset = onset.part;
  flat.heights = onset.mode;
  if (std::isfinite(onset.part))
    flat.mode = quarter.section(quarter.with_heights(flat.x, onset.mode));
  return flat;
}

ClampedWrinkles clamped_wrinkles(const Subject& subject, const ClampedSheet& sheet,
                                 const ClampedFlat& flat) {
  if (!std::isfinite(flat.onset))
    throw std::runtime_error("clamped_wrinkles: the flat sheet does not wrinkle");
  const Quarter quarter(subject, sheet);
  const double height = edge_of(sheet) / 10;
  const Settled rest = quarter.settled(
      quarter.all(), quarter.with_heights(flat.x, height * flat.heights), sheet.strain);
  return {quarter.tension(rest.x), quarter.section(rest.x), rest.unbalanced,
          positive_pivots(SparseFactors(quarter.stiffness(quarter.all(), rest.x)))};
}

}  // namespace foldproof
