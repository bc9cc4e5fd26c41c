// The cheapest method of a motion: ties are printed as ties, on costs that are known.
#include <catch2/catch.hpp>
#include <stdexcept>

#include "convergence/work_precision/work_precision.h"

using namespace foldproof;

namespace {

/// A method whose only run reaches every error at that cost.
PrecisionCurve costing(const std::string& method, double applications) {
  const double seconds = 1e-3 * applications;
  return {integrator_named(method), {{40, 1e-5, applications, seconds, 1, {}}}};
}

/// Steps are tried by a ratio of 1.5.
PrecisionScene scene_of(std::vector<PrecisionCurve> curves) {
  PrecisionScene scene{};
  scene.problem.description = "the motion";
  scene.problem.end = 0.8;
  scene.problem.ratio = 1.5;
  scene.truth = {{}, 1, 0, 0.01, 0.01, 0.01};
  scene.curves = std::move(curves);
  return scene;
}

Table cheapest_of(const PrecisionScene& scene) {
  for (const Table& table : precision_tables({scene}))
    if (table.name == "cheapest") return table;
  throw std::logic_error("no such table");
}

}  // namespace

TEST_CASE("methods nearer in cost than two tried steps are alike", "[work-precision]") {
  const Table tied =
      cheapest_of(scene_of({costing("A", 310), costing("B", 140), costing("C", 100)}));
  CHECK(tied.texts("cheapest method").front() == "C");
  CHECK(tied.texts("alike").front() == "B");

  const Table won =
      cheapest_of(scene_of({costing("A", 310), costing("B", 170), costing("C", 100)}));
  CHECK(won.texts("cheapest method").front() == "C");
  CHECK(won.texts("alike").front().empty());
}
