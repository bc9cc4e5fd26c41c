// Which findings the sentence of each study rests on.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace foldproof {

/// Families of findings without which the study's sentence would not stand: the sentence is true if
/// all of them hold. A family is a finding's name after that of its study and the dot, or such a
/// name up to another dot: "exponent" is "elastic-limit.exponent.springs" and
/// "elastic-limit.exponent.bending". Empty for a study that is not of this suite.
std::vector<std::string_view> headline_families(std::string_view study);

/// Throws std::logic_error if a family of the study is none of these findings.
void require_headline_findings(const std::string& study, const std::vector<std::string>& findings);

}  // namespace foldproof
