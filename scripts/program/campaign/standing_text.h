// Where a campaign stands, in words.
#pragma once

#include "scripts/program/campaign/standing.h"

namespace foldproof {

/// Lines: counts, the work that is left, the commonest reasons of failures, conflicts.
std::string standing_text(OpenCampaign& of, const Standing& standing);

/// The same as JSON.
std::string standing_json(OpenCampaign& of, const Standing& standing);

/// One line: how many are done, run and are missing. seconds_left: of the clock; NaN: not known.
std::string watch_line(const OpenCampaign& of, const Standing& standing, double seconds_left);

/// The same as a page, with reasons, that loads itself again while jobs run.
std::string watch_page(const OpenCampaign& of, const Standing& standing, double seconds_left);

}  // namespace foldproof
