// The reader of `evaluate bending`: whatever the text, 24 finite numbers a row, or an InputError
// that names its line. A zero byte parts the rows from those of the rest positions.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>

#include "reference/types.h"
#include "verification/subjects/bending_rows.h"
#include "verification/fuzz/finding.h"

namespace foldproof {

namespace {

void require_finite_rows(const std::string& output) {
  std::istringstream lines(output);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    int count = 0;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ','); ++count)
      require(std::isfinite(std::strtod(field.c_str(), nullptr)), "every number told is finite");
    require(count == 24, "a row has 24 numbers");
  }
}

}  // namespace
}  // namespace foldproof

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace foldproof;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const size_t end = text.find('\0');
  const std::string rest = end == std::string::npos ? "" : text.substr(end + 1);
  try {
    require_finite_rows(bending_of_rows({text.substr(0, end), "rows.csv"}, {rest, "rest.csv"}));
  } catch (const InputError& error) {
    const std::string said = error.what();
    require(said.starts_with("rows.csv:") || said.starts_with("rest.csv:"),
            "a refusal names its file");
  }
  return 0;
}
