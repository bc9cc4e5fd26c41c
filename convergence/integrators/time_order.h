// Order studies in time: errors in x and v against an oracle, with constant steps and with
// sequences that vary.
#pragma once

#include "reference/dynamics/integrator.h"
#include "verification/oracles/cloth.h"
#include "verification/subject.h"
#include "convergence/study.h"

namespace foldproof {

/// How the lengths of the steps of a run follow one another.
struct StepPattern {
  std::string_view name;   // part of the findings' names
  std::string_view words;  // "alternating steps 9:1"
  // the pattern, repeated to the end: lengths in units of their mean [1]
  std::vector<double> relative;
};

/// constant; alternating 9:1; random (8 steps, fixed once for all, at most 9:1).
///
/// A finer level has every step of the coarser halved and the pattern repeated twice as often, so
/// that neighbouring steps differ in length at every level. (Halving each step in place would make
/// runs of equal steps, on which a method that needs a constant step could pass.)
std::vector<StepPattern> step_patterns();

/// constant; alternating 2:1; random, at most 2:1: for methods that restrict the growth
/// of their steps.
std::vector<StepPattern> gentle_step_patterns();

/// The steps [s] of a run from 0 to `end` [s] with `count` steps, which must be a multiple of the
/// pattern's length, else InputError.
std::vector<double> steps_of(const StepPattern& pattern, double end, int count);

/// A method, and the numbers of steps at which its order is observed.
struct ObservedMethod {
  const Integrator& integrator;
  std::vector<StepPattern> patterns;
  int coarsest;  // number of steps of the first level, a multiple of 8
  int levels;    // each has twice the steps of the one before
};

/// The paper's schemes, each with all step_patterns().
std::vector<ObservedMethod> paper_methods(int coarsest, int levels);

/// A motion whose end is known from elsewhere.
struct OrderProblem {
  std::string study;        // the name of the study
  std::string description;  // "the driven hinge"
  Scene scene;              // its integrator is replaced by each of the methods
  double end;               // s
  std::vector<ObservedMethod> methods;
  oracles::ClothState truth;  // at the end
  double uncertainty;         // of every component of truth [m], [m/s]
};

/// Runs everything: a finding per method, pattern and quantity, one on B with variable steps,
/// figures of the paper's schemes and of the other methods, a table.
StudyResult time_order(const Subject& subject, const OrderProblem& problem,
                       const Progress& progress);

}  // namespace foldproof
