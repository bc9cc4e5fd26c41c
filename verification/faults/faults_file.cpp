#include "verification/faults/faults_file.h"

#include <algorithm>

#include "reference/scene/key_file.h"

namespace foldproof {

std::vector<Fault> read_faults(const std::string& path) {
  const auto root = parse_keys(read_text(path), path);
  std::vector<Fault> faults;
  for (const auto& row : root->tables("fault")) {
    Fault fault{row->text("name"),
                row->text("file"),
                row->text("find"),
                row->text("replace"),
                row->text("law"),
                {},
                {},
                "not run"};
    if (row->has("equivalent")) fault.outcome = "equivalent: " + row->text("equivalent");
    if (row->has("caught_by")) fault.caught_by = row->texts("caught_by");
    if (row->has("caught_by_tests")) fault.caught_by_tests = row->texts("caught_by_tests");
    for (const char* mark : {"fast", "loops", "crash"}) row->flag_or(mark, false);  // for the runner alone
    faults.push_back(std::move(fault));
  }
  root->refuse_unused();
  return faults;
}

void name_faults(const std::vector<Fault>& faults, std::vector<Record>& records) {
  for (Record& record : records)
    for (const Fault& fault : faults)
      if (std::find(fault.caught_by.begin(), fault.caught_by.end(), record.name) != fault.caught_by.end())
        record.faults.push_back(fault.name);
}

}  // namespace foldproof
