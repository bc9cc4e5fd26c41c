// The reader of a solver's answers: whatever the header, a declaration and arrays that keep their
// promises, or a SolverFailure with a known cause. The first byte chooses what is asked.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "verification/fuzz/finding.h"
#include "verification/subjects/pipe/declaration.h"
#include "verification/subjects/pipe/message.h"

namespace foldproof {

namespace {

void ask_declaration(const nlohmann::json& header) {
  const Declaration declared = read_declaration(header);
  require(declared.level >= 0 && declared.level <= 3, "a level is one of four");
  require(declared.order >= 0 && declared.order <= 9, "an order is one of ten");
  require(declared.solve_tolerance >= 0 && declared.solve_tolerance < 1, "a tolerance is below 1");
}

void ask_numbers(const nlohmann::json& header) {
  require(std::isfinite(number_of(header, "energy", 0)), "an energy is finite");
  work_of(header);
}

}  // namespace
}  // namespace foldproof

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace foldproof;
  if (size == 0) return 0;
  const std::string line(reinterpret_cast<const char*>(data + 1), size - 1);
  try {
    const nlohmann::json header = parse_header(line);
    require(header.is_object(), "a header is an object");
    if (data[0] % 3 == 0) ask_declaration(header);
    if (data[0] % 3 == 1) ask_numbers(header);
    if (data[0] % 3 == 2)
      require_arrays(header, {{"x", {9, 3}}, {"v", {9, 3}}}, data[0] % 2 ? "f4" : "f8");
  } catch (const SolverFailure& failure) {
    const std::string cause = failure.cause;
    require(cause == "header" || cause == "shape" || cause == "truncated" || cause == "oversized",
            "a cause of the header");
  }
  return 0;
}
