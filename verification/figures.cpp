#include "verification/figures.h"

#include <stdexcept>

namespace foldproof {

std::string_view name_of(Mark mark) {
  switch (mark) {
    case Mark::measured:
      return "measured";
    case Mark::unfinished:
      return "unfinished";
    case Mark::diverged:
      return "diverged";
  }
  throw std::logic_error("name_of: a mark without a name");
}

}  // namespace foldproof
