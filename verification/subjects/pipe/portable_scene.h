// A scene that any cloth solver can be given: plain arrays and physical constants.
#pragma once

#include <string>
#include <vector>

#include "reference/mesh/triangle_mesh.h"
#include "reference/types.h"

namespace foldproof {

/// The constants of the sheet, from which an adapter takes what its engine needs.
struct PortableMaterial {
  double density = 0.2;          // area density [kg/m^2]
  double young = 50;             // Y, 2D Young's modulus [N/m]
  double bending_rigidity = 0;   // B [N m]
  double stretch_damping = 0;    // of the springs: force per rate of strain [N s/m]
  double bending_damping = 0;    // [N s]
  double rest_length_scale = 1;  // rest lengths over those of the rest shape [1]
};

/// A fixed plane; the solid is on the side that the normal points away from.
struct PortablePlane {
  Vector3 point, normal;  // [m]; of length 1
  double friction = 0;    // mu, Coulomb's [1]
};

/// A fixed box, its edges along the axes.
struct PortableBox {
  Vector3 centre, half_extents;  // m
  double friction = 0;           // mu, Coulomb's [1]
};

/// A fixed ball.
struct PortableSphere {
  Vector3 centre;       // m
  double radius;        // m
  double friction = 0;  // mu, Coulomb's [1]
};

/// Fixed: all points within `radius` of the segment from a to b.
struct PortableCapsule {
  Vector3 a, b;         // m
  double radius;        // m
  double friction = 0;  // mu, Coulomb's [1]
};

struct PortableScene {
  std::string name;
  TriangleMesh mesh;                  // with the rest shape
  PerParticle3 x, v;                  // start, 3 x N [m], [m/s]
  PerParticle mass;                   // N [kg]
  std::vector<int> held = {};         // particles at rest where they start
  Vector3 gravity = Vector3::Zero();  // m/s^2
  PortableMaterial material = {};
  std::vector<double> rest_angles = {};  // one a hinge [rad]; empty: all flat
  double dt = 0;                         // s
  // obstacles, each for solvers of the capability of that name
  std::vector<PortablePlane> planes = {};
  std::vector<PortableBox> boxes = {};
  std::vector<PortableSphere> spheres = {};
  std::vector<PortableCapsule> capsules = {};
  double thickness = 0;        // of the cloth against itself [m]; for capability "self_collision"
  bool own_masses = false;     // masses are other than the density's
  std::string extension = {};  // JSON for solvers that know it; "" for none
};

/// Stiffness of the spring along each edge, Y A_e/L0^2 of the rest shape [N/m]; E values.
Eigen::VectorXd edge_stiffness(const PortableScene& scene);

}  // namespace foldproof
