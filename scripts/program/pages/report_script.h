// Runs the scripts of reports/: pages, films, files for other programs.
#pragma once

#include <string>
#include <vector>

namespace foldproof {

/// Runs reports/<script> with Debian's Python and waits for it; an error names what it `makes`.
/// Returns its exit code: all_hold, or bad_input, which also stands for a script that cannot be run
/// or was killed. Only a script that `compares` runs may return some_fail.
int run_report_script(const std::string& makes, const std::string& script,
                      const std::vector<std::string>& arguments, bool compares = false);

/// Adds an option and its value; nothing if the value is empty.
void add_option(std::vector<std::string>& arguments, const std::string& option,
                const std::string& value);

}  // namespace foldproof
