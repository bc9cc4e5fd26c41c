// A mesh in motion, as files: a folder of numbered meshes, or one cache of all frames.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

struct MeshFrame {
  std::string file;  // and the frame's number in a cache, for messages
  // place in the sequence as the files count it, in frames of a rate: 0, 1, ... for numbered files
  // and NPZ, the header's of PC2, the time code of USD
  double number;
  std::optional<double> time;       // as the files state it [s]
  PerParticle3 x;                   // 3 x N [m]
  std::vector<Triangle> triangles;  // M, indices in range; empty: points alone
};

/// Where frames are, and which of them are meant.
struct FrameSource {
  std::string path;            // of a folder, or a cache
  std::string preferred = {};  // of several sequences in a folder, the one of this name
  // for a message: what to do about a gap in the numbers of files; empty: gaps are allowed
  std::string remedy = {};
  std::size_t most = 1'000'000;  // frames
};

/// The frames of a cache (.pc2, .npz, .usda) or a folder: files NAME*.obj or NAME*.ply in the order
/// of the last number in their names, or one cache. Endings may be upper case; names that begin
/// with a dot do not count. All PC2, NPZ and USD coordinates are finite; frames are at least one.
/// Throws InputError in one line that names the file or folder: none of these, several sequences
/// without a preferred one, a file without a number beside numbered ones, two with one number, a
/// gap, more frames than `most`, and a file that cannot be read.
std::vector<MeshFrame> read_mesh_frames(const FrameSource& source);

/// The bytes of a 3ds Max point cache, as most animation programs write it: little-endian, version
/// 1, float32 points [m], no faces. Frame k has the number start + k rate of the header.
std::vector<MeshFrame> read_pc2_bytes(std::string_view bytes, const std::string& file);

/// The bytes of a NumPy archive, arrays stored or deflated: vertices [F, N, 3] of float32 or
/// float64 [m]; faces [M, 3] of integers, counted from 0; fps, one number [1/s]. Without faces the
/// frames are points, without fps they have no times; times [F] [s] is taken instead of fps.
std::vector<MeshFrame> read_npz_bytes(std::string_view bytes, const std::string& file);

/// The text of a USD layer with one Mesh, whose points have time samples: seconds are those since
/// startTimeCode, by timeCodesPerSecond; points are scaled by metersPerUnit, which is 0.01 if it is
/// not given, and turned if upAxis is "Z": (x, y, z) becomes (x, z, -y). Polygons are cut by
/// triangles_of_polygon in the first frame. Transforms other than the identity are refused.
std::vector<MeshFrame> read_usda_text(std::string_view text, const std::string& file);

}  // namespace foldproof
