// The studies of this room: questions about any case, asked of scenes of the suite.
#pragma once

#include "convergence/study.h"

namespace foldproof {

// price-by-scene: what the paper's scheme C costs beside the cheapest method, by kind of scene
Study price_by_scene_study();

}  // namespace foldproof
