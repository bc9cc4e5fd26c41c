#include "verification/oracles/cloth.h"

#include <cmath>

namespace foldproof::oracles {

namespace {

using Vectors = std::vector<Triple<double>>;  // one per particle

std::size_t index(int particle) { return static_cast<std::size_t>(particle); }

Triple<double> triple(const Vector3& p) { return {p.x(), p.y(), p.z()}; }

std::vector<int> free_particles(const ClothDefinition& cloth) {
  std::vector<int> particles;
  for (int i = 0; i < static_cast<int>(cloth.masses.size()); ++i) {
    if (!cloth.prescribed.contains(i)) particles.push_back(i);
  }
  return particles;
}

Quad<double> gather(const Vectors& p, const std::array<int, 4>& corners) {
  return {p[index(corners[0])], p[index(corners[1])], p[index(corners[2])], p[index(corners[3])]};
}

SpringLaw<double> law(const ClothMaterial& material, const SpringDefinition& spring) {
  return {material.young, material.spring_damping, spring.area, spring.rest_length};
}

void add_spring_forces(const ClothDefinition& cloth, const Vectors& x, const Vectors& v,
                       Vectors& f) {
  for (const SpringDefinition& spring : cloth.springs) {
    const std::size_t a = index(spring.a), b = index(spring.b);
    const SpringLaw<double> spring_law = law(cloth.material, spring);
    const Triple<double> on_a = spring_elastic_force(x[a], x[b], spring_law) +
                                spring_damping_force(x[a], x[b], v[b] - v[a], spring_law);
    f[a] = f[a] + on_a;
    f[b] = f[b] - on_a;
  }
}

double damping_factor(const ClothMaterial& material, const HingeDefinition& hinge,
                      const Quad<double>& x) {
  const bool at_rest = material.damping_geometry == Geometry::rest;
  if (material.damping_factor == DampingFactor::edge_length)
    return at_rest ? hinge.rest_edge_length : edge_length(x);
  return at_rest ? hinge.rest_anisotropy : anisotropy_factor(x);
}

// sin(theta/2) from the angle and not as printed, which is off by 1e-8 near flat in
// double precision.
void add_bending_forces(const ClothDefinition& cloth, const Vectors& x, const Vectors& v,
                        Vectors& f) {
  const ClothMaterial& material = cloth.material;
  for (const HingeDefinition& hinge : cloth.hinges) {
    const Quad<double> corners = gather(x, hinge.corners);
    const bool at_rest = material.elastic_geometry == Geometry::rest;
    const double anisotropy = at_rest ? hinge.rest_anisotropy : anisotropy_factor(corners);
    const double deflection = std::sin(hinge_angle(corners) / 2) - std::sin(hinge.rest_angle / 2);
    const Quad<double> elastic =
        bending_elastic_force(corners, material.bending_stiffness, anisotropy, deflection);
    const Quad<double> damping =
        bending_damping_force(corners, gather(v, hinge.corners), material.bending_damping,
                              damping_factor(material, hinge, corners));
    for (std::size_t i = 0; i < 4; ++i) {
      Triple<double>& force = f[index(hinge.corners[i])];
      force = force + elastic[i] + damping[i];
    }
  }
}

/// One call of the right-hand side: y and dydt as in cloth_rhs.
struct ClothEquation {
  ClothDefinition cloth;
  std::vector<int> particles;  // the free ones

  void operator()(double t, std::span<const double> y, std::span<double> dydt) const {
    const std::size_t half = 3 * particles.size();
    Vectors x(cloth.masses.size()), v(cloth.masses.size()), f(cloth.masses.size());
    for (const auto& [particle, motion] : cloth.prescribed) {
      x[index(particle)] = triple(motion.x(t));
      v[index(particle)] = triple(motion.v(t));
    }
    for (std::size_t i = 0; i < particles.size(); ++i) {
      x[index(particles[i])] = {y[3 * i], y[3 * i + 1], y[3 * i + 2]};
      v[index(particles[i])] = {y[half + 3 * i], y[half + 3 * i + 1], y[half + 3 * i + 2]};
    }

    add_spring_forces(cloth, x, v, f);
    add_bending_forces(cloth, x, v, f);
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const Triple<double> acceleration = acceleration_of(particles[i], t, f[index(particles[i])]);
      for (std::size_t k = 0; k < 3; ++k) dydt[3 * i + k] = y[half + 3 * i + k];
      dydt[half + 3 * i] = acceleration.x;
      dydt[half + 3 * i + 1] = acceleration.y;
      dydt[half + 3 * i + 2] = acceleration.z;
    }
  }

  Triple<double> acceleration_of(int particle, double t,
                                 const Triple<double>& internal_force) const {
    const double mass = cloth.masses[index(particle)];
    Triple<double> force = internal_force + gravity_force(mass, triple(cloth.gravity));
    if (cloth.external_force) force = force + triple(cloth.external_force(particle, t));
    return force / mass;
  }
};

}  // namespace

Motion harmonic_motion(const Harmonic& harmonic) {
  const double rate = 2 * pi * harmonic.frequency;
  return {
      [harmonic, rate](double t) {
        return Vector3(harmonic.centre + std::sin(rate * t + harmonic.phase) * harmonic.amplitude);
      },
      [harmonic, rate](double t) {
        return Vector3(rate * std::cos(rate * t + harmonic.phase) * harmonic.amplitude);
      }};
}

HingeDefinition hinge_at_rest(const std::array<int, 4>& corners, const PerParticle3& rest,
                              double rest_angle) {
  Quad<double> x;
  for (std::size_t i = 0; i < 4; ++i) x[i] = triple(rest.col(corners[i]));
  return {corners, rest_angle, anisotropy_factor(x), edge_length(x)};
}

RightHandSide cloth_rhs(const ClothDefinition& cloth) {
  return ClothEquation{cloth, free_particles(cloth)};
}

std::vector<double> free_coordinates(const ClothDefinition& cloth, const ClothState& state) {
  std::vector<double> y;
  for (const PerParticle3* columns : {&state.x, &state.v}) {
    for (const int particle : free_particles(cloth)) {
      for (int k = 0; k < 3; ++k) y.push_back((*columns)(k, particle));
    }
  }
  return y;
}

ClothState cloth_state(const ClothDefinition& cloth, double t, std::span<const double> y) {
  const std::vector<int> particles = free_particles(cloth);
  const std::size_t half = 3 * particles.size();
  const Eigen::Index count = static_cast<Eigen::Index>(cloth.masses.size());
  ClothState state{PerParticle3(3, count), PerParticle3(3, count)};
  for (const auto& [particle, motion] : cloth.prescribed) {
    state.x.col(particle) = motion.x(t);
    state.v.col(particle) = motion.v(t);
  }
  for (std::size_t i = 0; i < particles.size(); ++i) {
    state.x.col(particles[i]) = Vector3(y[3 * i], y[3 * i + 1], y[3 * i + 2]);
    state.v.col(particles[i]) = Vector3(y[half + 3 * i], y[half + 3 * i + 1], y[half + 3 * i + 2]);
  }
  return state;
}

}  // namespace foldproof::oracles
