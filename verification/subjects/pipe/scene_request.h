// A scene as a message of the protocol: its object `scene`, and its arrays.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "verification/subjects/pipe/message.h"
#include "verification/subjects/pipe/portable_scene.h"

namespace foldproof {

using Settings = std::vector<std::pair<std::string, std::string>>;  // typed, for the solver

/// Adds the scene to a request.
void add_scene(const PortableScene& scene, const Settings& typed, Request& request);

}  // namespace foldproof
