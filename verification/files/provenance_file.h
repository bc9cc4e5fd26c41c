// Provenance of the numbers in every results file.
#pragma once

#include <string>

namespace foldproof {

class Hdf5;

struct Provenance {
  std::string version, commit, tree;  // tree: "clean", "dirty" or "unknown"
  std::string compiler, flags, build_type, cpu, date, command;
  int cores = 0;
};

/// As attributes of the file's root.
void write_provenance(const Hdf5& file, const Provenance& provenance);

}  // namespace foldproof
