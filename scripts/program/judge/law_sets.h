// Frozen sets of laws: a set names laws, and is the same for as long as a program carries it.
#pragma once

#include <string>
#include <vector>

#include "verification/subjects/suite/laws.h"

namespace foldproof {

struct FrozenLaw {
  std::string name, scenes;  // scenes: hash of what a solver that never moves is sent
  std::string bound;         // that the law sets the reference, with its unit; "" if it sets none
};

/// verification/subjects/law_sets/NAME.tsv. Throws InputError that names the known sets.
std::vector<FrozenLaw> read_law_set(const std::string& name);

/// The newest set of the program; "" if it has none.
std::string newest_law_set();

/// The laws as they are now; bounds stay empty. Starts this program once a law.
std::vector<FrozenLaw> scenes_of(const std::vector<Law>& laws);

/// The text of a set of all laws as they are now, with the bounds of the reference.
std::string law_set_text(const std::string& name);

/// A chosen set, and how its laws differ from the program's.
struct LawSetUse {
  std::string name;
  std::vector<std::string> changed, gone;  // of the set: other scenes now; no such law any more
};

/// Keeps of `laws` those of the set.
LawSetUse keep_laws_of_set(const std::string& name, std::vector<Law>& laws);

/// "laws 2026.1: 170 laws, as frozen", or which of them are not.
std::string text_of(const LawSetUse& use, size_t laws);

}  // namespace foldproof
