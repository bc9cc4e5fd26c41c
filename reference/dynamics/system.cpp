#include "reference/dynamics/system.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace foldproof {

System make_system(PerParticle mass) {
  System system;
  for (Eigen::Index i = 0; i < mass.size(); ++i)
    if (!(mass[i] > 0) || !std::isfinite(mass[i]))
      throw InputError("particle " + std::to_string(i) + " has mass " + std::to_string(mass[i]) +
                       " kg; it must be > 0");
  system.inverse_mass = mass.cwiseInverse();
  system.mass = std::move(mass);
  return system;
}

void use_threads(System& system, int threads) {
  if (threads < 1) throw InputError("a system needs at least one thread");
  system.solver.threads = threads;
  const auto use = [&](auto& part) {
    if constexpr (requires { part.use_threads(threads, system.mass.size()); })
      part.use_threads(threads, system.mass.size());
  };
  for (Force& force : system.forces) std::visit(use, force);
  for (Filter& filter : system.filters) std::visit(use, filter);
}

void prescribe(System& system, const PrescribedParticle& particle) {
  const int i = particle.particle;
  if (!(i >= 0 && i < system.mass.size()))
    throw InputError("cannot prescribe the motion of particle " + std::to_string(i) +
                     ": there are " + std::to_string(system.mass.size()));
  if (system.inverse_mass[i] == 0)
    throw InputError("the motion of particle " + std::to_string(i) + " is prescribed twice");
  system.inverse_mass[i] = 0;
  system.prescribed.push_back(particle);
}

double elastic_limit(const System& system, const State& s) {
  return 2 / frequency_bound(system.forces, s, system.inverse_mass);
}

double widened_limit(const System& system, const State& s, double limit) {
  double forecast = std::numeric_limits<double>::infinity();
  for_each_force(system.forces, [&](const auto& force) {
    if constexpr (requires { force.shortest_forecast(s); })
      forecast = std::min(forecast, force.shortest_forecast(s));
  });
  if (std::isinf(forecast)) return limit;
  const double others =
      2 / frequency_without_sticking_springs(system.forces, s, system.inverse_mass);
  return std::max(limit, std::min(others, 2 * forecast));
}

void begin_step(const System& system, State& s) {
  for_each_force(system.forces, [&](const auto& force) {
    if constexpr (requires { force.update_bonds(s); }) force.update_bonds(s);
  });
  for (const Filter& filter : system.filters)
    if (const auto* self = std::get_if<SelfCollision>(&filter)) self->update_pair_cache(s);
}

Energies energies(const System& system, const State& s) {
  Energies e;
  e.kinetic = 0.5 * s.v.colwise().squaredNorm().dot(system.mass.transpose());
  for_each_force(system.forces,
                 [&](const auto& force) { e.*force.energy_term += force.energy(s); });
  return e;
}

Vector3 linear_momentum(const System& system, const State& s) { return s.v * system.mass; }

Vector3 angular_momentum(const System& system, const State& s) {
  Vector3 sum = Vector3::Zero();
  for (Eigen::Index i = 0; i < s.x.cols(); ++i) {
    const Vector3 x = s.x.col(i), v = s.v.col(i);
    sum += system.mass[i] * x.cross(v);
  }
  return sum;
}

}  // namespace foldproof
