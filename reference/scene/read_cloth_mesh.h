// The cloth of a case: its mesh, made or read, placed in the world.
#pragma once

#include <string>
#include <vector>

#include "reference/mesh/mesh_file.h"
#include "reference/mesh/seams.h"
#include "reference/mesh/triangle_mesh.h"
#include "reference/scene/key_file.h"
#include "reference/scene/scene_limits.h"

namespace foldproof {

struct PlacedMesh {
  TriangleMesh mesh;              // with the rest shape
  PerParticle3 start;             // 3 x N [m]
  std::vector<int> copy_of = {};  // as Scene::copy_of
  UnsewnMesh unsewn = {};         // as Scene::unsewn
  double scale = 1;               // by 'fit' or 'scale'
  FaceGroups groups = {};         // of the mesh file, with all copies
};

/// Reads the keys of [cloth] for shape and place. folder: base of relative paths in the case.
PlacedMesh read_cloth_mesh(const KeyTable& cloth, const std::string& folder,
                           const SceneLimits& limits);

/// Path of the OBJ file named by the key 'mesh'. table: its name in messages, "cloth" or "object".
std::string mesh_file(const KeyTable& keys, const std::string& folder, const std::string& table);

/// The factor by which 'fit' scales the positions x (3 x N [m]); 1 if it is not given.
double fit_factor(const KeyTable& keys, const PerParticle3& x);

/// Scales the positions x (3 x N [m]) so that their largest extent is 'fit', if that is given.
/// Returns the factor.
double scale_to_fit(const KeyTable& keys, PerParticle3& x);

}  // namespace foldproof
