#include "verification/files/level_set_cache_file.h"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "verification/files/deforming_content.h"
#include "verification/files/hdf5_file.h"

namespace foldproof {

namespace {

const char* const file_format = "foldproof level sets 1";

void write_displacements(const Hdf5& group, const std::string& name,
                         const std::vector<BranchNodes<Vector3>>& nodes) {
  const double* values = nodes.empty() ? nullptr : nodes.front().front().data();
  group.array(name, {nodes.size(), 27, 3}, values).attribute("unit", std::string("m"));
}

void write_frame(const Hdf5& group, const DeformingFrame& frame) {
  const Octree& tree = frame.field;
  std::vector<int> branches;
  for (const OctreeBranch& branch : tree.branches)
    for (int value : {branch.children, branch.channels, int(branch.inner), int(branch.parts)})
      branches.push_back(value);
  group.array("branches", {tree.branches.size(), 4}, branches.data());
  group.array("part", {tree.part.size()}, tree.part.data());
  group.array("phi", {tree.phi.size(), 27}, tree.phi.front().data())
      .attribute("unit", std::string("m"));
  write_displacements(group, "to_next", frame.to_next);
  write_displacements(group, "from_previous", frame.from_previous);
}

/// The values of a dataset as rows of 27 entries of T, each made of `size` doubles.
template <class T>
std::vector<BranchNodes<T>> read_nodes(const Hdf5& group, const std::string& name,
                                       std::size_t size) {
  const std::vector<double> values = group.read_doubles(name);
  std::vector<BranchNodes<T>> nodes(values.size() / (27 * size));
  if (values.size() != nodes.size() * 27 * size)
    throw std::runtime_error(name + " has no whole rows");
  static_assert(sizeof(BranchNodes<T>) == 27 * sizeof(T));
  std::copy(values.begin(), values.end(), reinterpret_cast<double*>(nodes.data()));
  return nodes;
}

DeformingFrame read_frame(const Hdf5& group, double time, const OctreeSettings& settings) {
  DeformingFrame frame{
      time, {settings, {}, group.read_ints("part"), read_nodes<double>(group, "phi", 1), 0},
      {},   {},
      0,    0};
  const std::vector<int> rows = group.read_ints("branches");
  for (std::size_t i = 0; i + 3 < rows.size(); i += 4)
    frame.field.branches.push_back({rows[i], rows[i + 1], static_cast<unsigned char>(rows[i + 2]),
                                    static_cast<unsigned char>(rows[i + 3])});
  frame.to_next = read_nodes<Vector3>(group, "to_next", 3);
  frame.from_previous = read_nodes<Vector3>(group, "from_previous", 3);
  return frame;
}

void require(bool is_met, const std::string& path, const std::string& why) {
  if (!is_met) throw std::runtime_error(path + ": " + why);
}

}  // namespace

void write_level_sets(const std::string& path, const DeformingBody& body,
                      const std::string& origin) {
  write_hdf5(path, [&](const Hdf5& file) {
    file.attribute("format", std::string(file_format));
    file.attribute("origin", origin);
    file.attribute("content", content_key(body));
    std::vector<double> times;
    for (const DeformingFrame& frame : body.frames) times.push_back(frame.time);
    file.dataset("times", times).attribute("unit", std::string("s"));
    const Hdf5 frames = file.group("frames");
    for (std::size_t k = 0; k < body.frames.size(); ++k)
      write_frame(frames.group(std::to_string(k)), body.frames[k]);
  });
}

DeformingBody read_level_sets(const std::string& path, const std::string& origin,
                              const OctreeSettings& settings, BetweenFrames between) {
  const Hdf5 file = Hdf5::open_file(path);
  require(file.read_text("format") == file_format, path, "it holds no level sets of this version");
  require(file.read_text("origin") == origin, path,
          "it was computed from another mesh, other times or settings");
  DeformingBody body{{}, between};
  const std::vector<double> times = file.read_doubles("times");
  const Hdf5 frames = file.open_group("frames");
  for (std::size_t k = 0; k < times.size(); ++k)
    body.frames.push_back(read_frame(frames.open_group(std::to_string(k)), times[k], settings));
  require(content_key(body) == file.read_text("content"), path,
          "its content is not what was written");
  require_valid_content(body);
  for (DeformingFrame& frame : body.frames) index_descent_starts(frame.field);
  return body;
}

}  // namespace foldproof
