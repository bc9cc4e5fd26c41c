// Whether a run has the mesh and the objects that its case file was written for.
#pragma once

#include <string>

#include "reference/scene/scene.h"

namespace foldproof {

/// Where an override has put another mesh, shape or animation, of the cloth or of an object, in the
/// place of the case file's: "written for skirt.obj; this run uses YOURS.obj". "" where none has,
/// or where both are one file.
std::string replaced_shape(const CaseKeys& of);

}  // namespace foldproof
