// How answers of `foldproof converge` are told: tables for a reader, JSON for a program.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "convergence/any_case/converge.h"
#include "convergence/any_case/error_map.h"
#include "scripts/program/options.h"

namespace foldproof {

void print(const LadderAnswer& answer);

nlohmann::json to_json(const LadderAnswer& answer);

/// The map of a ladder in time and one in space, with the pairs for the errors that are wanted.
struct MapAnswer {
  ErrorMap map;
  std::vector<CheapestPair> pairs;
};

/// motion: of the case as it is [m].
MapAnswer map_answer(const LadderAnswer& in_time, const LadderAnswer& in_space, double motion,
                     const Options& options);

void print(const MapAnswer& answer);

nlohmann::json to_json(const MapAnswer& answer);

}  // namespace foldproof
