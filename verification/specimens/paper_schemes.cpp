#include "verification/specimens/paper_schemes.h"

#include "reference/dynamics/integrator.h"

namespace foldproof {

void add_for_each_scheme(
    std::vector<Check>& list, const Check& pattern,
    const std::function<Finding(const Subject&, const std::string& integrator)>& run) {
  for (const Integrator& integrator : paper_schemes()) {
    const std::string name(integrator.name);
    Check check = pattern;
    check.name += "." + name;
    check.claim = "Scheme " + name + ": " + check.claim;
    check.run = [run, name](const Subject& subject) { return run(subject, name); };
    list.push_back(std::move(check));
  }
}

}  // namespace foldproof
