// Laws that every damping force obeys, measured on any scene.
#pragma once

#include <string>
#include <vector>

#include "verification/specimens/probe.h"

namespace foldproof {

/// A scene with damping, small enough for a dense matrix, and one of its states.
struct DampedScene {
  std::string name;
  Scene scene;
  State state;
};

struct DampingPower {
  double power;  // sum of v_i.F_i [W]; negative when the motion loses energy
  double share;  // power over sum |v_i||F_i| [1], from -1 to 1; NaN without any force
};

/// At the state's own velocities.
DampingPower damping_power_of(const Probe& probe, const State& s);

/// A table for damping powers, one case per row: name, `share` and power.
Table no_powers();

/// The largest `share` of the table, with its sign: negative when every motion loses energy.
Finding dissipation(const Table& powers);

/// Largest entry of D - D^T, over epsilon times the largest entry of D.
Finding asymmetry(const Subject& subject, const std::vector<DampedScene>& cases);

/// Largest eigenvalue of D over epsilon 3N times the largest in magnitude; both ends of the
/// spectrum as evidence.
Finding largest_eigenvalue(const Subject& subject, const std::vector<DampedScene>& cases);

}  // namespace foldproof
