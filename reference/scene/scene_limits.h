// Upper limits on the size of a case, so that no number in a file can exhaust the
// memory of a machine.
#pragma once

#include <string>

#include "reference/scene/key_file.h"

namespace foldproof {

struct SceneLimits {
  double triangles = 1e7;  // of the cloth with its copies, or of a body, made by code: about 4 GB
  double frames = 1000;    // of a deforming body: each is a level set
};

/// Throws InputError "file:line: ..." where the key asks for more triangles than the limit.
void reject_many_triangles(const KeyTable& keys, const std::string& key, double triangles,
                           const SceneLimits& limits);

}  // namespace foldproof
