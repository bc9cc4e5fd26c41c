#include "verification/specimens/refusal.h"

#include "reference/types.h"

namespace foldproof {

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace foldproof
