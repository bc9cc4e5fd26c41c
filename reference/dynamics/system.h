// A system: masses, forces, filters and prescribed motion. It holds only what its scene names.
#pragma once

#include <vector>

#include "reference/dynamics/conjugate_gradient.h"
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
};

/// A system of free particles with these masses (N [kg], each > 0, else InputError),
/// without forces.
System make_system(PerParticle mass);

/// Lets the system's loops run on that many threads, by which no bit of a result changes. Call it
/// when all forces and filters are there.
void use_threads(System& system, int threads);

/// Prescribes the motion of a particle. Throws InputError if it is prescribed already or
/// does not exist.
void prescribe(System& system, const PrescribedParticle& particle);

/// Largest stable step of the undamped motion, from the bound on the elastic frequency: 2/omega
/// [s]; infinite without stiffness.
double elastic_limit(const System& system, const State& s);

/// The same for a scheme whose limit is widened by damping to h^2 K < 4 M + 2 h D (scheme C). In
/// steps up to 2 tau_s the damping of sticking outweighs its stiffness: max(limit, min(2/omega
/// without sticking's springs, 2 tau_s)) [s].
///   limit   the elastic limit [s]
double widened_limit(const System& system, const State& s, double limit);

/// Call once before each step: sticking bonds form and break, and self-collision updates its pair
/// cache. A second call changes nothing.
void begin_step(const System& system, State& s);

Energies energies(const System& system, const State& s);  // J

Vector3 linear_momentum(const System& system, const State& s);  // sum m v [kg m/s]
// sum m x x v about the origin [kg m^2/s]
Vector3 angular_momentum(const System& system, const State& s);

}  // namespace foldproof
