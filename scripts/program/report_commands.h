// What the scripts of reports/ do: pages, films, files for other programs.
#pragma once

#include <string>
#include <vector>

namespace foldproof {

/// Runs reports/<script> with Debian's Python and waits for it; an error names what it `makes`.
/// Returns its exit code: all_hold, or bad_input, which is also what a script that cannot be run,
/// or that was killed, comes to.
int run_report_script(const std::string& makes, const std::string& script,
                      const std::vector<std::string>& arguments);

}  // namespace foldproof
