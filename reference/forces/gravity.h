#pragma once

#include "reference/fast/team.h"
#include "reference/forces/energies.h"
#include "reference/types.h"

namespace foldproof {

/// A uniform force density: m_i g on every particle.
struct Gravity {
  static constexpr auto energy_term = &Energies::gravity;

  Vector3 acceleration;  // g [m/s^2]
  PerParticle mass;      // N [kg]
  Team team = {};

  void set_team(const Team& of, Eigen::Index) { team = of; }
  void add_elastic(const State& s, PerParticle3& f) const;
  double energy(const State& s) const;  // -sum m_i g.x_i [J], zero at the origin
};

}  // namespace foldproof
