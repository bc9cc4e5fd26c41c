#include "scripts/program/any_case/converge_file.h"

#include "scripts/program/provenance.h"
#include "verification/files/results_file.h"

namespace foldproof {

void write_studies(const std::string& path, std::vector<StudyRecord> studies,
                   const std::string& command) {
  RunRecord run;
  run.provenance = provenance(command);
  for (const StudyRecord& study : studies) run.seconds += study.seconds;
  run.studies = std::move(studies);
  write_run(path, run);
}

}  // namespace foldproof
