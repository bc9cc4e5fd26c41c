#include "verification/files/deforming_content.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include "verification/files/content_key.h"

namespace foldproof {

namespace {

/// Raise this whenever the same input gives different level sets.
constexpr int method_version = 2;

void add_settings(ContentKey& key, const OctreeSettings& settings) {
  key.add(settings.corner.data(), 3);
  key.add(settings.width);
  key.add(settings.depth);
  key.add(settings.surface_depth);
  key.add(settings.tolerance);
  key.add(settings.band);
  key.add(settings.beyond);
  key.add(settings.reach);
  key.add(int(settings.hanging));
}

void require(bool is_met, std::size_t frame, const char* what) {
  if (!is_met) throw InputError("deforming body, frame " + std::to_string(frame) + ": " + what);
}

/// Children follow their branches in order, and so do channels: none is shared or out of range.
bool has_sound_branches(const Octree& tree) {
  std::size_t branches = 1, channels = 0;
  for (std::size_t b = 0; b < tree.branches.size(); ++b) {
    const OctreeBranch& branch = tree.branches[b];
    if (b >= branches || branch.children != int(branches) || branch.channels != int(channels))
      return false;
    if (branch.parts < 1) return false;
    branches += std::size_t(std::popcount(unsigned(branch.inner)));
    channels += branch.parts;
  }
  return branches == tree.branches.size() && channels == tree.phi.size() &&
         channels == tree.part.size();
}

/// Branches are stored breadth first; none is deeper than the settings allow.
bool is_deep_enough(const Octree& tree) {
  std::vector<int> level(tree.branches.size(), 0);
  for (std::size_t b = 0; b < level.size(); ++b) {
    if (level[b] >= tree.settings.depth) return false;
    for (int k = 0; k < std::popcount(unsigned(tree.branches[b].inner)); ++k)
      level.at(std::size_t(tree.branches[b].children + k)) = level[b] + 1;
  }
  return true;
}

bool is_finite(const DeformingFrame& frame) {
  bool finite = std::isfinite(frame.time);
  for (const auto& nodes : frame.field.phi)
    for (double phi : nodes) finite = finite && std::isfinite(phi);
  for (const auto* displacements : {&frame.to_next, &frame.from_previous})
    for (const auto& nodes : *displacements)
      for (const Vector3& u : nodes) finite = finite && u.allFinite();
  return finite;
}

}  // namespace

std::string input_key(const MeshSequence& sequence, const OctreeSettings& settings) {
  ContentKey key;
  key.add(method_version);
  key.add(sequence.triangles);
  key.add(sequence.times);
  for (const PerParticle3& x : sequence.positions) {
    key.add(std::uint64_t(x.cols()));
    key.add(x.data(), std::size_t(x.size()));
  }
  add_settings(key, settings);
  if (sequence.inside != Inside::normals) key.add(int(sequence.inside));
  return key.text();
}

std::string content_key(const DeformingBody& body) {
  ContentKey key;
  for (const DeformingFrame& frame : body.frames) {
    key.add(frame.time);
    add_settings(key, frame.field.settings);
    for (const OctreeBranch& branch : frame.field.branches)
      for (int value : {branch.children, branch.channels, int(branch.inner), int(branch.parts)})
        key.add(value);
    key.add(frame.field.part);
    key.add(frame.field.phi);
    key.add(frame.to_next);
    key.add(frame.from_previous);
  }
  return key.text();
}

void require_valid_content(const DeformingBody& body) {
  const std::size_t count = body.frames.size();
  if (count == 0) throw InputError("deforming body: no frame");
  for (std::size_t k = 0; k < count; ++k) {
    const DeformingFrame& frame = body.frames[k];
    const std::size_t channels = frame.field.phi.size();
    require(k == 0 || frame.time > body.frames[k - 1].time, k,
            "its time is not later than that before");
    require(!frame.field.branches.empty() && has_sound_branches(frame.field), k,
            "its branches do not fit together");
    require(is_deep_enough(frame.field), k, "its branches are deeper than its depth");
    require(frame.to_next.size() == (k + 1 < count ? channels : 0), k,
            "displacements to the next frame do not fit");
    require(frame.from_previous.size() == (k > 0 ? channels : 0), k,
            "displacements from the frame before do not fit");
    require(is_finite(frame), k, "a value is not finite");
  }
}

}  // namespace foldproof
