#pragma once

#include <string>

#include "verification/files/results_file.h"

namespace foldproof {

/// Of this program, this machine and this moment. command: what was typed.
Provenance provenance(const std::string& command);

/// The program as far as its bits depend on it: version, commit, and a key of the code that runs.
std::string program_identity();

/// The source tree that the program was built from; it may be gone.
std::string source_folder();

}  // namespace foldproof
