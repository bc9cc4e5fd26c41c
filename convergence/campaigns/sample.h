// Samples of parameters.
#pragma once

#include "convergence/campaigns/campaign.h"

namespace foldproof {

/// The value of a range { from, to, spacing = "linear" or "log" } at the share u of its
/// way, 0 to 1. Throws InputError for another spacing, and for a logarithmic range that
/// does not stay above 0.
double spread_over(const KeyTable& range, double u);

/// The quantile u, 0 < u < 1, of the standard normal distribution, to 1e-14.
double normal_quantile(double u);

/// [sample] with `count`, `seed` and parameters { from, to } or { mean, deviation }: a Latin
/// hypercube (McKay, Beckman, Conover 1979). Of `count` equally likely strata of each parameter
/// every one has exactly one sample. The same seed gives the same samples on every machine.
CampaignAxis latin_hypercube(const KeyTable& table);

}  // namespace foldproof
