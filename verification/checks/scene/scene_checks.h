#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> scene_refusal_checks();  // scene_refusal_checks.cpp: what a case file may not say
std::vector<Check> scene_meaning_checks();  // scene_checks.cpp: what is built of what it says
std::vector<Check>
scene_place_checks();  // scene_place_checks.cpp: where the cloth is, how it starts and is held
std::vector<Check> scene_object_checks();  // scene_object_checks.cpp: objects and how cloth meets them
std::vector<Check> scene_body_checks();  // scene_body_checks.cpp: bodies of triangles, sampled and deforming
std::vector<Check>
scene_cloth_checks();              // scene_cloth_checks.cpp: shapes, copies, folds, cloth meeting itself
std::vector<Check> seam_checks();  // seam_checks.cpp: panels that are sewn together

/// All of the above.
std::vector<Check> scene_checks();

}  // namespace foldproof
