// The studies of this room: how does what sticks follow?
#pragma once

#include "convergence/study.h"

namespace foldproof {

// sticking-lag: lag, limits and cost of what sticks, with forecasts and without
Study sticking_lag_study();

}  // namespace foldproof
