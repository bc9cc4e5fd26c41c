// Error and cost of a case over its step and its mesh, from a ladder in each: which pair is
// cheapest for a wanted error, and what an error that nobody has run would cost.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "convergence/any_case/converge.h"
#include "verification/verdict.h"

namespace foldproof {

/// A size relative to the case's own: at 1 the law is `as_it_is`; growth: the exponent.
struct PowerLaw {
  double as_it_is = std::numeric_limits<double>::quiet_NaN();
  double exponent = std::numeric_limits<double>::quiet_NaN();

  double at(double size) const;  // size > 0, over the case's own [1]
};

/// For a mean step h and edges dx, with r = h / step and s = dx / edge:
///   error      step_error(r) + mesh_error(s), over the motion [1]
///   cost       work * r^-work_by_step * s^-work_by_edge
/// The sum is an upper bound where the two errors are independent. That is checked once, on the
/// second-finest mesh: step_error_ratio.
struct ErrorMap {
  std::string scene, method;
  double step = 0, edge = 0;        // mean ones of the case as it is [s], [m]
  double motion = 0;                // the largest root mean square distance from the start [m]
  PowerLaw step_error, mesh_error;  // of positions, over the motion [1]
  double work = 0;                  // of the case as it is: LadderAnswer::cost [1]
  double work_by_step = 0, work_by_edge = 0;  // by how much it grows; exponents
  double seconds_by_work = 0;                 // of the processor, on the finest mesh [s]
  double particles = 0, particles_by_edge = 0;
  double longest_by_edge = 0;  // the step that the case's own rule allows grows as s to this power
  // the step's error on the second-finest mesh over that on the case's own [1]; NaN: not known
  double step_error_ratio = std::numeric_limits<double>::quiet_NaN();
  std::string reason;                 // why there is no map; "" if there is one
  std::vector<std::string> warnings;  // a sentence each

  double error(double h, double dx) const;    // over the motion [1]
  double seconds(double h, double dx) const;  // of the processor
  double longest_step(double dx) const;       // that the case's own rule would take [s]
};

/// The map of a ladder in time and one in space, of the same case, method and end. An error is
/// Richardson's estimate for the finest level, without a safety factor, and grows with the
/// observed order, at most the formal one. motion [m] > 0. There is no map where the positions of
/// a ladder have no order.
ErrorMap error_map(const LadderAnswer& in_time, const LadderAnswer& in_space, double motion);

/// A step and a mesh for a wanted error.
struct CheapestPair {
  double wanted = 0;        // over the motion [1]
  double step, edge;        // s, m; NaN: none between 8 times the case's edge and its 4096th part
  double particles;         // forecast
  double seconds;           // forecast, of the processor
  double halving_costs;     // cost for half the error, over this cost [1]
  bool is_limited_by_rule;  // the step is the longest that the case's own rule allows
};

CheapestPair cheapest_pair(const ErrorMap& map, double wanted);

/// The laws and the pairs, a line each; or why there is no map.
std::vector<std::string> map_in_words(const ErrorMap& map, const std::vector<CheapestPair>& pairs);

/// The study "converge.CASE.METHOD.map": the error over step and edge, lines of equal cost, the
/// cheapest pairs. Points whose step is longer than the case's own rule allows have no value.
StudyRecord map_study(const ErrorMap& map, const std::vector<CheapestPair>& pairs);

}  // namespace foldproof
