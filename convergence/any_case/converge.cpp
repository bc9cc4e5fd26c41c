#include "convergence/any_case/converge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "convergence/work_precision/precision_problem.h"
#include "reference/dynamics/system.h"

namespace foldproof {

namespace {

/// Whole numbers at every level are counts, which have no rounding.
double value_floor(const std::vector<double>& values) {
  const bool is_count = std::ranges::all_of(values, [](double v) { return v == std::round(v); });
  return is_count ? 0 : rounding_floor(std::abs(values.back()));
}

double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += std::abs(value);
  return sum;
}

double mean_step_of(const LevelRun& run) {
  return run.step_ends.empty() ? nan : run.step_ends.back() / double(run.step_ends.size());
}

}  // namespace

QuantityOverLevels positions_over_levels(const Scene& scene, const std::vector<LevelRun>& runs,
                                         double formal_order) {
  const PerParticle mass = masses_of(scene);
  QuantityOverLevels over{"positions", "m", {}, {}, {}, nan};
  for (size_t k = 0; k + 1 < runs.size(); ++k)
    over.differences.push_back(field_difference(runs[k], runs[k + 1], mass));
  over.bar =
      error_bar({{}, over.differences, 2, formal_order, rounding_floor(longest_side(scene.x))});
  over.first_error = sum_of(over.differences) + over.bar.half_width;
  return over;
}

QuantityOverLevels value_over_levels(const Measurement& of, size_t m,
                                     const std::vector<LevelRun>& runs, double formal_order) {
  QuantityOverLevels over{of.name, unit_of(of), {}, {}, {}, nan};
  for (const LevelRun& run : runs) over.values.push_back(run.stopped.empty() ? run.values[m] : nan);
  for (size_t k = 0; k + 1 < over.values.size(); ++k)
    over.differences.push_back(over.values[k + 1] - over.values[k]);
  over.bar = error_bar({over.values, {}, 2, formal_order, value_floor(over.values)});
  over.first_error = std::abs(over.values.back() - over.values.front()) + over.bar.half_width;
  return over;
}

LadderAnswer ladder_answer(const Scene& scene, const std::string& in,
                           const std::vector<Measurement>& measurements,
                           const std::vector<LevelRun>& runs, double formal_order) {
  LadderAnswer answer{scene.name, scene.integrator, in, {}, {}, {}, {}, {}};
  for (const LevelRun& run : runs) {
    answer.work.push_back(operator_applications(run.work));
    answer.seconds.push_back(run.seconds);
    answer.stopped.push_back(run.stopped);
  }
  answer.mean_step = mean_step_of(runs.back());
  answer.formal_order = formal_order;
  answer.quantities.push_back(positions_over_levels(scene, runs, formal_order));
  for (size_t m = 0; m < measurements.size(); ++m)
    answer.quantities.push_back(value_over_levels(measurements[m], m, runs, formal_order));
  return answer;
}

std::vector<Measurement> measurements_of(const Case& input_case) {
  if (!input_case.quantities.empty()) return input_case.quantities;
  std::vector<std::string> expected;
  for (const Expectation& expectation : input_case.expectations)
    expected.push_back(expectation.key);
  return usual_measurements(input_case.scene, expected);
}

std::vector<double> divide_steps(const std::vector<double>& ends, double start, int parts) {
  std::vector<double> finer;
  for (const double end : ends) {
    for (int j = 1; j < parts; ++j) finer.push_back(start + (end - start) * j / parts);
    finer.push_back(end);
    start = end;
  }
  return finer;
}

Level time_level(const LadderPlan& plan, int k, const std::vector<double>& step_ends) {
  Level level{plan.input_case.scene.name + ", steps divided by " + std::to_string(1 << k),
              plan.input_case, plan.measurements, plan.input_case.scene.mesh.particles()};
  if (k > 0) level.input_case.scene.schedule.step.ends = divide_steps(step_ends, 0, 1 << k);
  return level;
}

