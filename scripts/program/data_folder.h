// Where the program's own data lie: cases, claims, faults and the report generator.
#pragma once

#include <string>

namespace foldproof {

/// The folder that holds cases/, reports/ and verification/: share/foldproof beside the folder of
/// an installed program, wherever that was moved to, else the source tree of the build. Nothing is
/// ever written there. Throws InputError if it is in neither place.
std::string data_folder();

/// How to call this program in a message: "foldproof" if it is installed, else "build/foldproof".
std::string program_command();

}  // namespace foldproof
