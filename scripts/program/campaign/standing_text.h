// Where a campaign stands, in words.
#pragma once

#include "scripts/program/campaign/standing.h"

namespace foldproof {

/// Lines: counts, the commonest reasons of failures, conflicts.
std::string standing_text(OpenCampaign& of, const Standing& standing);

/// The same as JSON.
std::string standing_json(OpenCampaign& of, const Standing& standing);

}  // namespace foldproof
