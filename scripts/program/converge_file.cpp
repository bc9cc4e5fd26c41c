#include "scripts/program/converge_file.h"

#include "convergence/any_case/ladder_study.h"
#include "scripts/program/provenance.h"
#include "verification/files/results_file.h"

namespace foldproof {

void write_answers(const std::string& path, const std::vector<LadderAnswer>& answers,
                   const std::string& command) {
  RunRecord run;
  run.provenance = provenance(command);
  for (const LadderAnswer& answer : answers) {
    run.studies.push_back(study_of(answer));
    run.seconds += run.studies.back().seconds;
  }
  write_run(path, run);
}

}  // namespace foldproof
