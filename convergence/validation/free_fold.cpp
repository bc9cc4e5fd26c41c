// free-fold: a strip that is folded back over itself and held by nothing, against the elastica.

#include "convergence/validation/comparison.h"
#include "convergence/validation/strip_ladder.h"
#include "convergence/study.h"
#include "verification/oracles/folds.h"

namespace foldproof {

namespace {

constexpr double resolution = 0.01;  // of the height [1]

/// The lifted part on one mesh, its weight such that it lifts off without a moment. Lengths in
/// units of (B/(rho_A g))^(1/3).
struct LiftedPart {
  double lifted, height;
  double spacing;      // of the rows
  double unfinished;   // of the solve [1]
  double pull;         // the largest that the floor would have to exert, over the weight [1]
  double sunk;         // the lowest row below the floor, over the lifted length [1]
  double landing = 0;  // how far from the floor its end is
  std::vector<oracles::StripPoint> points;
};

/// The lifted part at rest in its own unit of length, the strip's.
struct RestingPart {
  RowStrip strip;
  StripAtRest rest;
};

/// gamma: weight per area times the lifted length's third power, over the rigidity. Clamped flat on
/// the floor, and propped where it comes down, so that it has no moment there.
RestingPart part_of_weight(const Subject& subject, double gamma, int panels, StripAtRest start) {
  const double unit = strip_D / std::pow(strip_length, 2);  // of forces [N/m]
  const double gravity = gamma * unit / (strip_density * strip_length);
  constexpr double strain = 1e-8;  // of the springs under the weight [1]
  RestingPart part{{subject,
                    strip_patterns()[0],
                    panels,
                    {gravity, 0, gamma * unit / strain},
                    {0, {{pi, {0, 0}, RowHold::propped}}}},
                   {}};
  part.rest = at_rest(part.strip, std::move(start));
  return part;
}

/// The elastica's slopes in the middles of the free panels.
StripAtRest start_of(const oracles::FreeFold& fold, int panels) {
  StripAtRest start{Eigen::VectorXd(panels),
                    Eigen::VectorXd::Constant(panels, strip_length / panels)};
  const std::size_t steps = fold.points.size() - 1;
  for (int k = 0; k < panels; ++k)
    start.slopes[k] = fold.points[std::size_t(k + 1) * steps / std::size_t(panels)].slope;
  return start;
}

/// The bend at the lift-off, in the middle of the first panel, from those at the two rows behind
/// it: the moment is linear there, to second order [rad].
double bend_at_lift_off(const StripAtRest& rest) {
  const double at_row_1 = rest.slopes[0], at_row_2 = rest.slopes[1] - at_row_1;
  return 1.5 * at_row_1 - 0.5 * at_row_2;
}

/// Numbers of a part that lifts off without a moment.
LiftedPart lifted_part_of(const RestingPart& part, double gamma) {
  const double length = std::cbrt(gamma), unit = length / strip_length;
  LiftedPart lifted{length, 0, unit * part.strip.spacing(), 0, 0, 0, 0, {}};
  const Eigen::Matrix2Xd rows = part.strip.rows(part.rest.slopes, part.rest.lengths);
  for (Eigen::Index i = 1; i < rows.cols(); ++i) {
    const Eigen::Vector2d place = unit * (rows.col(i) - rows.col(1) / 2);
    lifted.points.push_back({i > 1 ? part.rest.slopes[i - 2] : 0, place.x(), place.y()});
    lifted.sunk = std::max(lifted.sunk, -place.y() / length);
  }
  lifted.height = highest_row(lifted.points);
  const double down = unit * ((rows.col(rows.cols() - 1) + rows.col(rows.cols() - 2)) / 2).y();
  lifted.landing = std::abs(down);
  lifted.unfinished = part.rest.strain + part.rest.last_step;
  const double weight = gamma * strip_D / std::pow(strip_length, 2) * part.strip.width(),
               prop = part.rest.hold_force.y() / weight;
  lifted.pull = -std::min({prop, 1 - prop, 0.0});
  return lifted;
}

LiftedPart lifted_part_on_mesh(const Subject& subject, const oracles::FreeFold& fold, int panels) {
  // by the secant rule, from two weights about the elastica's
  const double exact = std::pow(fold.lifted.value, 3);
  double before = 0.97 * exact, gamma = exact;
  RestingPart part = part_of_weight(subject, before, panels, start_of(fold, panels));
  double bend_before = bend_at_lift_off(part.rest);
  part.rest = part_of_weight(subject, gamma, panels, part.rest).rest;
  for (int turn = 0; turn < 8; ++turn) {
    const double bend = bend_at_lift_off(part.rest);
    const double step = -bend * (gamma - before) / (bend - bend_before);
    if (!(std::abs(step) > 1e-9 * gamma)) break;
    before = std::exchange(gamma, gamma + step);
    bend_before = bend;
    part.rest = part_of_weight(subject, gamma, panels, part.rest).rest;
  }
  LiftedPart lifted = lifted_part_of(part, gamma);
  lifted.unfinished += std::abs(gamma - before) / gamma;
  return lifted;
}

NamedFinding height_agrees(const Table& levels, double floor, const oracles::FreeFold& fold) {
  Ladder heights;
  heights.values = levels.numbers("height");
  heights.floor = floor;
  const double scale = resolution * fold.height.value;
  return {"free-fold.height-agrees",
          "A long strip that is folded back over itself on a smooth floor, held by nothing, is as "
          "high as the elastica within one percent.",
          judge_comparison(compare_ladder("height of the fold", heights, fold.height), scale,
                           "a laboratory reads the height to one percent of it",
                           "S at the finest mesh; heights in units of (B/(rho_A g))^(1/3)")};
}

NamedFinding order_of(const Table& levels, double floor, const oracles::FreeFold& fold) {
  Convergence heights = convergence_of(levels, "error of the height"),
              lengths = convergence_of(levels, "error of the lifted length");
  heights.floor = floor + fold.height.uncertainty;
  lengths.floor = floor + fold.lifted.uncertainty;
  Table orders{{"error", ""}, {"distance of its order from 2", "1"}};
  for (const auto& [name, errors] : {std::pair{"height", heights}, {"lifted length", lengths}}) {
    const oracles::Estimate deviation = order_deviation(errors, 2, 1);
    orders.row(name, deviation);
  }
  return {
      "free-fold.is-second-order",
      "The height and the lifted length of a free fold tend to the elastica's with second order.",
      judge_worst(std::move(orders), 0.1,
                  "another order is off by 1: a lift-off at a row, not in the middle of a panel, "
                  "makes the length's order 1")};
}

NamedFinding floor_only_pushes(const Table& levels, double floor) {
  return {"free-fold.floor-only-pushes",
          "No row of a free fold is below the floor, and the floor pulls on none.",
          {{std::max(levels.worst("pull of the floor"), levels.worst("depth below the floor")),
            1e-6, floor, "1", "shares of the weight and of the length; Newton's steps end at 1e-7"},
           levels}};
}

NamedFinding comes_down(const Table& levels, double floor) {
  Convergence errors = convergence_of(levels, "end over the floor");
  errors.floor = floor;
  return {"free-fold.comes-down-on-the-floor",
          "A free fold that lifts off without a moment, and ends flat without one, ends on the "
          "floor, to second order.",
          {order_verdict(errors, 2, 1, 0.1, "another order is off by 1"), levels,
           "its end's height is none of the conditions that the simulated strip is given"}};
}

Figure shape_of(const LiftedPart& finest, const oracles::FreeFold& fold) {
  Figure figure{"fold",
                "A strip folded back over itself, held by nothing",
                {"across from the lift-off", "(B/(rho_A g))^(1/3)"},
                {"height over the floor", "(B/(rho_A g))^(1/3)"},
                "Every second row of the finest mesh beside the elastica, to scale. The strip goes "
                "on along the floor at both ends."};
  Curve elastica{"elastica"}, simulated{"simulated"};
  for (std::size_t i = 0; i < fold.points.size(); i += 20)
    elastica.point(fold.points[i].across, fold.points[i].up);
  for (std::size_t i = 0; i < finest.points.size(); i += 2)
    simulated.point(finest.points[i].across, finest.points[i].up);
  figure.curves = {elastica, simulated};
  return figure;
}

StudyResult run_free_fold(const Subject& subject, Tier tier, const Progress& progress) {
  const oracles::FreeFold fold = oracles::free_fold_by_shooting();
  std::vector<int> panels{32, 64, 128};
  if (tier == Tier::full) panels.push_back(256);
  Table levels(
      "spacing of the rows [1]; lifted length [1]; height [1]; error of the height [1]; error of "
      "the lifted length [1]; end over the floor [1]; pull of the floor [1]; depth below the floor "
      "[1]");
  LiftedPart finest;
  double floor = 0;
  for (const int count : panels) {
    finest = lifted_part_on_mesh(subject, fold, count);
    update_worst(floor, finest.unfinished);
    levels.row(
        finest.spacing, finest.lifted, finest.height, std::abs(finest.height - fold.height.value),
        std::abs(finest.lifted - fold.lifted.value), finest.landing, finest.pull, finest.sunk);
    progress(double(levels.rows()) / double(panels.size()));
  }
  StudyResult result;
  result.findings = {height_agrees(levels, floor, fold), order_of(levels, floor, fold),
                     comes_down(levels, floor), floor_only_pushes(levels, floor)};
  result.figures = {shape_of(finest, fold)};
  return result;
}

}  // namespace

Study free_fold_study() {
  return {"free-fold",
          "A strip that is folded back over itself and held by nothing is as high as the elastica "
          "with the mesh's own rigidity, to second order.",
          {"height-agrees", "is-second-order", "floor-only-pushes"},
          "Plaut 2015",
          "The strip lies on a smooth floor, lifts off without a moment, bends back, and comes "
          "down on its own lower half without one. It is long enough to lie flat on both sides; "
          "its thickness counts for nothing. On a smooth floor it may roll along at no cost, but "
          "its shape stays, because the force across vanishes. Its one length is (B/(rho_A "
          "g))^(1/3), B the rigidity, and its height is a fixed multiple of that. On a mesh a "
          "whole number of panels is lifted; the weight is found at which the bend vanishes where "
          "the strip leaves the floor, and it is propped where it comes down. D is the elastica by "
          "shooting, which a check holds against collocation.",
          run_free_fold,
          "validation"};
}

}  // namespace foldproof
