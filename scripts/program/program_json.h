// The program behind an answer in JSON, so that a record can say who found it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace foldproof {

/// version, commit, tree ("clean" or "dirty"), identity, cpu, date and command. command: as typed.
nlohmann::json program_json(const std::string& command);

}  // namespace foldproof
