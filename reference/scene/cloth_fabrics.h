// Several fabrics in one cloth: each triangle is of one of them.
#pragma once

#include <string>
#include <vector>

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
  StretchMaterial stretch;
  BendingMaterial bending;
};

/// The fabrics of a cloth; the first is that of [cloth], [stretch] and [bending]. Empty: it is the
/// only one.
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

/// Area density of each triangle of the scene; M values [kg/m^2].
std::vector<double> densities_of(const Scene& scene);

/// The masses of the scene's particles; N values [kg].
PerParticle masses_of(const Scene& scene);

/// The springs of the scene. Each triangle brings A/L0^2 of its own fabric, and its own side's
/// length in a pattern, to its three edges; where two fabrics or panels meet, the edge's spring is
/// the two side by side.
StretchSprings springs_of(const Scene& scene);

/// The bending of the scene, one force for all hinges of the same fabrics. A hinge between two
/// fabrics has half of each, one behind the other: its compliance 1/ke and its damping are means
/// of theirs.
std::vector<Bending> bending_of(const Scene& scene);

}  // namespace foldproof
