#include "verification/oracles/sheets/stretched_wrinkles.h"

#include <cmath>
#include <limits>

#include "reference/types.h"
#include "verification/oracles/gsl.h"

namespace foldproof::oracles {

namespace {

void require_known_reach(double reach) {
  if (!(reach >= 1e-4 && reach <= 0.1))
    throw InputError("oracle stretched_wrinkles: the reach must be from 1e-4 to 0.1");
}

// With L = T = 1, D = reach^2 and K = k^2 the equation is
//   reach^2 X'''' - (1 + 2 reach^2 K) X'' - (b K - reach^2 K^2) X = 0.
// X'' = -p^2 X and X'' = m^2 X solve it if
//   m^2 = p^2 + 1/reach^2 + 2 K,   b = reach^2 (K + p^2 m^2/K).

/// The profile for one K. Clamped: p tan(p/2) + m tanh(m/2) = 0; the least p is in (pi, 2 pi).
struct Profile {
  double p, m;
};

Profile profile_of(double reach, double K) {
  const auto m_of = [&](double p) { return std::sqrt(p * p + 1 / (reach * reach) + 2 * K); };
  const auto slope = [&](double p) {
    // times cos(p/2), to avoid a pole
    return p * std::sin(p / 2) + m_of(p) * std::tanh(m_of(p) / 2) * std::cos(p / 2);
  };
  const double p = bracketed_root(slope, pi, 2 * pi, 0).value;
  return {p, m_of(p)};
}

double compression_of(double reach, double K) {
  const Profile at = profile_of(reach, K);
  return reach * reach * (K + at.p * at.p * at.m * at.m / K);
}

/// db/dK over reach^2, from the derivative of p along the clamped profiles.
double slope_of_compression(double reach, double K) {
  const auto [p, m] = profile_of(reach, K);
  const double c = std::cos(p / 2), t = std::tanh(m / 2);
  const double along_p = std::tan(p / 2) + p / 2 / (c * c);
  const double along_m = t + m / 2 * (1 - t * t);
  const double dp = -along_m / m / (along_p + along_m * p / m);  // 2 m dm = 2 p dp + 2 dK
  const double dp_squared = 2 * p * dp, dm_squared = dp_squared + 2;
  return 1 - p * p * m * m / (K * K) + (m * m * dp_squared + p * p * dm_squared) / K;
}

/// K of the least compression.
Estimate best_by_functions(double reach) {
  return bracketed_root([&](double K) { return slope_of_compression(reach, K); }, 1 / reach,
                        20 / reach, 0);
}

/// Factors c_j of 1 - cos(2 pi j s), j = 1, ..., of the least energy for one K. With q = 2 pi
/// j the energy is
///   sum c_j^2 (reach^2 q^4 + (1 + 2 reach^2 K) q^2 + reach^2 K^2)/2 + reach^2 K^2 (sum c_j)^2,
/// and b K times sum c_j^2/2 + (sum c_j)^2 equals it. So with sum c_j = 1
///   c_j = (b K - reach^2 K^2)/own_j,   own_j = (reach^2 q^4 + ... + reach^2 K^2 - b K)/2,
/// and b is where they add up to 1.
struct Series {
  double reach, K;

  double own(double q, double b) const {
    const double D = reach * reach, q2 = q * q;
    return (D * q2 * q2 + (1 + 2 * D * K) * q2 + D * K * K - b * K) / 2;
  }

  /// Calls visit(q, c) for each j.
  template <class Visit>
  void each(double b, const Visit& visit) const {
    const double load = b * K - reach * reach * K * K;
    for (int j = 20000; j >= 1; --j) visit(2 * pi * j, load / own(2 * pi * j, b));
  }

  double sum(double b) const {
    double total = 0;
    each(b, [&](double, double c) { total += c; });
    return total;
  }

  double compression() const {
    // between zero load and the load of j = 1 alone
    const double D = reach * reach, none = D * K, q = 2 * pi;
    const double first = (D * std::pow(q, 4) + (1 + 2 * D * K) * q * q + D * K * K) / K;
    const double close = 1e-9 * (first - none);
    return bracketed_root([&](double b) { return sum(b) - 1; }, none + close, first - close, 0)
        .value;
  }

  /// K for which this profile's b = (energy without K + ...)/K is least.
  double best(double b) const {
    double squares = 0, energy = 0;
    each(b, [&](double q, double c) {
      squares += c * c / 2;
      energy += c * c / 2 * (reach * reach * std::pow(q, 4) + q * q);
    });
    return std::sqrt(energy / (squares + 1)) / reach;
  }
};

double wavelength_of(double K) { return 2 * pi / std::sqrt(K); }

}  // namespace

Wrinkles wrinkles_by_functions(double reach) {
  require_known_reach(reach);
  const Estimate K = best_by_functions(reach);
  const double rounding = 1e4 * std::numeric_limits<double>::epsilon();
  const double off = K.uncertainty / K.value + rounding;
  const double b = compression_of(reach, K.value);
  return {{wavelength_of(K.value), off * wavelength_of(K.value)}, {b, rounding * b}};
}

Wrinkles wrinkles_by_series(double reach) {
  require_known_reach(reach);
  Series series{reach, pi / reach};
  double b = 0, change = 1;
  for (int turn = 0; turn < 40 && change > 1e-13; ++turn) {
    b = series.compression();
    const double next = series.best(b);
    change = std::abs(next / series.K - 1);
    series.K = next;
  }
  // terms omitted from the sum, each below 2 b K/(reach q^2)^2
  const double left_out = 2 * b * series.K / (3 * std::pow(2 * pi, 4) * 8e12 * reach * reach);
  const double off = change + left_out + 1e-11;
  return {{wavelength_of(series.K), off * wavelength_of(series.K)}, {b, off * b}};
}

std::vector<double> wrinkle_profile(double reach, std::span<const double> places) {
  require_known_reach(reach);
  const auto [p, m] = profile_of(reach, best_by_functions(reach).value);
  const auto shape = [&](double s) {
    // cosh(m s)/cosh(m/2) without overflow
    const double layer = (std::exp(m * (s - 0.5)) + std::exp(-m * (s + 0.5))) / (1 + std::exp(-m));
    return std::cos(p * s) / std::cos(p / 2) - layer;
  };
  std::vector<double> profile;
  for (const double place : places) profile.push_back(shape(std::abs(place - 0.5)) / shape(0));
  return profile;
}

Wrinkles wrinkles_by_scaling(double reach) {
  const Wrinkles whole = wrinkles_by_functions(reach);
  const double wavelength = 2 * std::sqrt(pi * reach), b = 2 * pi * reach;
  const auto away = [](double value, const Estimate& from) {
    return Estimate{value, std::abs(value - from.value) + from.uncertainty};
  };
  return {away(wavelength, whole.wavelength), away(b, whole.compression)};
}

Estimate rigidity_under_tension(double D, double T, double edge, double k) {
  const double by_tension = T * edge * edge / 48;
  return {D + by_tension, by_tension * std::pow(k * edge, 2) / 24};
}

}  // namespace foldproof::oracles
