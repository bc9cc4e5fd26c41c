#include "verification/checks/filters/contact_checks.h"

namespace foldproof {

std::vector<Check> contact_checks() {
  std::vector<Check> all;
  for (const auto& part : {object_checks, response_checks, object_response_checks, pinch_checks,
                           friction_checks, capstan_checks})
    for (const Check& check : part()) all.push_back(check);
  return all;
}

}  // namespace foldproof
