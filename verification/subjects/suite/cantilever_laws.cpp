// A heavy strip, far bent by its own weight, against the elastica.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "verification/oracles/heavy_cantilever.h"
#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/relaxation.h"
#include "verification/subjects/suite/strips.h"

namespace foldproof {

namespace {

using namespace suite;

//   end row      middle row     end row
//  .-.-.-.-.-.-.-.-o-.-.-.-.-.-.-.-.    -> y     A strip hangs over its middle row, which is held.
//                                                By symmetry each half is clamped level there.
constexpr int columns = 3, rows = 16;
constexpr double edge = 0.04;    // m
constexpr double weight = 9.81;  // m/s^2
constexpr double gamma = 10;     // rho g L^3/B of the scene [1]: the tip hangs 0.65 L low

// A strip of less than this share of the scene's rigidity is as limp as a chain: its gamma is over
// 1e4, and the elastica is computed to 1e5.
constexpr double least_rigidity = 1e-3;  // [1]

// A wide strip has the plate's rigidity B. A narrow one, whose sides curl the other way, has the
// beam's, B (1 - nu^2), with Poisson's ratio nu at most 1/2. This one is between them.
constexpr double poisson = 0.5;  // [1]

constexpr StripShape shape{columns, rows, edge};
const double half_length = shape.length() / 2;

PortableScene strip() {
  PortableScene scene = free_strip(shape);
  scene.name = "heavy strip";
  scene.material.young = 200;
  scene.material.bending_rigidity =
      scene.material.density * weight * std::pow(half_length, 3) / gamma;
  scene.dt = 2e-4;
  return scene;
}

Finding hangs_as_the_elastica(Trial& trial) {
  trial.require_level(1);
  trial.require("held");
  PortableScene scene = strip();
  // in 1.2 ms bending comes sqrt(t sqrt(B/rho)) = 0.02 m far
  const double rigidity = measured_rigidity(trial, scene, shape);
  scene.gravity = Vector3(0, 0, -weight);
  scene.held = rows_at_distance(scene, shape, 0);
  const Relaxed end = relaxed(trial, scene, {scene.mesh.rest, half_length, 1e-4, 4e-3});
  const bool resists = rigidity > least_rigidity * scene.material.bending_rigidity;
  const double compared = resists ? rigidity : scene.material.bending_rigidity;
  const double of_plate = scene.material.density * weight * std::pow(half_length, 3) / compared;
  const oracles::CantileverTip plate = oracles::heavy_cantilever(of_plate),
                               beam = oracles::heavy_cantilever(of_plate / (1 - poisson * poisson));
  double drop = 0, reach = 0;
  const std::vector<int> ends = rows_at_distance(scene, shape, half_length);
  for (const int i : ends) {
    drop -= end.x(2, i) / half_length / double(ends.size());
    reach += std::abs(end.x(1, i)) / half_length / double(ends.size());
  }
  Table measured{{"of the tip", ""},      {"measured rigidity", "N m"}, {"measured", "L"},
                 {"as a plate", "L"},     {"as a beam", "L"},           {"last move", "L"},
                 {"outside of both", "L"}};
  const double moved = end.last_move / half_length;
  const auto row = [&](const char* of, double value, double first, double second) {
    const auto [least, most] = std::minmax(first, second);
    measured.row(of, rigidity, value, first, second, moved,
                 std::max({0.0, least - value, value - most}) + moved);
  };
  row("drop", drop, plate.drop.value, beam.drop.value);
  row("reach", reach, plate.reach.value, beam.reach.value);
  std::string note;
  if (!resists)
    note = fmt::format(
        "It does not resist bending: {:.2g} N m are measured, the scene has {:.2g} N m; it hangs "
        "limp, {:.2f} of its length low, where a strip of the scene's rigidity hangs {:.2f}",
        rigidity, compared, drop, plate.drop.value);
  return judge_worst(measured, 0.03,
                     "eight folds instead of a curve: (1/8)^2 of the drop, 1.6 %; the rigidity is "
                     "measured to 2 %, which moves the tip by 1 %; it stretches by 0.3 %",
                     note);
}

}  // namespace

std::vector<Law> cantilever_laws() {
  return {
      {"cantilever.heavy-strip-hangs-as-the-elastica",
       "A strip that hangs from its middle row takes the elastica's shape for its own rigidity.",
       "heavy elastica", hangs_as_the_elastica},
  };
}

}  // namespace foldproof
