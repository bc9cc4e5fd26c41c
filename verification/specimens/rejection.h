// The message of a rejected input.
#pragma once

#include <functional>
#include <string>

namespace foldproof {

/// The message of the InputError that `act` throws; empty if it throws none.
std::string rejection_message(const std::function<void()>& act);

}  // namespace foldproof
