// Reads the claims: verification/claims/PAPER.toml, one file per paper.
#pragma once

#include <string>
#include <vector>

#include "verification/claims/claims.h"

namespace foldproof {

/// The claims of every *.toml in the folder: papers in the order of file names, claims in the order
/// of their file. The keys are explained at the top of bmf03.toml. Throws InputError
///   - "file:line: ..." for an unknown key, role or ruling; a missing or empty text; a duplicate or
///     invalid id; a claim that neither has deciders nor says what is missing, or does both; one
///     that names a finding twice; a condition where the recorded ruling is not conditional, or
///     none where it is; a placeholder whose brace is not closed;
///   - "file: ..." for a file without [paper] or without claims;
///   - "folder: ..." for a folder without such files.
std::vector<Claim> read_claims(const std::string& folder);

/// A name for each of its alternatives: "fall.{x,y}" stands for "fall.x" and "fall.y".
std::vector<std::string> choices_of(const std::string& name);

}  // namespace foldproof