LadderAnswer time_answer(const LadderPlan& plan, const std::vector<LevelRun>& runs,
                         double formal_order) {
  const Scene& scene = plan.input_case.scene;
  LadderAnswer answer = ladder_answer(scene, "time", plan.measurements, runs, formal_order);
  for (const LevelRun& run : runs) answer.sizes.push_back(mean_step_of(run));
  answer.particles.assign(runs.size(), scene.mesh.particles());
  return answer;
}

// The answer as evidence: curves of differences, tables, and a sentence.

namespace {

/// The words for a ladder in time or in space: its subject, its lengths, and their unit.
struct Refined {
  const char *what, *shortened, *unit;
};

Refined refined(const LadderAnswer& answer) {
  return answer.in == "time" ? Refined{"step", "steps", "s"} : Refined{"mesh", "edges", "m"};
}

/// Differences over `scale`, each at the size of its coarser level.
Curve curve_over_levels(const LadderAnswer& answer, const QuantityOverLevels& q, double scale) {
  Curve curve{q.name, {}, {}, nan, q.bar.orders, nan, range_marks(q)};
  for (size_t k = 0; k < q.differences.size(); ++k)
    curve.point(answer.sizes[k], std::abs(q.differences[k]) / scale);
  return curve;
}

Axis size_axis(const LadderAnswer& answer) {
  return {answer.in == "time" ? "mean step of the coarser level" : "size of the coarser level",
          refined(answer).unit, Scale::log};
}

constexpr const char* caption =
    "Each point is the difference between two neighbouring levels. Filled: the asymptotic range, "
    "in which neighbouring orders agree within 0.2. Hollow: outside it. The triangle is the order "
    "that the method promises.";

Figure positions_figure(const LadderAnswer& answer) {
  return {"positions",
          "Positions: difference between levels",
          size_axis(answer),
          {"largest root mean square difference", "m", Scale::log},
          answer.formal_order,
          caption,
          {curve_over_levels(answer, answer.quantities.front(), 1)}};
}

double largest_of(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values)
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  return largest;
}

/// Whether a logarithmic axis has a place for it.
bool can_be_drawn(const QuantityOverLevels& q) {
  return largest_of(q.differences) > 0 && largest_of(q.values) > 0;
}

Figure values_figure(const LadderAnswer& answer) {
  Figure figure{"quantities",
                "Quantities: relative difference between levels",
                size_axis(answer),
                {"difference over the largest value", "1", Scale::log},
                answer.formal_order,
                caption,
                {}};
  for (size_t k = 1; k < answer.quantities.size(); ++k)
    if (const QuantityOverLevels& q = answer.quantities[k]; can_be_drawn(q))
      figure.curves.push_back(curve_over_levels(answer, q, largest_of(q.values)));
  return figure;
}

/// The value down to the second digit of its bar.
std::string value_text(double value, double bar) {
  if (!std::isfinite(value)) return "\u2013";
  if (!(bar > 0) || !std::isfinite(bar)) return fmt::format("{:.6g}", value);
  const double digits = std::floor(std::log10(std::abs(value))) - std::floor(std::log10(bar)) + 2;
  return fmt::format("{:.{}g}", value, int(std::clamp(digits, 2.0, 12.0)));
}

Table quantities_table(const LadderAnswer& answer) {
  Table table("quantity; in; finest value; limit; error bar; error as it is; order [1]; reading");
  for (const QuantityOverLevels& q : answer.quantities)
    table.row(q.name, q.unit,
              value_text(q.values.empty() ? nan : q.values.back(), q.bar.half_width),
              value_text(q.bar.limit, q.bar.half_width), q.bar.half_width, q.first_error,
              q.bar.order, in_words(q.bar));
  return {"quantities", "Quantities, each in its unit", table};
}

