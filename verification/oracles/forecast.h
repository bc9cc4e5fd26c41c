// Interface forecasting and Coulomb friction (BMF03 section 5.2) as printed, in 50 digits.
#pragma once

#include "reference/types.h"

namespace foldproof::oracles {

/// A particle near an object. The inputs count as exact, the normal is not normalised.
struct ForecastInput {
  double phi;            // signed distance, negative inside [m]
  Vector3 normal;        // N, outward [1]
  Vector3 v_object, v;   // of the object there and of the particle [m/s]
  double tau, friction;  // forecast time [s], mu [1]
};

struct ForecastAnswer {
  double phi_new;  // phi + tau (v - v_object).N [m]
  Vector3 v;       // corrected if phi_new < 0 [m/s]
};

/// All numbers are accurate to their rounding.
ForecastAnswer forecast_answer(const ForecastInput& input);

}  // namespace foldproof::oracles
