// Claims of BMF03 section 5: cloth against objects.
#include "verification/claims.h"

namespace foldproof {

/// In the order of their ids; each part of the section has a function of its own.
std::vector<Claim> object_claims() {
  std::vector<Claim> claims;
  return claims;
}

}  // namespace foldproof
