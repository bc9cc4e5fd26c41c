// Ruling the claims of papers from a run.
#pragma once

#include <vector>

#include "verification/files/results_file.h"

namespace foldproof {

/// Rules every claim. Throws std::runtime_error naming a claim whose text asks for a number
/// that the run lacks.
void rule_all_claims(const std::vector<Claim>& claims, RunRecord& run);

/// Rules the claims all of whose findings are in the run.
void rule_covered_claims(const std::vector<Claim>& claims, RunRecord& run);

/// For a run of all studies: throws InputError if a decided claim names a finding of a study that
/// the study does not make.
void reject_claims_of_lost_findings(const std::vector<Claim>& claims, const RunRecord& run);

/// For a run of all studies: throws InputError if a fault names a finding of a study that the study
/// does not make; of a fault of the full tier, in that tier only. (Names of checks and cases are
/// known without a run: scripts/tests/test_names.py.)
void reject_faults_of_lost_findings(const std::vector<Fault>& faults, const RunRecord& run);

}  // namespace foldproof
