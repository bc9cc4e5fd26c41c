// A scene that any cloth solver can be given: plain arrays and physical constants.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "reference/mesh/triangle_mesh.h"
#include "reference/motion/pose.h"
#include "reference/types.h"

namespace foldproof {

/// Stretch and shear of triangles that are stiffer along the warp, as in
/// reference/beyond/membrane.h; for capability "membrane".
struct PortableMembrane {
  double warp, weft, shear;  // E1, E2, G [N/m]
  double poisson;            // nu12 [1]
  double damping = 0;        // stress of a strain rate over stress of a strain [s]
};

/// The constants of the sheet, from which an adapter takes what its engine needs.
struct PortableMaterial {
  double density = 0.2;          // area density [kg/m^2]
  double young = 50;             // Y, 2D Young's modulus [N/m]
  double bending_rigidity = 0;   // B [N m]
  double stretch_damping = 0;    // of the springs: force per rate of strain [N s/m]
  double bending_damping = 0;    // [N s]
  double rest_length_scale = 1;  // rest lengths over those of the rest shape [1]
  // mu against obstacles in place of theirs, for capability "material_friction"; none: theirs [1]
  std::optional<double> friction = {};
  std::optional<PortableMembrane> membrane = {};  // beside the springs, if any
};

/// An obstacle moves from where it is described to R X + T of its poses; without keys it stands
/// still there. Keys need capability "moving_obstacles".
using PortableMotion = Keyframes;

/// A plane; the solid is on the side that the normal points away from.
struct PortablePlane {
  Vector3 point, normal;       // [m]; of length 1
  double friction = 0;         // mu, Coulomb's [1]
  PortableMotion motion = {};  // none: fixed
};

/// A box, its edges along the axes before its motion.
struct PortableBox {
  Vector3 centre, half_extents;  // m
  double friction = 0;           // mu, Coulomb's [1]
  PortableMotion motion = {};
};

struct PortableSphere {
  Vector3 centre;       // m
  double radius;        // m
  double friction = 0;  // mu, Coulomb's [1]
  PortableMotion motion = {};
};

/// All points within `radius` of the segment from a to b.
struct PortableCapsule {
  Vector3 a, b;         // m
  double radius;        // m
  double friction = 0;  // mu, Coulomb's [1]
  PortableMotion motion = {};
};

/// The inside of a closed mesh; for capability "bodies".
struct PortableBody {
  PerParticle3 vertices;            // 3 x V [m]
  std::vector<Triangle> triangles;  // outward
  double friction = 0;              // mu, Coulomb's [1]
  PortableMotion motion = {};
  // instead of a motion, for capability "deforming_bodies": places of the vertices at these times
  std::vector<double> times = {};         // T, rising [s]
  std::vector<PerParticle3> frames = {};  // T of 3 x V [m]
};

/// Where held particles are at these times, and between two of them on a straight line; they rest
/// before the first and after the last. For capability "moving_held".
struct PortablePath {
  std::vector<double> times = {};    // T, ascending [s]; empty: they stay
  std::vector<PerParticle3> x = {};  // T of 3 x H [m]
};

/// Lengths of springs stay within 1 - compression and 1 + extension of those at rest [1].
struct PortableLimits {
  double extension, compression;
};

/// As in reference/beyond/air.h.
struct PortableAir {
  double density;                       // kg/m^3
  Vector3 wind;                         // m/s
  double normal_drag, tangential_drag;  // 1
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
  std::vector<PortableBody> bodies = {};
  double thickness = 0;  // of the cloth against itself [m]; for capability "self_collision"
  // of layers on layers; for capability "layer_friction" where it is not 0 [1]
  double layer_friction = 0;
  // protocol 2, each for solvers of the capability of that name
  PortablePath moving_held = {};
  std::optional<PortableLimits> strain_limits = {};
  std::optional<PortableAir> air = {};
  // several instead of `material`, which is the first; of each triangle its place in the list
  std::vector<PortableMaterial> materials = {};
  std::vector<int> material_of_triangle = {};
  std::vector<Vector3> warp = {};  // M, of length 1, in the rest triangle; with a membrane
  bool own_masses = false;         // masses are other than the density's
  std::string extension = {};      // JSON for solvers that know it; "" for none
};

/// The elements' own numbers, by the materials of their triangles. Where two meet, an edge has
/// their springs side by side, and a hinge half of each, one behind the other.
struct PortableElements {
  Eigen::VectorXd edge_stiffness;  // E: Y A_e/L0^2 of the rest shape [N/m]
  Eigen::VectorXd edge_damping;    // E, along the edge [N s/m]
  Eigen::VectorXd hinge_rigidity;  // K [N m]
  Eigen::VectorXd hinge_damping;   // K [N s]
};

PortableElements elements_of(const PortableScene& scene);

/// Stiffness of the spring along each edge [N/m]; E values.
inline Eigen::VectorXd edge_stiffness(const PortableScene& scene) {
  return elements_of(scene).edge_stiffness;
}

/// The names of the capabilities that a solver needs for this scene.
std::vector<std::string> needed_by(const PortableScene& scene);

}  // namespace foldproof
