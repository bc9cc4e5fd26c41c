// Folds of a cloth, counted by the angles of its hinges.
#pragma once

#include <array>
#include <string>

#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

/// Where one band of fold angles ends and the next begins [degrees]; the last ends at 180.
constexpr std::array<double, 4> fold_band_ends = {5, 15, 45, 90};

/// For each band, the share of all hinges whose angle is in it, either way round, each weighted
/// with the rest length of its edge [1]. The shares sum up to 1; all are 0 without hinges, and NaN
/// if an angle is.
using FoldSpectrum = std::array<double, fold_band_ends.size() + 1>;

/// At the positions x, 3 x N [m].
FoldSpectrum fold_spectrum(const TriangleMesh& mesh, const PerParticle3& x);

/// "5 to 15 degrees"
std::string name_of_fold_band(size_t band);

}  // namespace foldproof
