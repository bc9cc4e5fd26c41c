#include "reference/filters/strain_limit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace foldproof {

namespace {

// A predicted length this near to a limit counts as at it: a spring corrected to rounding is not
// corrected again.
constexpr double at_the_limit = 8 * std::numeric_limits<double>::epsilon();

/// State of the springs in a sweep before correction.
struct SweepResult {
  double violation = 0;  // the largest, over the rest length [1]
  long corrected = 0, unreachable = 0;
};

/// One spring beyond a limit: the correction that an impulse along d has to make.
struct Correction {
  double violation = 0;  // over the rest length [1]
  double share = 0;      // the change of h dv along d, over d [1]
  bool is_reachable = true;
};

//   a ----- b    d = x_b - x_a,  u = v_b - v_a
//                p = d + h u is predicted, T is the limit that |p| is beyond
//
// Impulses along d change p to p + s d:
//
//   s^2 d.d + 2 s p.d + p.p - T^2 = 0,   with the roots
//   s = (-p.d +- r)/d.d,   r^2 = (p.d)^2 - d.d (p.p - T^2) = d.d T^2 - h^2 |d x u|^2
//
// We take the root with +r: then (p + s d).d = r >= 0, so the spring keeps its direction. It is
// written so that nothing cancels. If the part of h u across d is longer than T (only beyond the
// upper limit), there is no root. Then r = 0 gives the least reachable length, the limit of the
// root when T is barely reached.
Correction correction_of(const Vector3& d, const Vector3& u, double h, double limit) {
  Correction result;
  const Vector3 p = d + h * u;
  const double dd = d.squaredNorm(), pd = p.dot(d);
  const double squared_root = dd * limit * limit - h * h * d.cross(u).squaredNorm();
  result.is_reachable = squared_root >= 0;
  const double r = result.is_reachable ? std::sqrt(squared_root) : 0;
  const bool cancels = pd > 0 && result.is_reachable;
  result.share = cancels ? (limit * limit - p.squaredNorm()) / (r + pd) : (r - pd) / dd;
  return result;
}

/// Of a range: lengths over the rest length, and squares at which corrections begin [1].
struct LengthBounds {
  double lower, upper, lower_squared, upper_squared;

  explicit LengthBounds(const StrainRange& range)
      : lower(1 - range.compression),
        upper(1 + range.extension),
        lower_squared(std::pow(lower * (1 - at_the_limit), 2)),
        upper_squared(std::pow(upper * (1 + at_the_limit), 2)) {}
};

/// The springs of a call.
class Sweeps {
 public:
  Sweeps(const StrainLimiter& limiter, double h, const PerParticle3& x, PerParticle3& v)
      : limiter_(limiter),
        h_(h),
        x_(x),
        v_(v),
        bounds_(limiter.ranges.begin(), limiter.ranges.end()) {}

  /// number: index of the sweep, from 0.
  SweepResult sweep(int number) {
    if (limiter_.limits.order == SweepOrder::jacobi) return jacobi_sweep();
    const bool backwards = limiter_.limits.order == SweepOrder::alternating && number % 2 == 1;
    SweepResult result;
    if (backwards)
      for (auto spring = limiter_.springs.rbegin(); spring != limiter_.springs.rend(); ++spring)
        correct(*spring, result);
    else
      for (const LimitedSpring& spring : limiter_.springs) correct(spring, result);
    return result;
  }

  /// The largest violation now, over the rest length [1].
  double remaining_violation() const {
    double largest = 0;
    for (const LimitedSpring& spring : limiter_.springs)
      update_worst(largest, needed_correction(spring).violation);
    return largest;
  }

 private:
  /// The correction that the spring needs; its violation is 0 within the limits, which needs no
  /// square root to test.
  Correction needed_correction(const LimitedSpring& spring) const {
    const Vector3 d = x_.col(spring.b) - x_.col(spring.a), u = v_.col(spring.b) - v_.col(spring.a);
    const LengthBounds& bounds = bounds_[size_t(spring.range)];
    const double L0 = spring.rest_length, squared = (d + h_ * u).squaredNorm();
    if (squared <= bounds.upper_squared * L0 * L0 && squared >= bounds.lower_squared * L0 * L0)
      return {};
    const double strain = std::sqrt(squared) / L0;
    const double limit = strain < bounds.lower ? bounds.lower : bounds.upper;
    Correction result = correction_of(d, u, h_, limit * L0);
    result.violation = std::abs(strain - limit);
    return result;
  }

