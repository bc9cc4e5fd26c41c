// Parts of the study artificial-damping: long vibrations and their trend, damping of
// one part alone.
#pragma once

#include <vector>

#include "convergence/damping/sheet_modes.h"
#include "convergence/study.h"
#include "verification/subject.h"

namespace foldproof {

// A hundred periods of a crumpling sheet that nothing damps: what becomes of its energy.

/// Adds findings, figures and tables to the study artificial-damping: energy at equal step and at
/// equal cost, trends of the schemes that should have none.
void add_long_vibrations(const Subject& subject, Tier tier, StudyResult& result);

// Damping of one kind of motion, the other kind free: does a method leave the free one alone?

/// Adds findings and a table to the study artificial-damping.
void add_one_sided_damping(const Subject& subject, const VibratingSheet& sheet,
                           StudyResult& result);

// Does a quantity that fluctuates drift? Its slope in time, and how far chance alone may tilt it.

struct Trend {
  double slope = 0;  // of the quantity, by least squares over the blocks [unit/unit of time]
  double error = 0;  // its standard error
  std::vector<double> times;  // middles of the blocks
  std::vector<double> means;  // of the quantity over each block
};

/// Averages the samples over `blocks` equal spans of time, so that what is correlated within a
/// block counts once, and fits a line. The standard error comes from the scatter about the line,
/// enlarged by sqrt((1 + r)/(1 - r)) where neighbouring blocks are still correlated, r > 0 being
/// the lag-one correlation of the scatter. Times must ascend, one for each value, and there must be
/// a sample in every block, else InputError.
Trend trend_of(const std::vector<double>& times, const std::vector<double>& values, int blocks);

/// At most some 500 of the values, evenly chosen.
std::vector<double> thin_out(const std::vector<double>& values);

}  // namespace foldproof
