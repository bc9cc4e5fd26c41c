// What a call refuses.
#pragma once

#include <string>

#include "reference/types.h"

namespace foldproof {

/// The message of the InputError that the call throws; "" if it throws none.
template <class Call>
std::string complaint(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace foldproof
