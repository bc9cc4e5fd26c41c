#pragma once

#include <string>

namespace foldproof {

/// Reads rows of 12 positions (x1, x2, x3, x4), 12 velocities, ke, kd, theta0 and prints 12 elastic
/// and 12 damping force components in 17 digits, as CSV on standard output. rest_file: rows of 12
/// rest positions, for rest weighting; "" means current weighting.
/// Throws InputError "file:line: ...".
void evaluate_bending(const std::string& file, const std::string& rest_file);

/// A file's text, and the name by which messages call it.
struct NamedText {
  std::string text, name;
};

/// The output for such rows: a heading, and 24 finite numbers for each. rest: no text means
/// current weighting.
std::string bending_of_rows(const NamedText& rows, const NamedText& rest);

}  // namespace foldproof
