#include "verification/oracles/forecast.h"

#include "verification/oracles/scalars.h"
#include "verification/oracles/triple.h"

namespace foldproof::oracles {

namespace {

Triple<Digits50> exactly(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

Vector3 nearest(const Triple<Digits50>& v) {
  return {rounded(v.x).value, rounded(v.y).value, rounded(v.z).value};
}

}  // namespace

ForecastAnswer forecast_answer(const ForecastInput& input) {
  const Triple<Digits50> N = exactly(input.normal), v = exactly(input.v);
  const Triple<Digits50> relative = v - exactly(input.v_object);
  const Digits50 tau = input.tau, along = dot(relative, N), phi_new = input.phi + tau * along;
  if (phi_new >= 0) return {rounded(phi_new).value, input.v};
  const Digits50 push = -phi_new / tau;  // v_pN' - v_pN
  const Triple<Digits50> sliding = relative - along * N;
  const Digits50 speed = length(sliding);
  const Digits50 kept = 1 - input.friction * push / speed;
  const Digits50 lost =
      speed == 0 ? Digits50(0) : Digits50(kept > 0 ? Digits50(1 - kept) : Digits50(1));
  return {rounded(phi_new).value, nearest(v + push * N - lost * sliding)};
}

}  // namespace foldproof::oracles
