// Several fabrics in one cloth: each triangle is of one of them.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "reference/beyond/directions.h"
#include "reference/beyond/membrane.h"
#include "reference/filters/repulsion.h"
#include "reference/filters/strain_limit.h"
#include "reference/forces/bending.h"
#include "reference/forces/springs.h"
#include "reference/mesh/mesh_file.h"
#include "reference/scene/key_file.h"

namespace foldproof {

struct Scene;

/// What a fabric sets; of a part that the scene does not have, the values are not used.
struct ClothFabric {
  std::string name;
  double density = 0;  // kg/m^2
  StretchMaterial stretch = {};
  BendingMaterial bending = {};
  MembraneMaterial membrane = {};
  ByDirection stretch_directions = {}, bending_directions = {};
  StrainRange limits = {};
  // Coulomb's coefficient against objects [1]; NaN: the objects' own
  double friction = std::numeric_limits<double>::quiet_NaN();
  // of self-collision [m], [1]; NaN: as in the scene's settings
  double thickness = std::numeric_limits<double>::quiet_NaN(), layer_friction = thickness;
};

/// The fabrics of a cloth; the first stands for that of [cloth] and of the tables of the forces and
/// filters, whose values are the scene's (fabrics_of). Empty: it is the only one.
struct ClothFabrics {
  std::vector<ClothFabric> fabrics = {};
  std::vector<int> of_triangle = {};  // M, places in the list

  bool empty() const { return fabrics.empty(); }
};

/// Reads the tables [[fabric]] of a case and gives the scene its fabrics. A triangle that several
/// tables name is of the last one. groups: of the mesh's file. Throws InputError "file:line: ..."
/// for an unknown group, a table that names no triangle or more than one way to choose them, and a
/// value out of its range.
void read_cloth_fabrics(const KeyTable& keys, const std::string& folder, const FaceGroups& groups,
                        Scene& scene);

/// The fabrics with the scene's own values for the first; at least that one.
std::vector<ClothFabric> fabrics_of(const Scene& scene);

/// Area density of each triangle of the scene; M values [kg/m^2].
std::vector<double> densities_of(const Scene& scene);

/// The masses of the scene's particles; N values [kg].
PerParticle masses_of(const Scene& scene);

/// The springs of the scene. Each triangle brings A/L0^2 of its own fabric, and its own side's
/// length in a pattern, to its three edges, times the factor of that side's direction; where two
/// fabrics or panels meet, the edge's spring is the two side by side.
StretchSprings springs_of(const Scene& scene);

/// The bending of the scene, one force for all hinges of the same fabrics. A hinge between two
/// fabrics has half of each, one behind the other: its compliance 1/ke and its damping are means
/// of theirs. The factor of its direction multiplies its weight: the mean of both sides'.
std::vector<Bending> bending_of(const Scene& scene);

CustomForce membrane_of(const Scene& scene);

/// The range of each spring: between two fabrics the narrower. Empty: that of [strain_limits].
std::vector<StrainRange> strain_ranges_of(const Scene& scene);

/// The largest extension that strain limits allow to some spring [1].
double largest_extension_of(const Scene& scene);

/// Coulomb's coefficient of each particle against objects: the mean over its triangles' areas of
/// the fabrics that have one; N values, NaN where none has [1]. Empty: the objects' everywhere.
PerParticle friction_of(const Scene& scene);

/// Of each particle: means over its triangles' areas. Empty without fabrics.
LayerProperties layers_of(const Scene& scene);

}  // namespace foldproof
