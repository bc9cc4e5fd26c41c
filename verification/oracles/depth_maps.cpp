#include "verification/oracles/depth_maps.h"

#include "verification/oracles/scalars.h"

namespace foldproof::oracles {

Estimate power_map(const Band& band, double phi) {
  const Digits50 low = band.nearest, high = band.reach, deepest = band.deepest;
  const Digits50 u = (phi + deepest) / (high + deepest);
  // f'(tau) = (tau - eps) p/(tau + t^) = 1
  const Digits50 exponent = (high + deepest) / (high - low);
  return rounded(Digits50(low + (high - low) * pow(u, exponent)));
}

Estimate blend_map(const Band& band, double phi) {
  const Digits50 low = band.nearest, high = band.reach, whole = high + band.deepest,
                 climb = high - low;
  const Digits50 w = climb / 2, s = phi + Digits50(band.deepest), bend = whole - w;
  // climb = m bend + w (m + 1)/2
  const Digits50 m = (climb - w / 2) / (bend + w / 2);
  if (s <= bend) return rounded(Digits50(low + m * s));
  const Digits50 beyond = s - bend;  // there the slope is m + (1 - m) beyond/w
  return rounded(Digits50(low + m * s + (1 - m) * beyond * beyond / (2 * w)));
}

}  // namespace foldproof::oracles
