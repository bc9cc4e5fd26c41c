// A claim of a paper, and the rule for deciding it from findings. The claims themselves are data:
// see read_claims.h.
#pragma once

#include <string>
#include <vector>

#include "verification/verdict.h"

namespace foldproof {

/// Effect of a finding on a claim when it holds.
enum class Role {
  supports,    // the claim needs it
  limits,      // it shows a condition that the claim needs
  contradicts  // it refutes the claim as stated in the paper
};

enum class Ruling { confirmed, conditional, refuted, undecided };

std::string_view name_of(Role role);  // "supports", "limits", "contradicts"
// "confirmed", "confirmed under a condition", "refuted", "undecided"
std::string_view name_of(Ruling ruling);

/// A finding's name and its effect on the claim.
struct Decider {
  std::string finding;
  Role role;
  bool only_in_full_tier = false;  // of a long case: a run without it leaves the claim undecided
};

/// Where in its section the paper says it, to be found on the page.
struct Citation {
  int paragraph = 0;   // of the section, counted from 1; lists and formulas belong to it
  std::string begins;  // the first words of the sentence; empty (and 0) if it was not looked up
  // a formula as printed and as it must read; empty where they agree
  std::string printed, restored;
};

/// A sentence of a paper, in our words.
struct Claim {
  std::string paper;        // its key: "BMF03"
  std::string id, section;  // section: where the paper says it
  std::string statement;
  std::vector<Decider> decided_by;
  // the ruling found by the authors of this suite; a run with a different ruling fails
  Ruling recorded;
  std::string condition;  // in words, if recorded as conditional; else empty
  std::string why;        // a paragraph with placeholders for its numbers, see filled()
  Citation cited = {};
  // recorded as undecided without deciders: what a ruling needs and this suite lacks. Of a ruled
  // claim: the findings of the full tier that the run lacks. Else empty
  std::string missing = "";
  std::string paper_title = "";  // with its year
};

/// "BMF03 section 3.1", or "BFA02, abstract" where the part of the paper has no number.
std::string place_of(const Claim& claim);

/// Ruling of a claim in one run.
struct ClaimRecord {
  Claim claim;  // with the placeholders of condition and why filled
  // of the deciders, in their order; "missing" if the run has none
  std::vector<std::string> outcomes;
  Ruling ruling;
};

/// The ruling from these findings; see the table above its definition.
Ruling ruling(const std::vector<Decider>& deciders, const std::vector<Record>& records);

/// The text with each placeholder replaced by a number of the run: three significant digits, in
/// scientific notation for very small or large numbers, and its unit:
///   {name}                    what the finding measured
///   {name|bound}              its bound
///   {name|column|row}         evidence: a row counted from 1, "first", "last", "smallest",
///                             "largest", or the entry that stands in that row of the finding's
///                             first column of texts
///   {bare: one of these}      without its unit, where the text says what is counted
///   {largest of: a, b, ...}   the largest of several of these, which must have the same unit;
///                             also bare
/// Throws std::runtime_error naming the placeholder if the run has no such number.
std::string fill_placeholders(const std::string& text, const std::vector<Record>& records);

/// The findings that the placeholders of a text refer to. Throws std::runtime_error for a brace
/// that is not closed.
std::vector<std::string> findings_in_text(const std::string& text);

/// The findings that a claim rests on or takes numbers from; some more than once.
std::vector<std::string> findings_named_in(const Claim& claim);

/// True if the run contains all findings that the claim names, and it names some.
bool is_covered(const Claim& claim, const std::vector<Record>& records);

/// Decides a claim. The text of an undecided claim keeps placeholders whose number is missing.
/// Throws std::runtime_error naming the claim for a placeholder that cannot be filled otherwise.
ClaimRecord rule_claim(const Claim& claim, const std::vector<Record>& records);

/// holds if the ruling is the recorded one, fails if not; inconclusive if both are undecided, or if
/// it waits for the full tier.
Outcome outcome_of(const ClaimRecord& record);

/// Undecided for a reason that the claim states: no run can decide it.
bool is_out_of_reach(const ClaimRecord& record);

/// Undecided because findings are missing that only the full tier has; the others rule as recorded.
bool waits_for_full_tier(const ClaimRecord& record);

}  // namespace foldproof
