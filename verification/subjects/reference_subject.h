// The plain solver of reference/ as a subject.
#pragma once

#include "verification/subject.h"

namespace foldproof {

/// It offers every operation.
Subject reference_subject();

}  // namespace foldproof
