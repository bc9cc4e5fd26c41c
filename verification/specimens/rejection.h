// The message of a refusal.
#pragma once

#include <functional>
#include <string>

namespace foldproof {

/// The message with which `act` refuses; empty if it does not, or by anything but InputError.
std::string rejection_message(const std::function<void()>& act);

}  // namespace foldproof
