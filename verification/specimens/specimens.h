// Test cloth for forces: crumpled sheets of every pattern, hinges of any shape and angle, shapes
// that are curved at rest.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "reference/scene/scene.h"
#include "verification/oracles/definitions.h"
#include "verification/specimens/random.h"

namespace foldproof {

/// A scene and one of its states. The scene names no force; add the one under test. It has rest
/// angles, one per hinge.
struct Specimen {
  std::string name;
  Scene scene;
  State state;
};

/// x1, x2, x3, x4 of a hinge [m].
using Corners = std::array<Vector3, 4>;

/// Adds hinges that are flat at rest, damped with the factor |E|: ke [J], kd [N s].
void add_flat_hinges(Scene& scene, double stiffness, double damping);

/// The particles that the scene does not prescribe, ascending.
std::vector<int> free_particles(const Scene& scene);

/// Sheets of six patterns, a disc and a sphere, about 80 triangles each. Random are displacements
/// (normal and in-plane, up to 0.35 and 0.2 of an edge), velocities (up to 1.5 m/s) and rest angles
/// (up to 0.9 rad).
std::vector<Specimen> crumpled_sheets();

/// Three of them, small enough for dense matrices: an even pattern, an irregular one, a
/// closed surface.
std::vector<Specimen> small_crumpled_sheets();

/// Shapes that are curved at rest, in their rest shape, with its angles as rest angles: a statue, a
/// sphere, a cylinder, pleats.
std::vector<Specimen> curved_shapes();

/// The seated statue of 1280 triangles, .37 m high; computed once.
const TriangleMesh& small_statue();

/// Two triangles of random shape (heights .4 to 1.5 of the edge, feet up to .4 of it beyond its
/// ends), place and orientation, folded by `angle` [rad] to rounding.
Corners random_corners(Random& random, double angle);

/// A random hinge at `angle` [rad] with random velocities; its rest shape is another random hinge,
/// with a random rest angle.
Specimen random_hinge(unsigned seed, double angle);

/// Random hinges at angles all around the circle [rad]: flat, slight, right, obtuse,
/// sharp, of both signs.
std::vector<Specimen> hinges_of_all_angles();

/// All crumpled sheets, then the random hinges.
std::vector<Specimen> sheets_and_hinges();

/// A scene of one hinge: particles 0, 1, 2, 3 are its x1, x2, x3, x4.
Scene hinge_scene(const Corners& rest, double rest_angle);

State state_of(const Corners& x);

/// The positions x (3 x N [m]) without motion.
State resting_state(PerParticle3 x);

Corners corners_of(const Hinge& hinge, const PerParticle3& x);

/// Oracle input for one hinge of a specimen, with the constants of its scene's bending.
oracles::HingeInput hinge_input(const Specimen& specimen, size_t hinge);

/// Longest side squared over twice the area, of the worse of the two triangles [1]: the
/// amplification of rounding errors in the normals. 1.15 for equilateral triangles.
double aspect_ratio(const Corners& x);

/// Bending with rest and with current weighting by each law; constants pairwise distinct.
std::vector<BendingMaterial> bending_variants();

/// Damped bending with each of the two factors; constants distinct.
std::vector<BendingMaterial> damped_bending_variants();

/// "jittered, current, cubic": a specimen and its material.
std::string describe(const Specimen& specimen, const BendingMaterial& material);

}  // namespace foldproof
