// A ladder's answer as evidence: curves of differences, tables, and a sentence.
#pragma once

#include "convergence/any_case/converge.h"
#include "verification/verdict.h"

namespace foldproof {

/// How large the error of the case as it stands is, in one or two sentences.
std::string in_words(const LadderAnswer& answer);

/// Letters, digits and hyphens, as names of studies have them.
std::string as_name(const std::string& words);

/// Says how to halve the error of the positions, and at which price. In the asymptotic range, steps
/// (edges) are divided by 2^(1/order), and the cost grows as between the two finest levels. Outside
/// it, the sentence names the first level whose measured error is at most half of the first one's,
/// or says that no level does, or that nothing is known.
std::string how_to_halve(const LadderAnswer& answer);

/// One mark a difference of the quantity: measured in the asymptotic range, which ends at the
/// finest pair and reaches back as long as neighbouring orders agree within same_order; unfinished
/// (drawn hollow) outside it.
std::vector<Mark> range_marks(const QuantityOverLevels& quantity);

/// The study "converge.CASE.METHOD.in-time" (or in-space): positions and all other quantities over
/// the levels, in figures with the method's order as their slope; quantities with order, limit, bar
/// and reading, and levels with their cost, in tables. predictable: how long the positions are, in
/// words; "" if nobody asked.
StudyRecord study_of(const LadderAnswer& answer, const std::string& predictable = {});

}  // namespace foldproof
