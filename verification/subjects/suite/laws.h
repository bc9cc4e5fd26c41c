// The portable suite: laws of cloth, asked of any solver.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "verification/subjects/suite/trial.h"
#include "verification/verdict.h"

namespace foldproof {

/// A law: true of every solver, whatever its scheme. Its bound is made of the declared precision,
/// order and tolerance. `run` throws NotOffered where the solver lacks what the law asks.
struct Law {
  std::string name, claim, source;
  std::function<Finding(Trial&)> run;
};

/// Smoke laws first.
std::vector<Law> portable_laws();

std::vector<Law> motion_laws();       // smoke, rest, inertia, gravity, momentum, held particles
std::vector<Law> symmetry_laws();     // translation, rotation, mirror, numbering
std::vector<Law> repeat_laws();       // determinism, state, order, precision
std::vector<Law> force_laws();        // level 2: sums, weight, energy
std::vector<Law> damping_laws();      // dampers in the motion, and as level 2 states them
std::vector<Law> calibration_laws();  // effective moduli
std::vector<Law> vibration_laws();    // period and decay
std::vector<Law> stability_laws();    // the largest step
std::vector<Law> game_step_laws();    // a step of 1/60 s
std::vector<Law> cost_laws();         // growth with the number of particles
std::vector<Law> cantilever_laws();   // a heavy strip at rest
std::vector<Law> bent_strip_laws();   // loops, rings and wrinkles of a heavy strip
std::vector<Law> buckling_laws();     // an upright strip falls over
std::vector<Law> tipping_laws();      // a strip on edge tips sideways
std::vector<Law> drape_laws();        // a ring of cloth around a plate
std::vector<Law> wrinkle_laws();      // waves of a stretched sheet
std::vector<Law> chain_laws();        // a limp strip between two points
std::vector<Law> contact_laws();      // capability "planes": resting, friction
std::vector<Law> fall_laws();         // obstacles of each kind give a sheet no energy
std::vector<Law> ball_laws();         // capability "spheres": depth, rest, friction
std::vector<Law> floor_laws();        // capability "planes": a strip that is pressed on a floor
std::vector<Law> fold_laws();         // capability "planes": a strip folded over on a floor
std::vector<Law> capstan_laws();      // capability "capsules": a strip over one, and when it slips
std::vector<Law> self_collision_laws();  // capability "self_collision"
std::vector<Law> tunnelling_laws();  // capability "boxes": a thin one stops what is thrown at it

/// The outcome of a trial.
struct Judgement {
  Declaration declaration;  // unset if the solver never started
  std::vector<std::pair<std::string, std::string>> mapping;
  std::vector<Record> records;  // one a law
  bool smoke_holds = false;
};

/// Asks the laws; a failure of the solver is the finding of its law, and the next one goes on.
/// After one that ends the trial, the others have no outcome.
/// Throws InputError if there is no such program.
///   done   is called after each law
Judgement judge_solver(const SolverCommand& command, const std::vector<Law>& laws,
                       const std::function<void(const Record&)>& done);

}  // namespace foldproof
