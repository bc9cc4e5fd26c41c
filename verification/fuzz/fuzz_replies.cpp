// The reader of a solver's answers: whatever the header, a declaration and arrays that keep their
// promises, or a SolverFailure with a known cause; whatever the bytes, finite numbers that are
// those bytes, or the cause "nan". The first byte chooses what is asked.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
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

/// Whether each number, rounded to the type that was sent, has the bytes that were sent.
template <class Number>
bool are_the_bytes(const std::vector<double>& numbers, const std::string& bytes) {
  for (size_t k = 0; k < numbers.size(); ++k) {
    const Number number = Number(numbers[k]);
    if (std::memcmp(&number, bytes.data() + k * sizeof number, sizeof number) != 0) return false;
  }
  return numbers.size() == bytes.size() / sizeof(Number);
}

void ask_array(const std::string& bytes, bool is_single) {
  const std::vector<double> numbers = as_numbers(bytes, is_single, {"x", {long(bytes.size()), 3}});
  for (const double number : numbers) require(std::isfinite(number), "numbers are finite");
  require(is_single ? are_the_bytes<float>(numbers, bytes) : are_the_bytes<double>(numbers, bytes),
          "numbers are those that were sent");
}

bool is_known(const std::string& cause) {
  return cause == "header" || cause == "shape" || cause == "truncated" || cause == "oversized";
}

}  // namespace
}  // namespace foldproof

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace foldproof;
  if (size == 0) return 0;
  const std::string line(reinterpret_cast<const char*>(data + 1), size - 1);
  try {
    if (data[0] % 4 == 3) {
      ask_array(line, data[0] % 8 == 7);
      return 0;
    }
    const nlohmann::json header = parse_header(line);
    require(header.is_object(), "a header is an object");
    if (data[0] % 4 == 0) ask_declaration(header);
    if (data[0] % 4 == 1) ask_numbers(header);
    if (data[0] % 4 == 2)
      require_arrays(header, {{"x", {9, 3}}, {"v", {9, 3}}}, data[0] % 8 == 6 ? "f4" : "f8");
  } catch (const SolverFailure& failure) {
    require(data[0] % 4 == 3 ? failure.cause == "nan" : is_known(failure.cause),
            "a cause that fits");
  }
  return 0;
}
