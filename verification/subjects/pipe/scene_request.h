// A scene as a message of the protocol: its object `scene`, and its arrays.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "verification/subjects/pipe/message.h"
#include "verification/subjects/pipe/portable_scene.h"

namespace foldproof {

/// What a user sets, for the solver: its own settings as typed, and values of its tunables.
struct Settings {
  std::vector<std::pair<std::string, std::string>> typed;
  std::map<std::string, double> tunables = {};
};

/// Adds the scene to a request.
void add_scene(const PortableScene& scene, const Settings& set, Request& request);

}  // namespace foldproof
