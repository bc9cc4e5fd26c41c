// Particles or triangles selected by a table of a case: by number, box or sphere.
#pragma once

#include <string>
#include <vector>

#include "reference/scene/key_file.h"

namespace foldproof {

/// Each takes the positions x of the items (3 x N [m]), or their count N, and throws InputError
/// "file:line: ..." for a value out of its range.
///   select_in_box      box = [[x, y, z], [x, y, z]]
///   select_in_sphere   sphere = { center, radius }
std::vector<int> select_in_box(const KeyTable& keys, const PerParticle3& x);
std::vector<int> select_in_sphere(const KeyTable& keys, const PerParticle3& x);

/// The list under the key "particles" or "triangles".
std::vector<int> numbered(const KeyTable& keys, const std::string& key, Eigen::Index count);

/// The particles, and behind them the copies of each that are not among
/// them. copy_of: of the scene.
std::vector<int> with_copies(std::vector<int> particles, const std::vector<int>& copy_of);

}  // namespace foldproof