Table levels_table(const LadderAnswer& answer) {
  Table table{
      {"level", "1"},          {answer.in == "time" ? "mean step" : "size", refined(answer).unit},
      {"particles", "1"},      {answer.work_name, "1"},
      {"processor time", "s"}, {"stopped", ""}};
  for (size_t k = 0; k < answer.sizes.size(); ++k)
    table.row(k + 1, answer.sizes[k], answer.particles[k], answer.work[k], answer.seconds[k],
              answer.stopped[k].empty() ? std::string("no") : answer.stopped[k]);
  if (!answer.clock.empty()) table.add({"by the clock, through the pipe", "s", answer.clock});
  return {"levels", "Levels, and their cost", table};
}

/// With a capital and a full stop. words: not empty.
std::string as_sentence(std::string words) {
  words[0] = char(std::toupper(words[0]));
  return words + ".";
}

/// From Richardson's law, error ~ size^order, and a cost that grows as between the finest levels.
std::string halved_by_order(const LadderAnswer& answer, double order) {
  const size_t last = answer.sizes.size() - 1;
  const double parts = std::pow(2, 1 / order);
  const double growth = std::log(answer.cost(last) / answer.cost(last - 1)) /
                        std::log(answer.sizes[last - 1] / answer.sizes[last]);
  return fmt::format(
      "{} {:.2f} times shorter ({:.2g} {}) halve that error, at {:.1f} times the work",
      refined(answer).shortened, parts, answer.sizes[0] / parts, refined(answer).unit,
      std::pow(parts, growth));
}

/// From the measured errors of the levels: each one's distance to the finest, and its bar.
std::string halved_by_level(const LadderAnswer& answer) {
  const QuantityOverLevels& positions = answer.quantities.front();
  double error = positions.bar.half_width;
  size_t coarsest = answer.sizes.size();  // of the levels that have halved it
  for (size_t k = answer.sizes.size(); k-- > 0;) {
    if (k < positions.differences.size()) error += positions.differences[k];
    if (error <= positions.first_error / 2) coarsest = k;
  }
  if (coarsest == answer.sizes.size()) return "no level of this ladder halves that error";
  return fmt::format("{} {} times shorter at least halve that error, at {:.1f} times the work",
                     refined(answer).shortened, 1 << coarsest,
                     answer.cost(coarsest) / answer.cost(0));
}

/// The last two, or the only one.
std::vector<double> last_two(const std::vector<double>& orders) {
  return {orders.end() - std::min<long>(2, long(orders.size())), orders.end()};
}

}  // namespace

std::string as_name(const std::string& words) {
  std::string name;
  for (const char letter : words)
    if (std::isalnum(static_cast<unsigned char>(letter)))
      name += letter;
    else if (!name.empty() && name.back() != '-')
      name += '-';
  while (name.ends_with('-')) name.pop_back();
  return name;
}

std::string how_to_halve(const LadderAnswer& answer) {
  const ErrorBar& bar = answer.quantities.front().bar;
  if (bar.reading == Reading::inconclusive) return "What halves that error is not known.";
  return as_sentence(bar.reading == Reading::asymptotic ? halved_by_order(answer, bar.order)
                                                        : halved_by_level(answer));
}

std::string_view name_of(OrderVerdict verdict) {
  constexpr std::string_view names[] = {"yes", "no", "cannot tell"};
  return names[size_t(verdict)];
}

OrderVerdict order_verdict(const LadderAnswer& answer) {
  const ErrorBar& bar = answer.quantities.front().bar;
  if (bar.reading == Reading::inconclusive || bar.may_settle) return OrderVerdict::cannot_tell;
  const double lacks = answer.formal_order - bar.order;
  if (bar.reading == Reading::asymptotic && lacks <= same_order) return OrderVerdict::yes;
  const std::vector<double> last = last_two(bar.orders);
  const bool comes_nearer = !(last.back() - last.front() < lacks / 4) || last.size() < 2;
  return comes_nearer ? OrderVerdict::cannot_tell : OrderVerdict::no;
}

