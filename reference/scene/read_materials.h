// Reads the materials of the sheet: the tables [stretch], [bending], [membrane], [air] of a case,
// and those of its fabrics.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reference/beyond/air.h"
#include "reference/beyond/directions.h"
#include "reference/beyond/membrane.h"
#include "reference/forces/bending.h"
#include "reference/forces/springs.h"
#include "reference/scene/fabrics.h"
#include "reference/scene/key_file.h"

namespace foldproof {

/// A material, and how its stiffness depends on the direction.
template <class Material>
struct Directed {
  Material material = {};
  ByDirection directions = {};
};

/// Each throws InputError "file:line: ..." for a value out of its range, and for warp and weft that
/// the mesh cannot have.
///   base    of a fabric's table: what it leaves out is as there; null for the case's own
///   notes   gets a sentence on warp and weft
Directed<StretchMaterial> read_stretch(const KeyTable& keys, const TriangleMesh& mesh,
                                       const Directed<StretchMaterial>* base,
                                       std::vector<std::string>& notes);

/// fabric: measured, whose rigidity is used if the keys give none.
Directed<BendingMaterial> read_bending(const KeyTable& keys, const TriangleMesh& mesh,
                                       const Directed<BendingMaterial>* base,
                                       const std::optional<Fabric>& fabric,
                                       std::vector<std::string>& notes);

MembraneMaterial read_membrane(const KeyTable& keys, const MembraneMaterial* base);

Air read_air(const KeyTable& keys);

}  // namespace foldproof
