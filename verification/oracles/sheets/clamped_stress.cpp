#include "verification/oracles/sheets/clamped_stress.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "reference/types.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/oracles/gauss.h"

namespace foldproof::oracles {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// Terms along and across. Stresses are infinite in the corners, so errors fall with a power of
// these numbers; half as many terms give an error estimate.
constexpr int terms_along = 24, terms_across = 16;

enum class Parity { even, odd };

/// Functions of one coordinate from 0, on a middle line, to 1: a column each, a row per place.
struct Functions {
  Matrix value, first, second;  // derivatives
};

/// Legendre's polynomials of even or odd degrees.
Functions legendre(Parity parity, int count, const Vector& s) {
  const int most = 2 * count;
  Matrix P = Matrix::Zero(s.size(), most + 1), first = P, second = P;
  P.col(0).setOnes();
  P.col(1) = s;
  first.col(1).setOnes();
  for (int k = 1; k < most; ++k) {
    P.col(k + 1) =
        ((2 * k + 1) * s.array() * P.col(k).array() - k * P.col(k - 1).array()) / (k + 1);
    first.col(k + 1) = first.col(k - 1) + (2 * k + 1) * P.col(k);
    second.col(k + 1) = second.col(k - 1) + (2 * k + 1) * first.col(k);
  }
  const auto chosen = Eigen::seqN(parity == Parity::even ? 0 : 1, count, 2);
  return {P(Eigen::all, chosen), first(Eigen::all, chosen), second(Eigen::all, chosen)};
}

/// Times 1 - s^2.
Functions zero_at_end(const Functions& f, const Vector& s) {
  const Vector q = 1 - s.array().square(), dq = -2 * s;
  return {q.asDiagonal() * f.value, Matrix(dq.asDiagonal() * f.value) + q.asDiagonal() * f.first,
          -2 * f.value + 2 * (dq.asDiagonal() * f.first) + q.asDiagonal() * f.second};
}

/// With derivatives by a coordinate that ends at `end`.
Functions over(Functions f, double end) {
  f.first /= end;
  f.second /= end * end;
  return f;
}

/// Products of every function along with every function across: rows and columns, or single ones.
Matrix products(const Matrix& along, const Matrix& across) {
  Matrix all(along.rows() * across.rows(), along.cols() * across.cols());
  for (Eigen::Index i = 0; i < along.rows(); ++i)
    for (Eigen::Index j = 0; j < along.cols(); ++j)
      all.block(i * across.rows(), j * across.cols(), across.rows(), across.cols()) =
          along(i, j) * across;
  return all;
}

Matrix integrals(const Matrix& one, const Vector& weight, const Matrix& other) {
  return one.transpose() * weight.asDiagonal() * other;
}

Vector integrals(const Matrix& one, const Vector& weight) { return one.transpose() * weight; }

/// A quarter of the sheet, W = 1; the middle of the sheet is at the origin.
struct Quarter {
  double half_length, nu;
  Gauss x, y;
  Vector places;  // on the middle line; distance from the middle over half the length
  int along, across;

