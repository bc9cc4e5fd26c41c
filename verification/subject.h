// What is being verified: the reference, or another solver that offers the same operations.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "reference/scene/scene.h"
#include "reference/types.h"
#include "verification/verdict.h"

namespace foldproof {

/// A scene as a subject has made it ready: built once, then handed to the calls below.
struct PreparedScene {
  virtual ~PreparedScene() = default;
};

/// The operations that a check may ask for. An empty function: the subject does not offer it.
struct Subject {
  std::string name, version;

  /// Builds the scene; the integrator and the solver's settings are the scene's. Throws NotOffered
  /// for what it does not have.
  std::function<std::unique_ptr<PreparedScene>(const Scene&)> prepare;

  /// All elastic and external forces at s [N], 3 x N.
  std::function<PerParticle3(PreparedScene&, const State& s)> elastic_forces;

  /// The damping forces at the positions of s for the velocities v [N], 3 x N: D(x) v.
  std::function<PerParticle3(PreparedScene&, const State& s, const PerParticle3& v)> damping_forces;

  /// Elastic and potential energy [J].
  std::function<double(PreparedScene&, const State& s)> potential_energy;

  /// The velocities (3 x N [m/s]) that the scene's objects make of v, when v moves the cloth from
  /// s over the span.
  std::function<PerParticle3(PreparedScene&, const Span& span, const State& s,
                             const PerParticle3& v)>
      avoid_objects;

  /// The velocities (3 x N [m/s]) that the scene's strain limits make of v, which moves the cloth
  /// from s over the span.
  std::function<PerParticle3(PreparedScene&, const Span& span, const State& s,
                             const PerParticle3& v)>
      limit_strain;

  /// The same of what keeps cloth from itself: repulsion, impulses against crossings, impact zones.
  std::function<PerParticle3(PreparedScene&, const Span& span, const State& s,
                             const PerParticle3& v)>
      avoid_itself;

  /// One step of dt [s] from the latest of the states `past`, of which a method may use two; adds
  /// the work that it counted, if it counts.
  std::function<State(PreparedScene&, std::span<const State> past, double dt, Work& work)> step;
};

/// Throws NotOffered if the operation is empty.
template <class Operation>
const Operation& require_offered(const Operation& operation, const char* name) {
  if (!operation) throw NotOffered{name};
  return operation;
}

}  // namespace foldproof
