// The answers of `foldproof converge` as tables for a reader and as JSON for a program.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "convergence/any_case/converge.h"
#include "convergence/any_case/error_map.h"
#include "convergence/any_case/predictability.h"

namespace foldproof {

void print(const LadderAnswer& answer);
nlohmann::json to_json(const LadderAnswer& answer);

/// How long the positions of a ladder in time are predictable.
struct PredictabilityAnswer {
  Predictability of;
  int ensemble = 0;                           // runs
  std::vector<StatisticOverRuns> statistics;  // beyond the horizon; empty if there is none
};

void print(const PredictabilityAnswer& answer);
nlohmann::json to_json(const PredictabilityAnswer& answer);

/// The map of a ladder in time and one in space, with the pairs for the errors that are wanted.
struct MapAnswer {
  ErrorMap map;
  std::vector<CheapestPair> pairs;
};

void print(const MapAnswer& answer);
nlohmann::json to_json(const MapAnswer& answer);

}  // namespace foldproof
