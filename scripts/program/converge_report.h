// How answers of `foldproof converge` are told: tables for a reader, JSON for a program.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "convergence/any_case/converge.h"

namespace foldproof {

void print(const LadderAnswer& answer);

nlohmann::json to_json(const LadderAnswer& answer);

}  // namespace foldproof
