// Written by scripts/law_coverage: what the laws ask of the reference, to tell before they run.
#pragma once

#include <string_view>

namespace foldproof {

struct LawSize {
  std::string_view name;
  long scenes, steps, particles;  // of all its scenes; particles: the most of a scene
  double particle_steps;
};

constexpr LawSize law_sizes[] = {
    {"smoke.sheet-at-rest-stays", 1, 20, 42, 840},
};

}  // namespace foldproof
