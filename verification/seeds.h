// One number that shifts the random numbers of all checks and studies, to run them on other
// samples.
#pragma once

namespace foldproof {

/// Set once before anything runs (`--seed`). 0: the default samples.
inline unsigned seed_shift = 0;

/// The seed of a generator whose code names `own`: equal to `own` without a shift. The factor is
/// odd, so that different shifts give a generator different seeds, and large, so that seeds of
/// different generators do not coincide.
inline unsigned shifted_seed(unsigned own) { return own + 2654435761u * seed_shift; }

}  // namespace foldproof
