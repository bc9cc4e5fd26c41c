// Rest: where the forces balance, found without inertia and without a guessed damping.
//
// Pseudo-transient continuation (Kelley and Keyes, SIAM J. Numer. Anal. 35, 1998): steps of
// backward Euler that forget their velocity,
//   (M/h^2 - dF/dx) dx = F,   x += dx,
// no longer than a given length, whose h grows until they are Newton's. Where cloth touches, F is
// the force that the filters leave, and a touching point is held along the normal: the primal-dual
// active set method (Hintermueller, Ito and Kunisch, SIAM J. Optim. 13, 2002).
#pragma once

#include <functional>
#include <string>

#include "reference/dynamics/freedoms.h"

namespace foldproof {

/// The forces at one x, as a step takes them.
struct Push {
  Eigen::VectorXd force;  // on the unknowns
  double unbalanced;      // how far from rest, over its scale [1]
};

/// What settles: functions of the positions x, 3 x N [m].
struct Settling {
  std::function<Push(const PerParticle3& x)> push;
  // the energy's Hessian over the unknowns, plus `mass_over` [1/s^2] times the masses
  std::function<SparseMatrix(const PerParticle3& x, Definiteness, double mass_over)> stiffness;
  std::function<PerParticle3(const PerParticle3& x, const Eigen::VectorXd& by)> moved;
  // Empty for what touches nothing. The forces that hold points which a displacement would take
  // into objects, from then on part of the stiffness; none: an empty vector.
  std::function<Eigen::VectorXd(const PerParticle3& x, const Eigen::VectorXd& by)> landing;
  // whether a step must be shorter, as it gains energy
  std::function<bool(const PerParticle3& from, const PerParticle3& to)> rises;
  double tolerance = 0;  // of Push::unbalanced [1]
  double longest = 0;    // displacement of a step [m]
  int most_steps = 600;
};

struct Settled {
  PerParticle3 x;
  double unbalanced = 0;  // as Push::unbalanced, at x [1]
  int steps = 0;          // those that were too long and taken again, too
};

/// Follows the forces from x. Unfinished after `most_steps`: `unbalanced` says so.
Settled settle(const Settling& settling, PerParticle3 x);

/// The forces that the filters leave on the particles of a state without velocity, 3 x N [N]: with
/// v what h F/m is after the filters, m v/h. Impulses of contact and friction are taken off, so
/// that a cloth lies still exactly where they vanish. h: step of the method [s].
PerParticle3 unbalanced_forces(const System& system, const State& s, double h, Work& work);

/// The largest of them, each over the weight of its particle (at 9.80665 m/s^2 without
/// gravity) [1], and where.
struct Unbalanced {
  double over_weight = 0;
  int particle = -1;
};
Unbalanced largest_unbalanced(const System& system, const PerParticle3& forces);

/// How much rounding of the positions alone changes the largest of them: a bound on the stiffness
/// times a rounding of the largest coordinate, over the least weight [1].
double rounding_over_weight(const System& system, const State& s);

/// g over the extent of the cloth: how strongly gravity holds a pendulum of its size [1/s^2].
double neutral_scale(const PerParticle3& x);

/// What still moves, or will, at a time and after it: "a prescribed particle", "an object"; or
/// "". There is no rest before.
std::string what_moves(const System& system, double t);

struct Rest {
  State state;            // without velocity
  Unbalanced unbalanced;  // what the filters leave
  int steps = 0;
  Work work;
  long factorisations = 0;
  // of the stiffness over the masses, touching points held as they are; negative: a saddle [1/s^2]
  double smallest_eigenvalue = 0;
  int touching = 0, sticking = 0;  // points on objects; of those, held by friction
  double used_friction = 0;  // largest |F_T| over mu |F_N| of a touching point [1]; 0: no friction
};

struct RestSearch {
  double tolerance = 1e-8;  // of the unbalanced force over the weight [1]
  double longest = 0;       // displacement of a step [m], > 0
  double step = 0;          // of the method, for the filters [s], > 0
  int most_steps = 600;
  int saddles = 0;  // that are left along their falling mode before the search ends
};

/// The rest that the forces lead to from the start. Velocities at the start are forgotten. Throws
/// InputError if something moves (what_moves), and for strain limits.
Rest settle(const System& system, const State& start, const RestSearch& search);

}  // namespace foldproof
