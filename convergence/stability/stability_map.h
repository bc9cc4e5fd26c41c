// The largest stable step of a sheet over damping and resolution: maps of the study stability-sheet.
#pragma once

#include "verification/subject.h"

namespace foldproof {

/// For two stiffnesses of the springs and for A, B, C and classical Runge-Kutta 4: a map, and a finding that
/// it is what the oscillator of the fastest mode says. The damping is the same material on all meshes.
void add_stability_maps(const Subject& subject, Tier tier, StudyResult& result);

}  // namespace foldproof
