#pragma once

#include "verification/files/results_file.h"

namespace foldproof {

/// Measures the speed of forces, products, solves and steps against the number of particles, and
/// the memory of the largest step.
/// most_particles: the largest sheet of the growth study.
RunRecord bench(int most_particles);

}  // namespace foldproof
