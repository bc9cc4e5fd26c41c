// Checks of case files. One function per file; the list of all is verification/checks.cpp.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> scene_rejection_checks();  // invalid case files
std::vector<Check> scene_meaning_checks();    // what is built from a case file (scene_checks.cpp)
std::vector<Check> scene_place_checks();      // where the cloth is, how it starts and is held
std::vector<Check> scene_object_checks();     // objects and how cloth meets them
std::vector<Check> scene_body_checks();       // bodies of triangles, sampled and deforming
std::vector<Check> scene_cloth_checks();      // shapes, copies, folds, cloth meeting itself
std::vector<Check> sticking_scene_checks();   // sticking in case files

}  // namespace foldproof
