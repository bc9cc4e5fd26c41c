#include "verification/figures.h"

namespace foldproof {

Curve curve_of(const std::string& label, const Table& table, std::string_view x,
               std::string_view y) {
  return {label, table.numbers(x), table.numbers(y), nan, {}};
}

std::string_view name_of(Mark mark) {
  constexpr std::string_view names[] = {"measured", "unfinished", "diverged"};
  return names[size_t(mark)];
}

}  // namespace foldproof
