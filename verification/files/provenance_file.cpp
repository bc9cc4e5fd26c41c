#include "verification/files/provenance_file.h"

#include "verification/files/hdf5_file.h"

namespace foldproof {

void write_provenance(const Hdf5& file, const Provenance& p) {
  file.attribute("schema", 1);
  file.attribute("program", "foldproof");
  file.attribute("version", p.version);
  file.attribute("commit", p.commit);
  file.attribute("tree", p.tree);
  file.attribute("compiler", p.compiler);
  file.attribute("flags", p.flags);
  file.attribute("build_type", p.build_type);
  file.attribute("cpu", p.cpu);
  file.attribute("cores", p.cores);
  file.attribute("date", p.date);
  file.attribute("command", p.command);
}

}  // namespace foldproof
