// A system: masses, forces, filters and prescribed motion, but only those that its scene names.
#pragma once

#include <vector>

#include "reference/dynamics/solver_settings.h"
#include "reference/fast/team.h"
#include "reference/filters/filter.h"
#include "reference/forces/force.h"
#include "reference/motion/motion.h"
#include "reference/types.h"

namespace foldproof {

struct System {
  PerParticle mass;          // N [kg]
  PerParticle inverse_mass;  // N [1/kg]; 0 where the motion is prescribed
  std::vector<Force> forces;
  std::vector<Filter> filters;
  std::vector<PrescribedParticle> prescribed;
  SolverSettings solver;
  Team team = {};  // its loops run on it; set_team
};

/// A system of free particles with these masses (N [kg], each > 0, else InputError),
/// without forces.
System make_system(PerParticle mass);

/// Runs the loops of the system, its forces and its filters on the team; results stay the same bit
/// for bit. Call it after all forces and filters have been added.
void set_team(System& system, const Team& team);

/// Prescribes the motion of a particle. Throws InputError if it is prescribed already or
/// does not exist.
void prescribe(System& system, const PrescribedParticle& particle);

/// Largest stable step of the undamped motion, from the bound on the elastic frequency: 2/omega
/// [s]; infinite without stiffness. Here and below, the `work` of a run gives access to the values
/// that the run keeps.
double elastic_limit(const System& system, const State& s, const Work& work = {});

/// The same for a scheme whose limit is widened by damping to h^2 K < 4 M + 2 h D (scheme C). In
/// steps up to 2 tau_s the damping of sticking outweighs its stiffness: max(limit, min(2/omega
/// without sticking springs, 2 tau_s)) [s].
///   limit   the elastic limit [s]
double widened_limit(const System& system, const State& s, double limit, const Work& work = {});

/// Call once before each step: sticking bonds form and break, and self-collision searches for the
/// pairs that may meet in the next steps. A second call changes nothing.
void begin_step(const System& system, State& s, const Work& work = {});

Energies energies(const System& system, const State& s, const Work& work = {});  // J

Vector3 linear_momentum(const System& system, const State& s);  // sum m v [kg m/s]
// sum m x x v about the origin [kg m^2/s]
Vector3 angular_momentum(const System& system, const State& s);

}  // namespace foldproof
