// One number that moves the random numbers of all checks and studies: other samples of
// what they assert.
#pragma once

namespace foldproof {

/// Set before anything runs (`--seed`), and left alone from then on. 0: the samples that the
/// project is judged by.
inline unsigned seed_shift = 0;

/// The seed of a generator in place of `own`, the one that its code names: that very one if nothing
/// is shifted. The factor is odd, so that no two shifts give a generator the same seed, and large,
/// so that its neighbours' are not met.
inline unsigned shifted_seed(unsigned own) { return own + 2654435761u * seed_shift; }

}  // namespace foldproof
