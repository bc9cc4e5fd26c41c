#include "reference/dynamics/integrator.h"

#include "reference/dynamics/mixed.h"

namespace foldproof {

const std::vector<Integrator>& integrators() {
  static const std::vector<Integrator> table = {
      {"A", "mixed explicit/implicit", "BMF03 section 3, first list", 2, 1, mixed_explicit_implicit},
      {"B", "central Newmark", "BMF03 section 3, second list", 2, 1, central_newmark},
      {"C", "variable-step Newmark", "BMF03 section 3, last list", 2, 1, variable_step_newmark},
  };
  return table;
}

const Integrator& integrator_named(std::string_view name) {
  std::string known;
  for (const Integrator& integrator : integrators()) {
    if (integrator.name == name) return integrator;
    known += (known.empty() ? "" : ", ") + std::string(integrator.name);
  }
  throw InputError("unknown integrator '" + std::string(name) + "'; known: " + known);
}

}  // namespace foldproof
