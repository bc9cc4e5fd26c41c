#pragma once

#include "verification/verdict.h"

namespace foldproof {

/// Young's modulus and Poisson's ratio of a sheet of equilateral triangles, from its energy under
/// small homogeneous strains, against Y and 1/3: the worst relative error over several directions.
Finding equilateral_moduli(const Subject& subject);

}  // namespace foldproof
