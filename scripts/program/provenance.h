#pragma once

#include <string>

#include "verification/files/results_file.h"

namespace foldproof {

/// Of this program, this machine and this moment. command: what was typed.
Provenance provenance(const std::string& command);

/// The program as far as its bits depend on it: version, commit, and a key of the code that runs.
std::string program_identity();

/// The folder with cases, reports and the list of faults.
std::string project_folder();

}  // namespace foldproof