  /// Adds the impulse that changes h dv by share * d.
  void push(const LimitedSpring& spring, double share) {
    const double wa = limiter_.inverse_mass[spring.a], wb = limiter_.inverse_mass[spring.b];
    const Vector3 change = share / (h_ * (wa + wb)) * (x_.col(spring.b) - x_.col(spring.a));
    if (wa > 0) v_.col(spring.a) -= wa * change;
    if (wb > 0) v_.col(spring.b) += wb * change;
  }

  /// Counts requested corrections. False if there is nothing to correct: within the limits, both
  /// ends prescribed, or zero length, which has no direction.
  bool record(const LimitedSpring& spring, const Correction& needed, SweepResult& result) const {
    if (needed.violation == 0) return false;
    update_worst(result.violation, needed.violation);
    const bool is_held = limiter_.inverse_mass[spring.a] + limiter_.inverse_mass[spring.b] == 0;
    if (!needed.is_reachable || is_held || !std::isfinite(needed.share)) ++result.unreachable;
    if (is_held || !std::isfinite(needed.share)) return false;
    ++result.corrected;
    return true;
  }

  void correct(const LimitedSpring& spring, SweepResult& result) {
    const Correction needed = needed_correction(spring);
    if (record(spring, needed, result)) push(spring, needed.share);
  }

  // Where n impulses meet at a particle each is divided by n, at both of its ends, or momentum
  // would not be conserved. Near the limits a full impulse is a projection P_i, in the
  // mass-weighted norm, that acts on two particles. So sum_i P_i/n_i is at most one, and the sweep
  // is a mean of projections: it never leads away from velocities within the limits, and converges
  // to such velocities if there are any.
  SweepResult jacobi_sweep() {
    const std::vector<LimitedSpring>& springs = limiter_.springs;
    SweepResult result;
    std::vector<std::pair<int, double>> shares;  // of springs to be corrected
    std::vector<int> impulses_at(size_t(v_.cols()), 0);
    for (size_t i = 0; i < springs.size(); ++i) {
      const Correction needed = needed_correction(springs[i]);
      if (!record(springs[i], needed, result)) continue;
      shares.emplace_back(int(i), needed.share);
      for (const int end : {springs[i].a, springs[i].b})
        if (limiter_.inverse_mass[end] > 0) ++impulses_at[size_t(end)];
    }
    for (const auto& [i, share] : shares) {
      const LimitedSpring& spring = springs[size_t(i)];
      push(spring, share / std::max(impulses_at[size_t(spring.a)], impulses_at[size_t(spring.b)]));
    }
    return result;
  }

  const StrainLimiter& limiter_;
  double h_;
  const PerParticle3& x_;
  PerParticle3& v_;
  std::vector<LengthBounds> bounds_;  // of the ranges
};

}  // namespace

StrainSweeps limit_strain(const StrainLimiter& limiter, double h, const PerParticle3& x,
                          PerParticle3& v) {
  Sweeps sweeps(limiter, h, x, v);
  StrainSweeps done;
  while (true) {
    const SweepResult result = sweeps.sweep(done.sweeps);
    ++done.sweeps;
    done.unreachable = result.unreachable;
    done.remaining_violation = result.violation;
    if (result.corrected == 0) return done;
    const bool is_last = done.sweeps >= limiter.limits.sweeps;
    if (!is_last && !(result.violation <= limiter.limits.tolerance)) continue;
    done.remaining_violation = sweeps.remaining_violation();
    if (is_last || done.remaining_violation <= limiter.limits.tolerance) return done;
  }
}

void StrainLimiter::correct(const Span& span, const State& s, PerParticle3& v, Work& work) const {
  const StrainSweeps done = limit_strain(*this, span.step, s.x, v);
  work.strain_sweeps += done.sweeps;
  update_worst(work.strain_left, done.remaining_violation);
}

}  // namespace foldproof
