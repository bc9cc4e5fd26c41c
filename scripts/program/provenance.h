#pragma once

#include <string>

#include "verification/files/results_file.h"

namespace foldproof {

/// Of this program, this machine and this moment. command: what was typed.
Provenance provenance(const std::string& command);

/// The program as far as its bits depend on it: version, commit, and a key of the code that runs.
std::string program_identity();

/// 32 hexadecimal digits of the file of the program: another build, another digest.
std::string program_digest();

/// The commit that it was built from.
std::string program_commit();

/// Now, as 2026-01-31T12:00:00Z.
std::string provenance_date();

/// The file of the program that runs.
std::string program_file();

/// The source tree that the program was built from; it may be gone.
std::string source_folder();

}  // namespace foldproof
