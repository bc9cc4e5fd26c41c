#include "scripts/program/any_case/solver_runs.h"

#include <cmath>

#include "scripts/program/progress.h"

namespace foldproof {

std::vector<LevelRun> run_solver(SolverLadder& ladder, int levels) {
  std::vector<LevelRun> runs;
  ProgressLine line("levels of the solver");
  const double all = std::exp2(levels) - 1;  // if each takes twice the one before
  for (int k = 0; k < levels; ++k) {
    runs.push_back(ladder.run(k));
    if (k == 0 && !runs[0].stopped.empty())
      throw InputError("the solver comes to no end with the case's own step: " + runs[0].stopped);
    line.show((std::exp2(k + 1) - 1) / all);
  }
  return runs;
}

}  // namespace foldproof
