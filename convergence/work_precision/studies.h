// The studies of this room: which method reaches an error at the least work?
#pragma once

#include "convergence/study.h"

namespace foldproof {

Study work_precision_study();  // work-precision: error against work and seconds, all methods
Study long_contact_study();    // long-contact: steps that last, and their work, with contact
Study mesh_error_study();      // mesh-error: error of the mesh beside that of the step

}  // namespace foldproof
