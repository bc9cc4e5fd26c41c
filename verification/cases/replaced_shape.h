// Whether a run has the mesh and the objects that its case file was written for.
#pragma once

#include <string>

#include "reference/scene/scene.h"

namespace foldproof {

/// Describes an override that replaces the mesh, shape or animation of the cloth or of an object in
/// the case file: "written for skirt.obj; this run uses YOURS.obj". "" if there is none, or if both
/// are the same file.
std::string replaced_shape(const CaseKeys& of);

}  // namespace foldproof
