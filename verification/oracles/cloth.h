#pragma once

#include <array>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "reference/types.h"
#include "verification/oracles/definitions.h"
#include "verification/oracles/ode.h"

// A whole sheet as an ordinary differential equation, M x'' = F(t, x, x'), with the forces of
// definitions.h in double precision, for a general ODE solver. Particles are numbered from 0.

namespace foldproof::oracles {

/// One edge of the sheet.
struct SpringDefinition {
  int a = 0, b = 0;        // its two particles
  double rest_length = 0;  // L0 [m], > 0
  double area = 0;         // A_e, rest areas of its one or two triangles [m^2], > 0
};

/// One edge between two triangles.
struct HingeDefinition {
  std::array<int, 4> corners{};  // x1..x4 as in definitions.h
  double rest_angle = 0;         // theta0 [rad]
  double rest_anisotropy = 0;    // |E|^2/(|N1| + |N2|) at rest [1], > 0
  double rest_edge_length = 0;   // |E| at rest [m], > 0
};

/// Material of the sheet.
struct ClothMaterial {
  double young = 0;              // Y [N/m]
  double spring_damping = 0;     // kd_s [N s/m]
  double bending_stiffness = 0;  // ke [J]
  double bending_damping = 0;    // kd [N s], or [J s] with DampingFactor::anisotropy
  Geometry elastic_geometry = Geometry::rest;
  Geometry damping_geometry = Geometry::current;
  DampingFactor damping_factor = DampingFactor::edge_length;
};

/// A prescribed motion: position [m] and velocity [m/s] at any time [s], the second being the
/// derivative of the first. A lambda written for it must return a Vector3; an Eigen expression
/// would refer to dead operands.
struct Motion {
  std::function<Vector3(double t)> x, v;
};

/// x(t) = centre + amplitude sin(2 pi frequency t + phase).
struct Harmonic {
  Vector3 centre, amplitude;  // [m]
  double frequency = 0;       // [Hz]
  double phase = 0;           // [rad]
};

struct ClothDefinition {
  std::vector<double> masses;  // N, [kg], > 0
  std::vector<SpringDefinition> springs;
  std::vector<HingeDefinition> hinges;
  ClothMaterial material;
  Vector3 gravity = Vector3::Zero();  // [m/s^2]
  std::map<int, Motion> prescribed;   // particles that ignore the forces
  // [N] on free particles, as a Vector3 (see Motion); empty: none
  std::function<Vector3(int particle, double t)> external_force;
};

/// Positions 3 x N [m] and velocities 3 x N [m/s] of all particles, free and prescribed.
struct ClothState {
  PerParticle3 x, v;
};

Motion harmonic_motion(const Harmonic& harmonic);

/// A hinge with its two factors computed from the rest positions 3 x N [m].
HingeDefinition hinge_at_rest(const std::array<int, 4>& corners, const PerParticle3& rest,
                              double rest_angle);

/// The right-hand side for y = (positions of the free particles in ascending order, then their
/// velocities); 6 numbers per free particle. It keeps a copy of the definition; several threads may
/// call it.
RightHandSide cloth_rhs(const ClothDefinition& cloth);

/// y of a state: prescribed particles are left out.
std::vector<double> free_coordinates(const ClothDefinition& cloth, const ClothState& state);

/// The state of a y at time t [s]; prescribed particles are at their prescribed positions.
ClothState cloth_state(const ClothDefinition& cloth, double t, std::span<const double> y);

}  // namespace foldproof::oracles