  Quarter(const ClampedRectangle& sheet, std::span<const double> from_clamp, int divided)
      : half_length(sheet.length_over_width / 2),
        nu(sheet.poisson),
        x(2 * terms_along + 4),
        y(2 * terms_across + 4),
        places(Eigen::Index(from_clamp.size())),
        along(terms_along / divided),
        across(terms_across / divided) {
    for (Eigen::Index i = 0; i < places.size(); ++i) places[i] = 1 - 2 * from_clamp[std::size_t(i)];
  }
};

constexpr double half_width = 0.5;  // W/2

Vector by_stresses(const Quarter& q) {
  const auto free_edge = [&](const Vector& s) {
    const Functions once = zero_at_end(legendre(Parity::even, q.across, s), s);
    return over(zero_at_end(once, s), half_width);
  };
  const auto along = [&](const Vector& s) {
    return over(legendre(Parity::even, q.along, s), q.half_length);
  };
  const Functions X = along(q.x.s), Y = free_edge(q.y.s);
  const Vector &wx = q.x.weight, &wy = q.y.weight;
  const Matrix both = products(integrals(X.value, wx, X.second), integrals(Y.second, wy, Y.value));
  const Matrix energy =
      products(integrals(X.value, wx, X.value), integrals(Y.second, wy, Y.second)) +
      products(integrals(X.second, wx, X.second), integrals(Y.value, wy, Y.value)) -
      q.nu * (both + both.transpose()) +
      2 * (1 + q.nu) * products(integrals(X.first, wx, X.first), integrals(Y.first, wy, Y.first));
  const Vector load = products(integrals(X.value, wx), integrals(Y.second, wy)) -
                      q.nu * products(integrals(X.second, wx), integrals(Y.value, wy));
  const Vector c = solve_symmetric(energy, -load);
  return products(along(q.places).second, free_edge(Vector::Zero(1)).value) * c;
}

Vector by_displacements(const Quarter& q) {
  const auto u_along = [&](const Vector& s) {
    return over(zero_at_end(legendre(Parity::odd, q.along, s), s), q.half_length);
  };
  const auto v_along = [&](const Vector& s) {
    return over(zero_at_end(legendre(Parity::even, q.along, s), s), q.half_length);
  };
  const auto across = [&](Parity parity, const Vector& s) {
    return over(legendre(parity, q.across, s), half_width);
  };
  const Functions U = u_along(q.x.s), V = v_along(q.x.s), even = across(Parity::even, q.y.s),
                  odd = across(Parity::odd, q.y.s);
  const Vector &wx = q.x.weight, &wy = q.y.weight;
  const double E = 1 / (1 - q.nu * q.nu), G = 1 / (2 * (1 + q.nu));  // over Young's modulus
  const Eigen::Index n = q.along * q.across;
  Matrix energy(2 * n, 2 * n);
  energy.topLeftCorner(n, n) =
      E * products(integrals(U.first, wx, U.first), integrals(even.value, wy, even.value)) +
      G * products(integrals(U.value, wx, U.value), integrals(even.first, wy, even.first));
  energy.bottomRightCorner(n, n) =
      E * products(integrals(V.value, wx, V.value), integrals(odd.first, wy, odd.first)) +
      G * products(integrals(V.first, wx, V.first), integrals(odd.value, wy, odd.value));
  energy.topRightCorner(n, n) =
      E * q.nu * products(integrals(U.first, wx, V.value), integrals(even.value, wy, odd.first)) +
      G * products(integrals(U.value, wx, V.first), integrals(even.first, wy, odd.value));
  energy.bottomLeftCorner(n, n) = energy.topRightCorner(n, n).transpose();
  Vector load(2 * n);
  load << E * products(integrals(U.first, wx), integrals(even.value, wy)),
      E * q.nu * products(integrals(V.value, wx), integrals(odd.first, wy));
  const Vector c = solve_symmetric(energy, -load);

  // strains on the middle line, and their means over the middle section
  const Vector zero = Vector::Zero(1);
  const auto a = c.head(n), b = c.tail(n);
  const Vector along = products(u_along(q.places).first, across(Parity::even, zero).value) * a,
               narrowed = products(v_along(q.places).value, across(Parity::odd, zero).first) * b;
  const double mean_along =
      (products(u_along(zero).first, integrals(even.value, wy).transpose()) * a).value();
  const double mean_narrowed =
      (products(v_along(zero).value, integrals(odd.first, wy).transpose()) * b).value();
  const double T = E * (1 + mean_along + q.nu * mean_narrowed);
  return E / T * (narrowed.array() + q.nu * (1 + along.array()));
}

std::vector<Estimate> with_errors(const ClampedRectangle& sheet, std::span<const double> places,
                                  Vector (*solve)(const Quarter&)) {
  const double ratio = sheet.length_over_width;
  const auto far = [](double s) { return s >= 0.05 && s <= 0.5; };
  if (!(ratio >= 0.5 && ratio <= 5 && sheet.poisson >= 0 && sheet.poisson < 0.5) ||
      !std::ranges::all_of(places, far))
    throw InputError("oracle clamped_stress: a length, Poisson's ratio or place out of range");
  const Vector fine = solve(Quarter(sheet, places, 1)), coarse = solve(Quarter(sheet, places, 2));
  std::vector<Estimate> stresses;
  for (Eigen::Index i = 0; i < fine.size(); ++i)
    stresses.push_back({fine[i], std::abs(fine[i] - coarse[i]) + 1e-10});
  return stresses;
}

}  // namespace

std::vector<Estimate> clamped_stress_by_stresses(const ClampedRectangle& sheet,
                                                 std::span<const double> places) {
  return with_errors(sheet, places, by_stresses);
}

std::vector<Estimate> clamped_stress_by_displacements(const ClampedRectangle& sheet,
                                                      std::span<const double> places) {
  return with_errors(sheet, places, by_displacements);
}

}  // namespace foldproof::oracles
