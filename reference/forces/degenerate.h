#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace foldproof {

/// An element degenerated during the motion, so its force has no direction: reported,
/// never a silent NaN.
struct DegenerateElement : std::runtime_error {
  std::vector<int> particles;

  DegenerateElement(const std::string& what, std::vector<int> of)
      : std::runtime_error(describe(what, of)), particles(std::move(of)) {}

 private:
  static std::string describe(const std::string& what, const std::vector<int>& of) {
    std::string text = what + " (particles";
    for (int particle : of) text += " " + std::to_string(particle);
    return text + ")";
  }
};

}  // namespace foldproof
