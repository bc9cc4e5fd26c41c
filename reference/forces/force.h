// The table of forces.
#pragma once

#include <concepts>
#include <functional>
#include <memory>
#include <variant>
#include <vector>

#include "reference/forces/bending.h"
#include "reference/forces/damping.h"
#include "reference/forces/energies.h"
#include "reference/forces/force_differential.h"
#include "reference/forces/gravity.h"
#include "reference/forces/springs.h"
#include "reference/forces/sticking.h"
#include "reference/types.h"

namespace foldproof {

/// A force given as functions: of what the paper does not have (reference/beyond/), of manufactured
/// solutions, of experiments. Empty functions add nothing.
struct CustomForce {
  double Energies::*energy_term = &Energies::custom;
  // False: all functions depend on time, positions and bonds alone, and their last values may be
  // used again. True: on velocities, too. Schemes A, B and C evaluate them at the end of a step
  // with a velocity extrapolated to it, 2 v_{n+1/2} - v_n.
  bool needs_velocity = true;

  std::function<void(const State& s, PerParticle3& f)> elastic;
  // linear in v, symmetric, dissipating
  std::function<DampingOperator::Custom(const State& s)> damping;
  // derivative of `elastic` with respect to the positions: linear in dx, symmetric
  using Product = std::function<void(const PerParticle3& dx, PerParticle3& df)>;
  std::function<Product(const State& s, Definiteness)> differential;
  std::function<double(const State& s)> potential;                              // [J]
  std::function<void(const State& s, PerParticle& rows)> stiffness_bound = {};  // see below [N/m]

  void add_elastic(const State& s, PerParticle3& f) const {
    if (elastic) elastic(s, f);
  }
  double energy(const State& s) const { return potential ? potential(s) : 0; }
  void prepare_damping(const State& s, DampingOperator& terms) const;
  void add_elastic_differential(const State& s, Definiteness, ForceDifferential& sum) const;
  void add_force_differential(const State& s, ForceDifferential& sum) const;
  void add_stiffness_bound(const State& s, PerParticle& rows) const {
    if (stiffness_bound) stiffness_bound(s, rows);
  }
};

/// One force: an elastic or external part that depends on time and positions, and an energy. It may
/// also offer these functions, which are looked up by name:
///   shapes_at(x)                                              if it consists of elements
///   prepare_damping(s, damping)                               if it damps
///   add_elastic_differential(s, definiteness, differential),
///   add_force_differential(s, differential)                   for fully implicit methods
///   add_stiffness_bound(s, rows)                              to limit automatic steps
///   add_bound_without_springs(s, rows),
///   shortest_forecast(s)                                      if forecasts stabilise a part
///   update_bonds(s)                                           if bonds form and break
/// A force with shapes receives the shapes at s.x after s: add_elastic(s, shapes, f) and so on. Its
/// differentials do not.
template <class F>
concept HasShapes = requires(const F force, const PerParticle3 x) {
  force.shapes_at(x);
};

template <class F, class... Shapes>
concept ForceWith = requires(const F force, const State s, const Shapes... shapes, PerParticle3 f,
                             Energies energies) {
  force.add_elastic(s, shapes..., f);  // f += F_e(t, x); adds and clears nothing
  { force.energy(s, shapes...) } -> std::convertible_to<double>;
  { energies.*force.energy_term } -> std::same_as<double&>;  // the term of its energy
};

using Force = std::variant<Gravity, StretchSprings, Bending, Sticking, CustomForce>;
static_assert(ForceWith<Gravity> && ForceWith<StretchSprings, SpringShapes> &&
              ForceWith<Bending, HingeShapes> && ForceWith<Sticking> && ForceWith<CustomForce>);

/// The shapes of each force's elements at one x, in the order of the forces.
using Shapes = std::vector<std::variant<std::monostate, SpringShapes, HingeShapes>>;

/// Calls act(force, s), or act(force, s, shapes) with its own shapes, for each force, with its own
/// type, in order.
template <class Act>
void for_each_force(const std::vector<Force>& forces, const State& s, const Shapes& shapes,
                    const Act& act) {
  for (size_t k = 0; k < forces.size(); ++k)
    std::visit(
        [&]<class F>(const F& force) {
          if constexpr (HasShapes<F>)
            act(force, s, std::get<decltype(force.shapes_at(s.x))>(shapes[k]));
          else
            act(force, s);
        },
        forces[k]);
}

/// The forces at one state, as a step needs them.
struct Forces {
  std::shared_ptr<const PerParticle3> elastic;  // 3 x N [N], external forces included
  std::shared_ptr<const DampingOperator> damping;
};

// All forces at a state. If the run keeps values (Work::kept), the last ones are reused: shapes for
// the same x; forces for the same x, time and bonds if none needs velocities. `work` counts both
// alike.
std::shared_ptr<const Shapes> shapes_at(const std::vector<Force>& forces, const PerParticle3& x,
                                        const Work& work);
std::shared_ptr<const DampingOperator> damping_at(const std::vector<Force>& forces, const State& s,
                                                  Work& work);
Forces forces_at(const std::vector<Force>& forces, const State& s, Work& work);
PerParticle3 elastic_forces(const std::vector<Force>& forces, const State& s, Work& work);

/// Number of times that a run that keeps values has computed them.
struct ForceCounts {
  long shapes = 0, elastic = 0, damping = 0;
};
ForceCounts computed_in_run(const std::vector<Force>& forces, const Work& work);

/// The derivative of all elastic forces with respect to the positions at s: computed once, used
/// for every product.
ForceDifferential elastic_differential_at(const std::vector<Force>& forces, const State& s,
                                          Definiteness definiteness, Work& work);

/// The exact derivative with respect to the positions of all forces, including damping forces at
/// the velocities of s. Custom forces contribute their elastic part only.
ForceDifferential force_differential_at(const std::vector<Force>& forces, const State& s,
                                        Work& work);

enum class StickingPart { all, without_springs };

/// Upper bounds on the row sums of the forces' stiffness matrix at s, for each particle [N/m].
PerParticle stiffness_row_bounds(const std::vector<Force>& forces, const State& s,
                                 StickingPart part, const Work& work = {});

/// An upper bound on the largest elastic angular frequency [rad/s] at s, from springs, hinges and
/// sticking bonds:
///   omega^2 <= max over particles i of (1/m_i) (sum over the stiffness matrices' rows at i)
/// the maximum row sum, by Gershgorin after scaling with the masses. inverse_mass: N [1/kg], 0 for
/// prescribed particles.
double frequency_bound(const std::vector<Force>& forces, const State& s,
                       const PerParticle& inverse_mass, const Work& work = {});

/// The same without the springs of sticking, which scheme C integrates stably thanks to their
/// forecast: forces/sticking.h.
double frequency_without_sticking_springs(const std::vector<Force>& forces, const State& s,
                                          const PerParticle& inverse_mass, const Work& work = {});

/// An upper bound on the largest damping rate [1/s], the largest eigenvalue of -M^{-1} D, by
/// the same row sums.
double damping_rate_bound(const DampingOperator& damping, const PerParticle& inverse_mass);

}  // namespace foldproof
