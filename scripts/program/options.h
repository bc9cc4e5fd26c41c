// The command line options.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "scripts/program/jobs.h"
#include "verification/verdict.h"

namespace foldproof {

constexpr int all_hold = 0, some_fail = 1, bad_input = 2;  // exit codes

struct Options {
  std::string command;             // as typed, for the record of a run
  std::vector<std::string> words;  // as typed, the program's name first
  std::string out = "results", tier = "quick", file, rest_file;
  std::vector<std::string> names, overrides;
  std::string log;                 // of history: file of JSON lines
  std::string paper;               // of claims: key of a paper, or empty for all
  bool as_cloth = false;           // of inspect: as a cloth, not as a body
  std::string cache;               // folder that keeps level sets; none if empty
  std::string map, rule = "loop";  // of project: a depth map, a rule of subdivision
  double reach = 0, eps = 0;       // of project [m]
  // of project [m]; NaN: the deepest in the run
  double deepest = std::numeric_limits<double>::quiet_NaN();
  std::string kind;                 // of list; of evaluate crossings: of pair; of export: of file
  std::string field, size, fps;     // of film: as its script takes them
  double keep = 1e-6;               // of evaluate crossings [m]
  int count = 10;                   // of golden: rows
  unsigned seed = 1;                // of golden
  unsigned seed_shift = 0;          // of check, study and verify (verification/seeds.h)
  JobSettings running;              // of check, study and verify; threads: of simulate, too
  int cells = 64;                   // of inspect: along the longest side
  int subdivisions = 0;             // of project
  int smooth_levels = 1;            // of smooth
  int levels = 4;                   // of converge: runs
  int mesh_levels = 2;              // of ablate: meshes
  double hours = 0;                 // of converge: of the clock, for all runs; 0: no limit
  std::string frames, times;        // of compare, judge: a folder, a file of times
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
  std::vector<std::string> settings;               // of a solver, KEY=VALUE
  std::string baseline;                            // of judge: a kept verdicts.json, or empty
  double patience = 60;                            // of judge, subject: limit of silence [s]
  double total_seconds = 0;                        // of judge: of the clock; 0: no limit
  std::string integrator = "C", precision = "f8";  // of serve
  std::string engine = "local", engine_options, scratch;  // of campaign
  int slice = 0;  // of campaign: jobs a slice, 0: as the engine likes; of work: number of the slice
  bool json = false, quick = false, no_report = false, no_bench = false, resumes = false,
       restarts = false, pdf = false, papers = false, summary = false, one_file = false;
  int (*run)(const Options&) = nullptr;  // the command; returns the exit code
};

inline Tier tier_of(const Options& options) {
  return options.tier == "full" ? Tier::full : Tier::quick;
}

}  // namespace foldproof
