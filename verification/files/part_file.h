// The results of one job of a run, kept so that an interrupted run can go on.
#pragma once

#include <optional>
#include <string>

#include "verification/files/results_file.h"

namespace foldproof {

/// What a kept result depends on besides the job.
struct PartOf {
  std::string job;      // its name
  std::string program;  // digest of its code
  std::string tier;
  unsigned seed = 0;

  bool operator==(const PartOf&) const = default;
};

/// Writes records, studies and cases of `part` as CBOR (RFC 8949), every number to the bit; origin:
/// where and when they were made. Throws std::runtime_error naming the file.
void write_part(const std::string& path, const PartOf& of, const RunOrigin& origin,
                const RunRecord& part);

/// The same, with one origin; nothing if there is no such file, it is of something else,
/// or it is damaged.
std::optional<RunRecord> read_part(const std::string& path, const PartOf& of);

}  // namespace foldproof
