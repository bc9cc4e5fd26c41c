// The solver under test: the reference, or another solver that offers the same operations.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "reference/scene/scene.h"
#include "reference/types.h"
#include "verification/verdict.h"

namespace foldproof {

/// A scene prepared by a subject: built once, then passed to the calls below.
struct PreparedScene {
  virtual ~PreparedScene() = default;
};

/// The operations that a check may use. An empty function means that the subject does not offer it.
struct Subject {
  std::string name, version;

  /// Builds the scene, with the scene's integrator and solver settings. Throws NotOffered for parts
  /// that the subject does not support.
  std::function<std::unique_ptr<PreparedScene>(const Scene&)> prepare;

  /// All elastic and external forces at s [N], 3 x N.
  std::function<PerParticle3(PreparedScene&, const State& s)> elastic_forces;

  /// The damping forces at the positions of s for the velocities v [N], 3 x N: D(x) v.
  std::function<PerParticle3(PreparedScene&, const State& s, const PerParticle3& v)> damping_forces;

  /// Elastic and potential energy [J].
  std::function<double(PreparedScene&, const State& s)> potential_energy;

  /// The velocities v (3 x N [m/s]), which move the cloth from s over the span, as corrected by the
  /// scene's objects.
  std::function<PerParticle3(PreparedScene&, const Span& span, const State& s,
                             const PerParticle3& v)>
      avoid_objects;

  /// The velocities v (3 x N [m/s]), which move the cloth from s over the span, as corrected by the
  /// scene's strain limits.
  std::function<PerParticle3(PreparedScene&, const Span& span, const State& s,
                             const PerParticle3& v)>
      limit_strain;

  /// The same for self-collision: repulsion, impulses against crossings, impact zones.
  std::function<PerParticle3(PreparedScene&, const Span& span, const State& s,
                             const PerParticle3& v)>
      avoid_itself;

  /// One step of dt [s] from the latest of the states `past`; a method may use two of them. Adds
  /// the counted work, if any is counted.
  std::function<State(PreparedScene&, std::span<const State> past, double dt, Work& work)> step;
};

/// Throws NotOffered if the operation is empty.
template <class Operation>
const Operation& require_offered(const Operation& operation, const char* name) {
  if (!operation) throw NotOffered{name};
  return operation;
}

}  // namespace foldproof
