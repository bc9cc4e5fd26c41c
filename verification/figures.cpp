#include "verification/figures.h"

#include <stdexcept>

namespace foldproof {

Curve curve_of(const std::string& label, const Table& table, std::string_view x,
               std::string_view y) {
  return {label, table.numbers(x), table.numbers(y), nan, {}};
}

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
