// The reader of `evaluate crossings`: whatever the text, a judgement in which every query is
// counted, or an InputError that names its place. The first byte says the kind of pair.
#include <cstdint>
#include <string>

#include "reference/types.h"
#include "verification/subjects/crossing_queries.h"
#include "verification/fuzz/finding.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace foldproof;
  if (size == 0) return -1;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    const JudgedQueries judged =
        judge_queries(text, "queries.csv", data[0] % 2 == 0 ? "vertex-face" : "edge-edge", 1e-6);
    const long queries = long(judged.queries), apart = queries - judged.meetings;
    require(queries > 0 && apart >= 0, "no more queries meet than there are");
    require(judged.exact.misses <= judged.meetings && judged.exact.alarms <= apart,
            "no more is wrong than was asked");
  } catch (const InputError& error) {
    require(std::string(error.what()).starts_with("queries.csv:"), "a refusal names its file");
  }
  return 0;
}
