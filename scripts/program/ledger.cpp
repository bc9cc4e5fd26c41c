#include "scripts/program/ledger.h"

#include <fmt/format.h>

#include <algorithm>

#include "reference/types.h"
#include "scripts/program/progress.h"

namespace foldproof {

namespace {

void add_ruled(const Claim& claim, RunRecord& run) {
  run.claims.push_back(rule_claim(claim, run.records));
  const ClaimRecord& record = run.claims.back();
  if (outcome_of(record) == Outcome::fails)
    log_line(fmt::format("  claim {}: {}, where {} is recorded", claim.id, name_of(record.ruling),
                         name_of(claim.recorded)));
}

bool is_made_by_a_study(const std::string& finding, const RunRecord& run) {
  return std::any_of(run.studies.begin(), run.studies.end(), [&](const StudyRecord& study) {
    return finding.starts_with(study.name + ".");
  });
}

bool is_in(const std::string& finding, const RunRecord& run) {
  return std::any_of(run.records.begin(), run.records.end(),
                     [&](const Record& record) { return record.name == finding; });
}

}  // namespace

void rule_all_claims(const std::vector<Claim>& claims, RunRecord& run) {
  for (const Claim& claim : claims) add_ruled(claim, run);
}

void rule_covered_claims(const std::vector<Claim>& claims, RunRecord& run) {
  for (const Claim& claim : claims)
    if (is_covered(claim, run.records)) add_ruled(claim, run);
}

void reject_claims_of_lost_findings(const std::vector<Claim>& claims, const RunRecord& run) {
  for (const Claim& claim : claims)
    for (const std::string& finding : findings_named_in(claim))
      if (claim.recorded != Ruling::undecided && is_made_by_a_study(finding, run) &&
          !is_in(finding, run))
        throw InputError(fmt::format(
            "claim {} names the finding '{}', which its study does not make", claim.id, finding));
}

void reject_faults_of_lost_findings(const std::vector<Fault>& faults, const RunRecord& run) {
  for (const Fault& fault : faults) {
    if (fault.is_of_full_tier && run.tier != "full") continue;
    for (const std::string& finding : fault.caught_by)
      if (is_made_by_a_study(finding, run) && !is_in(finding, run))
        throw InputError(fmt::format(
            "fault {} names the finding '{}', which its study does not make", fault.name, finding));
  }
}

}  // namespace foldproof
