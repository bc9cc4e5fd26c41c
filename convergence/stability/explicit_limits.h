// What damping does to the step of fully explicit methods as the cells become small: a part of
// stability-sheet.
#pragma once

#include <string>
#include <vector>

#include "verification/subject.h"

namespace foldproof {

/// Which damping a sheet has: constants of the material.
struct Damping {
  std::string name, words;
  double springs, bending;  // kd_s [N s/m], kd [N s]
};

std::vector<Damping> dampings();  // of springs, of bending, of both

/// The largest rate of damping under refinement: two exponents and a figure.
void add_refinement(const Subject& subject, Tier tier, StudyResult& result);

/// The paper's example, cells of a tenth: steps counted out and confirmed by stepping.
void add_tenth(const Subject& subject, Tier tier, StudyResult& result);

}  // namespace foldproof
