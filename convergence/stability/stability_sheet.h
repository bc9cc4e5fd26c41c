// Parts of the study stability-sheet: limits of explicit methods, and maps over damping and mesh.
#pragma once

#include "convergence/study.h"
#include "verification/subject.h"

namespace foldproof {

// Effect of damping on the step of fully explicit methods as the cells become small: a part of
// stability-sheet.

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

// The largest stable step of a sheet over damping and resolution: maps of the study
// stability-sheet.

/// For two stiffnesses of the springs and for A, B, C and classical Runge-Kutta 4: a map, and a
/// finding that it is what the oscillator of the fastest mode says. The damping is the same
/// material on all meshes.
void add_stability_maps(const Subject& subject, Tier tier, StudyResult& result);

}  // namespace foldproof
