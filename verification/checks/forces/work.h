// Work of a subject's elastic forces along paths through the space of all positions.
#pragma once

#include <functional>

#include "verification/oracles/estimate.h"
#include "verification/specimens/probe.h"

namespace foldproof {

/// Positions and their derivative, 3 x N [m], as functions of a parameter from 0 to 1.
struct Path {
  std::function<PerParticle3(double)> x, slope;
};

/// A straight line through x in a random direction, particles moving by up to `size`
/// [m] either way.
Path random_line(const PerParticle3& x, double size, unsigned seed);

/// An ellipse about x in a random plane, particles moving by up to `size` [m] along
/// each of its axes.
Path random_loop(const PerParticle3& x, double size, unsigned seed);

/// |E(1) - E(0) + work| over epsilon times (integral of |F||dx| + |E(0)| + |E(1)|). Gauss-Legendre
/// quadrature of tenth order on 8, 16, ... up to 128 panels, until two results agree to rounding;
/// their difference is the uncertainty.
oracles::Estimate energy_against_work(const Probe& probe, const Path& path);

/// Work of the elastic forces once around a closed path.
struct RoundTrip {
  double work = 0, uncertainty = 0;  // J
  double scale = 0;                  // integral of |F||dx| [J]
};

/// By the trapezoidal rule, which converges exponentially on a smooth closed path, on 64, 128, ...
/// up to 1024 points, until two results agree to rounding; their difference is the uncertainty.
RoundTrip round_trip(const Probe& probe, const Path& loop);

}  // namespace foldproof
