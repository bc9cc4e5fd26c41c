// Wrinkles along the tension of a thin sheet that is clamped at both ends, stretched between them
// and compressed across.
#pragma once

#include <span>
#include <vector>

#include "verification/oracles/estimate.h"

namespace foldproof::oracles {

/// A plate of rigidity D and length L under a tension T along its length, in newtons per width, is
/// compressed across by b, per length. It wrinkles as w = X(s) cos(k y), s along the tension, at
/// the least b with a solution of
///   D (X'''' - 2 k^2 X'' + k^4 X) - T X'' - b k^2 X = 0,   X = X' = 0 at both ends,
/// over all k. The only number is the reach of bending against tension, (D/T)^(1/2), over L.
struct Wrinkles {
  Estimate wavelength;   // 2 pi/k, over L
  Estimate compression;  // b, over T
};

/// reach: (D/T)^(1/2)/L, in [1e-4, 0.1]. By functions: X = cos(p s)/cos(p/2) - cosh(m s)/cosh(m/2)
/// from the middle; p and k are roots. By series: X = sum c_j (1 - cos(2 pi j s)), which makes the
/// energy a sum of squares and the square of a sum; least in X and in k by turns.
Wrinkles wrinkles_by_functions(double reach);
Wrinkles wrinkles_by_series(double reach);

/// X by functions, 1 in the middle; places: over L from one end, in [0, 1].
std::vector<double> wrinkle_profile(double reach, std::span<const double> places);

/// Cerda and Mahadevan, Phys. Rev. Lett. 90 (2003) 074302: bending across against tension alone.
/// With X = sin(pi s), b = D k^2 + T (pi/L)^2/k^2 is least at k^4 = (pi/L)^2 T/D:
///   wavelength = 2 pi^(1/2) (D/T)^(1/4) L^(1/2),   b = 2 pi (D T)^(1/2)/L.
/// The uncertainty is the difference from wrinkles_by_functions: bending along, and the clamps.
Wrinkles wrinkles_by_scaling(double reach);

/// The rigidity D + T edge^2/48 against waves of many edges across the tension, of equilateral
/// triangles with rows of edges across and springs along all edges, whose hinges have the rigidity
/// D. Under T alone the slanting edges pull by T edge/sqrt(3), edges across push by half of it.
/// With a = sqrt(3)/2 edge the distance of rows and q = k edge, a wave cos(k x) adds per area
///   T/(4 sqrt(3) edge a) (4 (1 - cos(q/2)) - (1 - cos q)) = T edge^2 k^4/192 (1 - q^2/24 + ...),
/// as a rigidity of T edge^2/48 would. The uncertainty is that of the term in q^2, at k.
Estimate rigidity_under_tension(double D, double T, double edge, double k);

}  // namespace foldproof::oracles
