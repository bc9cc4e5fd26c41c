#include "verification/specimens/rejection.h"

#include "reference/types.h"

namespace foldproof {

std::string rejection_message(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace foldproof
