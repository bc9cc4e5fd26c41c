// Messages of the protocol: a header in JSON, and raw little-endian arrays.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "reference/types.h"
#include "verification/subjects/pipe/child_process.h"

namespace foldproof {

/// A message to be sent; arrays are appended with their entry in the header.
struct Request {
  nlohmann::json header;
  std::string bytes = {};

  void add(const char* name, const PerParticle3& values);             // f8, N x 3
  void add(const char* name, std::span<const double> values);         // f8, N
  void add(const char* name, std::span<const int> values, int wide);  // i4, N x wide, or N if 1
  void add(const char* name, std::span<const double> values, std::vector<long> shape);  // f8
};

/// The arrays of a request by name, as nested lists.
nlohmann::json lists_of(const Request& request);

/// An array that an answer must hold, in the solver's precision.
struct WantedArray {
  std::string name;
  std::vector<long> shape;
};

/// An answer: its header, and the wanted arrays in their order, as doubles.
struct Answer {
  nlohmann::json header;
  std::vector<std::vector<double>> arrays;
};

/// Parses a header line. Throws SolverFailure "header" for what is no JSON object.
nlohmann::json parse_header(const std::string& line);

/// Holds the list of an answer's arrays against what is wanted. Throws "shape" with the first
/// difference, or "oversized", "truncated" where only the first extent differs.
void require_arrays(const nlohmann::json& header, const std::vector<WantedArray>& wanted,
                    const std::string& type);

/// Reads the arrays. Throws "nan" for a number that is not finite.
std::vector<std::vector<double>> read_arrays(ChildProcess& child,
                                             const std::vector<WantedArray>& wanted, bool is_single,
                                             ChildProcess::Deadline deadline);

/// The bytes of an array of vectors as doubles. Throws "nan" for a number that is not finite.
std::vector<double> as_numbers(std::string_view bytes, bool is_single, const WantedArray& array);

/// 3 x N of N x 3 numbers.
PerParticle3 as_particles(const std::vector<double>& values);

}  // namespace foldproof
