// JSON as it is printed.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace foldproof {

/// The value as JSON text; bytes that are no UTF-8, as file names may hold, become U+FFFD.
inline std::string json_text(const nlohmann::json& value) {
  return value.dump(1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace foldproof
