// Frames that a test places by hand, as a motion of a case's cloth.
#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "reference/bodies/level_set_provider.h"
#include "verification/cases/frame_laws.h"

namespace foldproof::hand_made {

using Law = Finding (*)(const FrameMotion&);

inline Law law(const std::string& name) {
  for (const FrameLaw& one : frame_laws())
    if (one.name == "frames." + name) return one.run;
  throw std::logic_error("no law " + name);
}

/// A case and frames of it. Change `of` through the constructor's argument only.
struct Frames {
  Case of;
  BuiltScene built;
  std::vector<TimedMesh> frames = {};

  /// The cloth stays at its start at these times [s].
  explicit Frames(Case given, const std::vector<double>& times = {})
      : of(std::move(given)), built(build(of.scene, computing_provider())) {
    for (const double time : times) add(time, of.scene.x);
  }
  Frames(const Frames&) = delete;
  Frames& operator=(const Frames&) = delete;

  void add(double time, const PerParticle3& x) {
    frames.push_back({"frame " + std::to_string(frames.size()), time, x, of.scene.mesh.triangles});
  }
  FrameMotion motion() const { return motion_of(of, built, frames); }

  /// What the law needs; "" if it is offered.
  std::string missing(Law law) const {
    try {
      law(motion());
    } catch (const NotOffered& needed) {
      return needed.operation;
    }
    return "";
  }
};

/// A sheet of 3 x 2 cells, 0.3 m x 0.24 m, and more tables.
inline Case sheet(const std::string& more) {
  const std::string text =
      R"(
cloth = { shape = "sheet", width = 0.3, height = 0.24, columns = 3, rows = 2, density = 0.17 }
time = { end = 0.5, frames_per_second = 50 }
)" + more;
  return Case{read_scene_text(text, "hand.toml"), {}};
}

/// Of the circle about a cell's half, stretched by a quarter [m].
inline const double radius_of_half_cells = 1.25 * std::hypot(0.1, 0.12) / 2;

inline const std::string ball =
    "[[object]]\nshape = \"sphere\"\nradius = 0.1\nmove = [0.1, 0.12, -0.2]\n";
inline const std::string driven = "[[hold]]\nparticles = [0]\nvelocity = [0, 0, 1]\n";

/// A corner of the sheet is brought through its middle.
inline PerParticle3 crossed(PerParticle3 x) {
  x.col(0) = Vector3(0.17, 0.13, -0.05);
  x.col(1) = Vector3(0.17, 0.11, 0.05);
  return x;
}

/// Agrees to rounding errors.
inline Approx exactly(double value) { return Approx(value).epsilon(1e-9).margin(1e-14); }

/// The largest coordinate of any frame times half a unit of its sixth digit [m].
inline double rounding_of(const std::vector<TimedMesh>& frames) {
  double largest = 0;
  for (const TimedMesh& frame : frames) largest = std::max(largest, frame.x.cwiseAbs().maxCoeff());
  return largest / 200000;
}

}  // namespace foldproof::hand_made
