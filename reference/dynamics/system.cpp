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

void set_team(System& system, const Team& team) {
  system.team = team;
  const auto set = [&](auto& part) {
    if constexpr (requires { part.set_team(team, system.mass.size()); })
      part.set_team(team, system.mass.size());
  };
  for (Force& force : system.forces) std::visit(set, force);
  for (Filter& filter : system.filters) std::visit(set, filter);
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

double elastic_limit(const System& system, const State& s, const Work& work) {
  return 2 / frequency_bound(system.forces, s, system.inverse_mass, work);
}

double widened_limit(const System& system, const State& s, double limit, const Work& work) {
  double forecast = std::numeric_limits<double>::infinity();
  for (const Force& force : system.forces)
    if (const auto* sticking = std::get_if<Sticking>(&force))
      forecast = std::min(forecast, sticking->shortest_forecast(s));
  if (std::isinf(forecast)) return limit;
  const double others =
      2 / frequency_without_sticking_springs(system.forces, s, system.inverse_mass, work);
  return std::max(limit, std::min(others, 2 * forecast));
}

void begin_step(const System& system, State& s, const Work& work) {
  for (const Force& force : system.forces)
    if (const auto* sticking = std::get_if<Sticking>(&force)) sticking->update_bonds(s);
  for (const Filter& filter : system.filters)
    if (const auto* self = std::get_if<SelfCollision>(&filter)) self->look_ahead(s, work);
}

Energies energies(const System& system, const State& s, const Work& work) {
  Energies e;
  e.kinetic = 0.5 * s.v.colwise().squaredNorm().dot(system.mass.transpose());
  for_each_force(
      system.forces, s, *shapes_at(system.forces, s.x, work),
      [&](const auto& force, const auto&... at) { e.*force.energy_term += force.energy(at...); });
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