bool may_settle(const LadderAnswer& answer) {
  const bool is_open = order_verdict(answer) == OrderVerdict::cannot_tell;
  return (is_open && answer.quantities.front().bar.reading != Reading::inconclusive) ||
         std::ranges::any_of(answer.quantities, [](const QuantityOverLevels& q) {
           return q.bar.may_settle && q.bar.reading == Reading::not_asymptotic;
         });
}

std::string order_in_words(const LadderAnswer& answer) {
  constexpr const char* ordinals[] = {"First", "Second", "Third", "Fourth"};
  const QuantityOverLevels& positions = answer.quantities.front();
  const ErrorBar& bar = positions.bar;
  const OrderVerdict verdict = order_verdict(answer);
  std::string words = fmt::format(
      "{} order: {}", ordinals[std::clamp(int(answer.formal_order), 1, 4) - 1], name_of(verdict));
  if (verdict == OrderVerdict::cannot_tell)
    words += ", because " +
             (bar.reason.empty() ? "the order still comes nearer to the method's" : bar.reason);
  else
    words += fmt::format(", the last orders are {:.2f}", fmt::join(last_two(bar.orders), " and "));
  if (std::isfinite(positions.first_error))
    words += fmt::format(". Your error is {:.2g} m at most", positions.first_error);
  return words + ". " + how_to_halve(answer);
}

std::string in_words(const LadderAnswer& answer) {
  const QuantityOverLevels& positions = answer.quantities.front();
  const ErrorBar& bar = positions.bar;
  if (std::isnan(bar.half_width))
    return fmt::format("No error can be stated for {} with method {}: {}.", answer.scene,
                       answer.method, bar.reason);
  const std::string first = fmt::format(
      "The {} of {} with method {} puts its positions off by {:.2g} m at most; the finest of {} "
      "levels has an error bar of {:.2g} m.",
      refined(answer).what, answer.scene, answer.method, positions.first_error, answer.sizes.size(),
      bar.half_width);
  if (bar.reading == Reading::inconclusive)
    return first + " That is a spread and no estimate: " + bar.reason + ".";
  if (bar.reading == Reading::asymptotic)
    return first + fmt::format(" Differences fall with order {:.2f}: asymptotic.", bar.order);
  return first +
         fmt::format(" The last order is {:.2f}, not asymptotic: {}.", bar.order, bar.reason);
}

std::vector<Mark> range_marks(const QuantityOverLevels& quantity) {
  std::vector<Mark> marks(quantity.differences.size(), Mark::unfinished);
  if (quantity.bar.reading != Reading::asymptotic) return marks;
  const std::vector<double>& orders = quantity.bar.orders;
  size_t first = orders.size() - 1;  // of the orders in the range
  while (first > 0 && std::abs(orders[first - 1] - orders[first]) <= same_order) --first;
  std::fill(marks.begin() + long(first), marks.end(), Mark::measured);
  return marks;
}

StudyRecord study_of(const LadderAnswer& answer, const std::string& predictable) {
  StudyRecord study;
  study.name = fmt::format("converge.{}.{}.in-{}", answer.scene, as_name(answer.method), answer.in);
  study.claim = in_words(answer) + " " + how_to_halve(answer);
  study.source = "Roache 1994; Celik et al. 2008";
  study.about = fmt::format(
      "The same case with its {} refined from level to level. The limit is Richardson's; the error "
      "bar belongs to the finest level and is the grid convergence index. The error as it is "
      "belongs to the first level, bar included.",
      refined(answer).what);
  if (!predictable.empty()) study.about += " " + as_sentence(predictable);
  for (const std::string& warning : answer.warnings) study.about += " " + as_sentence(warning);
  for (const double seconds : answer.seconds)
    if (std::isfinite(seconds)) study.seconds += seconds;
  study.figures = {positions_figure(answer)};
  if (Figure others = values_figure(answer); !others.curves.empty())
    study.figures.push_back(std::move(others));
  study.tables = {quantities_table(answer), levels_table(answer)};
  return study;
}

}  // namespace foldproof
