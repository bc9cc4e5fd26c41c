// The buckling spring of Choi and Ko, a model to compare with.
#include <algorithm>
#include <array>
#include <cmath>

#include "verification/checks/forces/force_checks.h"
#include "verification/specimens/buckling_column.h"

namespace foldproof {

namespace {

constexpr const char* source = "Choi, Ko 2002, as later papers describe it";

Finding force_is_the_energys(const Subject&) {
  Table found{{"distance over length", "1"}, {"force", "N"}, {"error", "1"}};
  const BucklingSpring spring = BucklingColumn{}.spring;
  for (const double part : {.3, .62, .9, .97, .999}) {
    const double d = part * spring.length, change = 1e-5 * spring.length;
    const double slope = (8 * (spring.energy(d + change) - spring.energy(d - change)) -
                          (spring.energy(d + 2 * change) - spring.energy(d - 2 * change))) /
                         (12 * change);
    found.row(part, spring.force(d), std::abs(slope / spring.force(d) - 1));
  }
  return judge_worst(found, "error", 1e-7,
                     "differences in double precision over a hundred-thousandth of the length");
}

/// The strain at which a straight column gives way, by bisection, as a load over Euler's.
Finding gives_way_at_once(const Subject&) {
  BucklingColumn column;
  double holds = 0, gives_way = 0.1;
  for (int turn = 0; turn < 60 && gives_way > 1e-12; ++turn) {
    const double strain = (holds + gives_way) / 2;
    (stiffness_across(column, strain) < 0 ? gives_way : holds) = strain;
  }
  // two springs cross every section; each bends with k_b, one starts at every particle: B = 2 k_b
  const double distance = column.spring.length * (1 - gives_way);
  const double load = -2 * column.spring.force(distance);
  const double length = column.spacing * (column.particles - 3);  // between the clamps' middles
  const double euler = std::pow(2 * pi / length, 2) * 2 * column.spring.bending;
  Table found{{"strain", "1"}, {"load", "N"}, {"Euler's load", "N"}, {"load over Euler's", "1"}};
  found.row(gives_way, load, euler, load / euler);
  return judge_worst(found, "load over Euler's", 1e-6,
                     "a millionth: no barrier, real or artificial",
                     "a straight column is stiff across only by tension");
}

struct Trial {
  ColumnMethod method;
  const char* words;
  double step;  // over the elastic limit
};

Table shortened_columns() {
  Table found{{"method", ""},
              {"step over the elastic limit", "1"},
              {"energy at the end, of that at the stop", "1"},
              {"largest energy, of that at the stop", "1"},
              {"speed at the end", "m/s"}};
  const BucklingColumn column;
  for (const Trial& trial :
       {Trial{ColumnMethod::backward_euler, "backward Euler", 0.7},
        Trial{ColumnMethod::backward_euler, "backward Euler", 7},
        Trial{ColumnMethod::backward_euler, "backward Euler", 70},
        Trial{ColumnMethod::bdf2, "BDF2", 0.7}, Trial{ColumnMethod::bdf2, "BDF2", 7},
        Trial{ColumnMethod::bdf2, "BDF2", 70}}) {
    const double h = trial.step * column.elastic_limit();
    const int steps = std::clamp(int(0.15 / h), 300, 2500);
    const Shortening run = shorten(column, trial.method, h, steps);
    found.row(trial.words, trial.step, run.at_the_end / run.at_the_stop,
              run.largest_after / run.at_the_stop, run.speed);
  }
  return found;
}

Finding comes_to_rest(const Subject&) {
  return judge_worst(shortened_columns(), "energy at the end, of that at the stop", 1,
                     "nothing does work on a held column: an unstable method adds energy",
                     "one linear solve a step, no damping force");
}

Finding gains_on_the_way(const Subject&) {
  const Table found = shortened_columns();
  const double largest = found.worst("largest energy, of that at the stop");
  return {{1.5 / largest, 1, 0, "1", "half as much again is a gain that is seen"},
          found,
          "while the ends are still"};
}

}  // namespace

std::vector<Check> buckling_spring_checks() {
  return {
      {"bending.buckling-spring-has-an-energy",
       "The force of the buckling spring is the derivative of its energy.", source,
       force_is_the_energys},
      {"bending.buckling-springs-give-way-at-once",
       "A straight column of buckling springs gives way under any load, however far below Euler's.",
       source, gives_way_at_once},
      {"bending.buckling-columns-lose-energy-undamped",
       "An undamped column of buckling springs, shortened and then held, ends with no more energy "
       "than it was left with, in steps from below the elastic limit to far beyond.",
       source, comes_to_rest},
      {"bending.buckling-columns-gain-energy-on-the-way",
       "In some such steps the energy of a held column of buckling springs rises on the way.",
       source, gains_on_the_way}};
}

}  // namespace foldproof
