// A table of runs that any simulator made with other settings.
#pragma once

#include <string>
#include <vector>

#include "convergence/any_case/settings_report.h"

namespace foldproof {

/// The map of the runs in a CSV file without quotes. Columns: one or two tunables, whose names say
/// their kind ("iterations", "tolerance"; else substeps); `frames`, a folder or a cache as
/// read_mesh_frames reads it, relative to the table; optionally `seconds`, the cost. A row whose
/// first cell is "truth" holds the frames of the converged answer. z is up. at: the values in use;
/// empty: those of the first row. Throws InputError naming the file and line.
SettingsAnswer settings_answer_of_table(const std::string& file, const std::vector<double>& at,
                                        const std::vector<double>& wanted);

}  // namespace foldproof
