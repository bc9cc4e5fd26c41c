// Parts of the study work-precision: every method on every motion, what is read from it.
#pragma once

#include <string_view>

#include "convergence/study.h"
#include "convergence/work_precision/precision_curve.h"
#include "convergence/work_precision/precision_problem.h"
#include "verification/subject.h"

namespace foldproof {

/// Methods on the slow motion that remains under heavy damping. An overdamped oscillator creeps
/// home at a rate near k/c. The rate under A, B and C against the step: a figure, that A keeps its
/// second order, and that C has the error derived above its definition.
void add_slow_motion(const Subject& subject, StudyResult& result);

/// One motion, what is known of it, and every method on it. Errors are the largest component of the
/// position error at the end, seconds the least of a few repeats.
struct PrecisionScene {
  PrecisionProblem problem;
  PrecisionTruth truth;
  std::vector<PrecisionCurve> curves;  // in the order of the table of integrators
};

/// The errors that are asked for, over the motion [1].
constexpr std::array<double, 2> wanted_errors = {0.01, 0.001};

/// The method of a scene by its name; InputError if it has not run.
const PrecisionCurve& curve_of(const PrecisionScene& scene, std::string_view method);

/// The price of the wanted error with this method.
inline Price price_of(const PrecisionScene& scene, const PrecisionCurve& curve, double wanted) {
  return price_at(curve, scene.problem.end, wanted);
}

/// A cost that methods are compared by.
struct Currency {
  std::string name;
  double Price::*cost;
};

const std::array<Currency, 2> currencies = {
    {{"work", &Price::applications}, {"seconds", &Price::seconds}}};

/// The cheapest method of a scene at a wanted error; those tied with it, which cost less than it
/// does times the ratio of two steps that were tried: runs that far apart do not tell them from the
/// cheapest; the next one, which is the cheapest of the others; and scheme C.
struct Podium {
  std::string first = "none", second = "none";
  Price best, next, scheme_C;
  std::vector<size_t> contenders;  // curves of the cheapest, of those tied with it, and of the next
};

Podium podium(const PrecisionScene& scene, double wanted, const Currency& currency);

std::vector<NamedFinding> precision_findings(const std::vector<PrecisionScene>& scenes);

/// Error against step, work and seconds of one scene.
std::vector<Figure> precision_figures(const PrecisionScene& scene);

/// Which method is cheapest; every method's price; which steps last; every run.
std::vector<Table> precision_tables(const std::vector<PrecisionScene>& scenes);

}  // namespace foldproof
