#include "convergence/validation/wrinkled_sheet.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "convergence/validation/freedoms.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

constexpr double tension_strain = 1e-7;  // T over Young's modulus [1]
constexpr int columns = 6;               // of triangles; the middle feels two edges to either side
constexpr int apart = 5;                 // rows at which two particles move the same ones no more

/// How the middle particle of a row, moved along the normal, pulls a particle of another row.
struct Influence {
  int row, moved_row;
  double across;     // from the one to the other [m]
  double stiffness;  // minus the force along the normal over the displacement [N/m]
};

/// The sheet, six triangles wide. Rows of particles are 0 to rows + 1; two at each end are held.
class Patch {
 public:
  Patch(const Subject& subject, const StretchedSheet& sheet)
      : sheet_(sheet),
        young_(sheet.tension / tension_strain),
        scene_(equilateral_sheet(sheet.rigidity, young_, edge_of(sheet), columns, sheet.rows + 1)),
        probe_(subject, scene_) {
    const PerParticle3& rest = scene_.mesh.rest;
    const double edge = edge_of(sheet), middle = columns * edge / 2;
    for (Eigen::Index i = 0; i < rest.cols(); ++i) {
      row_.push_back(int(std::lround(rest(1, i) / (edge * std::numbers::sqrt3 / 2))));
      // odd rows have theirs half an edge farther
      if (rest(0, i) > middle - 0.1 * edge && rest(0, i) < middle + 0.6 * edge)
        middles_.push_back(int(i));
    }
  }

  /// Under the tension T and the compression b.
  std::vector<Influence> influences(double b) const {
    const PerParticle3 flat = strained(b);
    const double shift = 1e-7 * edge_of(sheet_);
    std::vector<Influence> all;
    for (int first = 0; first < apart; ++first) {
      PerParticle3 up = flat, down = flat;
      for (int row = first; row < int(middles_.size()); row += apart) {
        up(2, middles_[std::size_t(row)]) += shift;
        down(2, middles_[std::size_t(row)]) -= shift;
      }
      const PerParticle3 change = probe_.elastic(resting_state(std::move(up))) -
                                  probe_.elastic(resting_state(std::move(down)));
      for (int i = 0; i < int(flat.cols()); ++i) {
        const int row = row_[std::size_t(i)], moved = nearest(row, first);
        if (moved < 0 || moved >= int(middles_.size())) continue;
        const double across = flat(0, i) - flat(0, middles_[std::size_t(moved)]);
        all.push_back({row, moved, across, -change(2, i) / (2 * shift)});
      }
    }
    return all;
  }

 private:
  /// The row of first, first + apart, ... that is at most two rows away.
  static int nearest(int row, int first) {
    return first + apart * int(std::floor(double(row - first + 2) / apart));
  }

  /// Flat, with the stresses T along and -b across.
  PerParticle3 strained(double b) const {
    const double poisson = oracles::equilateral_sheet_moduli(young_).poisson.value;
    PerParticle3 x = scene_.mesh.rest;
    x.row(0) *= 1 - (b + poisson * sheet_.tension) / young_;
    x.row(1) *= 1 + (sheet_.tension + poisson * b) / young_;
    return x;
  }

  StretchedSheet sheet_;
  double young_;  // N/m
  Scene scene_;
  Probe probe_;
  std::vector<int> row_;      // of each particle
  std::vector<int> middles_;  // one a row
};

/// K(k) of the free rows.
SparseMatrix stiffness_against_waves(const std::vector<Influence>& influences, int free, double k) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const Influence& one : influences) {
    const int row = one.row - 2, moved = one.moved_row - 2;
    if (row >= 0 && row < free && moved >= 0 && moved < free)
      entries.emplace_back(row, moved, one.stiffness * std::cos(k * one.across));
  }
  SparseMatrix K(free, free);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

/// The least b > 0 with K X = -b G X.
struct Onset {
  double b, change;
  Eigen::VectorXd profile;
};

Onset onset_of(const SparseMatrix& K, const SparseMatrix& G) {
  const SparseFactors factors(K);
  if (factors.info() != Eigen::Success || !(factors.vectorD().array() > 0).all())
    throw std::runtime_error("wrinkled: the sheet under tension alone is not stable");
  const Eigen::Index n = K.rows();
  Eigen::VectorXd X =
      (std::numbers::pi / double(n + 1) * Eigen::VectorXd::LinSpaced(n, 1, double(n)))
          .array()
          .sin();
  Onset onset{0, 1, {}};
  for (int turn = 0; turn < 80 && onset.change > 1e-12; ++turn) {
    X /= std::sqrt(X.dot(K * X));
    const Eigen::VectorXd next = factors.solve(-(G * X));
    const double b = 1 / X.dot(K * next);
    onset.change = std::abs(b / onset.b - 1);
    onset.b = b;
    X = next;
  }
  onset.profile = X / X.cwiseAbs().maxCoeff();
  return onset;
}

/// Where a function with one minimum in [lower, upper] is least, by golden sections,
/// to a part in 1e7.
template <class Function>
double argument_of_least(const Function& f, double lower, double upper) {
  const double golden = (std::numbers::phi - 1);
  double left = upper - golden * (upper - lower), right = lower + golden * (upper - lower);
  double at_left = f(left), at_right = f(right);
  while (upper - lower > 1e-7 * upper) {
    if (at_left < at_right) {
      upper = right;
      right = left;
      at_right = at_left;
      at_left = f(left = upper - golden * (upper - lower));
    } else {
      lower = left;
      left = right;
      at_left = at_right;
      at_right = f(right = lower + golden * (upper - lower));
    }
  }
  return (lower + upper) / 2;
}

}  // namespace

double edge_of(const StretchedSheet& sheet) {
  return sheet.length / sheet.rows / (std::numbers::sqrt3 / 2);
}

WrinkledSheet wrinkled(const Subject& subject, const StretchedSheet& sheet) {
  const Patch patch(subject, sheet);
  const double some = sheet.tension / 10;
  const std::vector<Influence> compressed = patch.influences(some),
                               pulled = patch.influences(-some);
  const auto onset_at = [&](double k) {
    const SparseMatrix more = stiffness_against_waves(compressed, sheet.rows - 2, k),
                       less = stiffness_against_waves(pulled, sheet.rows - 2, k);
    return onset_of((more + less) / 2, (more - less) / (2 * some));
  };
  // wavelengths from three edges to twice the length
  const double k =
      argument_of_least([&](double at) { return onset_at(at).b; }, std::numbers::pi / sheet.length,
                        2 * std::numbers::pi / (3 * edge_of(sheet)));
  const Onset onset = onset_at(k);
  WrinkledSheet result{2 * std::numbers::pi / k, onset.b, {0}, onset.change};
  for (const double X : onset.profile) result.profile.push_back(X);
  result.profile.push_back(0);
  return result;
}

}  // namespace foldproof
