// The keys of a campaign's jobs: a digest of everything that a job's result depends on.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "convergence/campaigns/campaign.h"
#include "convergence/campaigns/wide_key.h"

namespace foldproof {

/// A key is of the command, the program's code, the case text, the files that the case or a
/// parameter names, the campaign's [[quantity]] tables, and the sorted assignments. Names and
/// places of files do not count, their content does; neither do limits, and what is kept.
class JobKeys {
 public:
  ///   program     digest of its code
  ///   find_case   the file of a case, as a campaign names it; throws InputError if there is none
  JobKeys(const Campaign& campaign, const std::string& program,
          std::function<std::string(const std::string&)> find_case);

  /// set: sorted by key. Throws InputError for a case or a file that cannot be read.
  std::string key_of(const std::vector<Assignment>& set);

  /// The file of the case of these assignments; "" if they name none.
  std::string case_file_of(const std::vector<Assignment>& set);

 private:
  struct KnownCase {
    std::string file;
    WideKey key;  // of all but the assignments
  };
  const KnownCase& known_case(const std::string& name);
  const std::string& files_in(const std::string& value, bool is_folder);

  WideKey start_;
  std::function<std::string(const std::string&)> find_case_;
  std::map<std::string, KnownCase> cases_;
  std::unordered_map<std::string, std::string> digests_;  // of the files that a value names
};

/// The digest of a folder's files, by their names and bytes; folders in it are left out.
std::string folder_digest(const std::string& folder);

/// The digest of a file's bytes. Throws InputError if it cannot be read.
std::string file_digest(const std::string& path);

}  // namespace foldproof
