// The buckling spring of Choi and Ko (2002), as later papers describe it, and a column of such
// springs: a model to compare with.
#pragma once

#include <vector>

#include "reference/types.h"

namespace foldproof {

//   A spring between particles two apart models a piece of cloth of length L that bends into an arc
//   when they approach: with kappa its curvature and a = kappa L/2,
//     |d| = L sin(a)/a,   energy = k_b L kappa^2/2,   force = k_b kappa^2/(cos(a) - sin(a)/a) < 0.
//   At a = 0 that force is -12 k_b/L^2: a barrier. Near it a line c_b (|d| - L) acts instead:
//   the weaker of the two counts. There is no force beyond L.
struct BucklingSpring {
  double length;   // L [m]
  double bending;  // k_b [N m^2]
  double slope;    // c_b [N/m]
  double meeting;  // the distance at which the line meets the arc's force [m]

  double arc_force(double distance) const;   // [N], of the arc alone, distance < L
  double arc_energy(double distance) const;  // [J]
  double force(double distance) const;       // [N], negative: it pushes
  double energy(double distance) const;      // [J], of force()
  double stiffness(double distance) const;   // [N/m], its derivative
};

/// The meeting distance is found by bisection. length [m], bending [N m^2], slope [N/m].
BucklingSpring make_buckling_spring(double length, double bending, double slope);

/// Implicit method for the steps of a column; each step is one linear solve that neglects the
/// springs' push across their axis.
enum class ColumnMethod { backward_euler, bdf2 };

/// A column of particles in a plane. Neighbours are joined by springs that only pull, particles two
/// apart by buckling springs. The two particles at each end are held.
struct BucklingColumn {
  int particles = 17;
  double spacing = 0.01;  // m
  double mass = 2e-5;     // kg, of each particle
  double pull = 1000;     // N/m
  BucklingSpring spring = make_buckling_spring(0.02, 1e-6, 100);

  /// Longest stable step of an explicit method, from the pulling springs alone [s].
  double elastic_limit() const;
};

/// Energies of an undamped column that is shortened by a fifth within 0.05 s, then held still [J].
struct Shortening {
  double at_the_stop, largest_after, at_the_end;
  double speed;  // the largest at the end [m/s]
};
Shortening shorten(const BucklingColumn& column, ColumnMethod method, double h, int steps);

/// The least stiffness across a straight column, evenly shortened by this strain [N/m]: negative
/// once it buckles.
double stiffness_across(const BucklingColumn& column, double strain);

}  // namespace foldproof
