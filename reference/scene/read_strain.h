// The strain limits of a case: [strain_limits].
#pragma once

#include "reference/scene/key_file.h"
#include "reference/scene/scene.h"

namespace foldproof {

/// Reads the keys that are there into a range.
void read_strain_range(const KeyTable& keys, StrainRange& range);

/// Reads the table, if the case has one, into the scene; needs its springs.
void read_strain_limits(const KeyTable& keys, Scene& scene);

}  // namespace foldproof
