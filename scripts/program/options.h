// Options that several commands have; a struct derived from Options adds those of one command.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scripts/program/jobs.h"
#include "verification/verdict.h"

namespace foldproof {

constexpr int all_hold = 0, some_fail = 1, bad_input = 2;  // exit codes

struct Options {
  std::string command;             // as typed, for the record of a run
  std::vector<std::string> words;  // as typed, the program's name first
  std::string out = "results", tier = "quick", file;
  std::vector<std::string> names, overrides;
  std::string cache;                // folder that keeps level sets; none if empty
  unsigned seed_shift = 0;          // of check, study and verify (verification/seeds.h)
  JobSettings running;              // of check, study and verify; threads: of simulate, too
  int levels = 0;                   // of converge: runs; 0: usual_levels and more
  double budget = 30;               // of converge: for levels that are added [s]
  int mesh_levels = 2;              // of ablate: meshes
  double hours = 0;                 // of converge: of the clock, for all runs; 0: no limit
  std::string frames, times;        // of compare, judge: folder or cache, a file of times
  double rate = 0, first_time = 0;  // of compare, judge: frames a second, time of the first one [s]
  double fraction = 0.1;            // of converge: of the motion, at which twin runs have parted
  int ensemble = 4;                 // of converge: runs with disturbed starts; 0: none
  std::vector<std::string> methods;  // of converge and precision: integrators
  std::string in = "time";           // of converge: time, space or both
  bool refines_objects = false;      // of converge: level sets with the cloth
  // of converge and precision: how much of the run is asked [s]; 0: all of it
  double until = 0;
  std::vector<std::string> errors = {"1e-2", "1e-3"};  // of precision: wanted, as typed [1]
  double effort = 1;         // of precision: largest work of a run over the usual budget [1]
  std::string solver, name;  // of judge, subject, converge: command; of judge: name in the report
  std::vector<std::string> settings;  // of a solver, KEY=VALUE
  std::string baseline;               // of judge: a kept verdicts.json, or empty
  double patience = 60;               // of judge, subject: limit of silence [s]
  double total_seconds = 0;           // of judge: of the clock; 0: no limit
  double law_seconds = 0;             // of judge: of a law; 0: no limit
  std::vector<std::string> skipped;   // of judge: laws, groups or beginnings of names
  std::string dump;                   // of judge: folder for scenes and answers; none if empty
  std::string engine = "local", engine_options, scratch;  // of campaign
  int slice = 0;  // of campaign: jobs a slice, 0: as the engine likes; of work: number of the slice
  bool json = false, resumes = false, restarts = false;
};

/// The words that were typed, and what they ask for.
struct Program {
  std::string command;             // for the record of a run
  std::vector<std::string> words;  // the program's name first
  std::function<int()> run;        // the command; returns the exit code
};

inline Tier tier_of(const Options& options) {
  return options.tier == "full" ? Tier::full : Tier::quick;
}

}  // namespace foldproof
