// The growth of an octree: which cells are split, and which parts need a channel.
#include <catch2/catch.hpp>

#include <cmath>

#include "reference/level_set/octree_growth.h"

using namespace foldproof;

namespace {

OctreeSettings sampling(int depth) {
  return {{0, 0, 0}, 1, depth, 2, 3e-3, 0.05, 0.2, 0.03, HangingNodes::free};
}

DistanceFunction constant(double phi) {
  return [phi](const Vector3&) { return Distance{phi, Vector3::Zero()}; };
}

}  // namespace

TEST_CASE("a cell whose corners just reach a surface counts as holding it") {
  const double half = 0.25 * std::sqrt(3.0);  // of the diagonal of half the cube [m]
  const auto branches = [](double phi) {
    return make_octree({constant(phi)}, sampling(3)).branches.size();
  };
  CHECK(branches(half) == 9);
  CHECK(branches(std::nextafter(half, 1.0)) == 1);
}

TEST_CASE("a cell is split where it misses by more than is allowed, not by just as much") {
  // 8, and 1/4 more at odd nodes along x
  const DistanceFunction bumps = [](const Vector3& p) {
    return Distance{8 + 0.25 * (int(p.x()) % 2), Vector3::Zero()};
  };
  OctreeSettings settings = sampling(2);
  settings.width = 4;
  settings.surface_depth = 0;
  const auto branches = [&](double tolerance, double beyond, double band) {
    settings.tolerance = tolerance;
    settings.beyond = beyond;
    settings.band = band;
    return make_octree({bumps}, settings).branches.size();
  };
  CHECK(branches(0.25, 0, 0) == 1);
  CHECK(branches(std::nextafter(0.25, 0.0), 0, 0) == 9);
  // 1/16 + (8.25 - 6.75)/8
  CHECK(branches(0.0625, 0.125, 6.75) == 1);
  CHECK(branches(0.0625, 0.125, 6.75 + 1e-6) == 9);
  // in the band nothing is taken off
  CHECK(branches(0.25, 0.125, 20) == 1);
}

TEST_CASE("a part needs a channel within reach, or unless another is nowhere farther") {
  BranchNodes<double> near, far;
  near.fill(0.5);
  far.fill(0.75);
  CHECK(needs_channel({near, far}, 0, 0));
  CHECK_FALSE(needs_channel({near, far}, 1, 0.625));
  CHECK_FALSE(needs_channel({far, near}, 0, 0));
  for (const int n : {0, 13, 26}) {
    BranchNodes<double> reaching = far, crossing = far, touching = far, other = near, third = near;
    reaching[n] = 0.625;
    crossing[n] = 0.25;
    touching[n] = 0.5;
    CHECK(needs_channel({near, reaching}, 1, 0.625));
    CHECK_FALSE(needs_channel({near, reaching}, 1, std::nextafter(0.625, 0.0)));
    CHECK(needs_channel({near, crossing}, 1, 0));
    CHECK(needs_channel({near, crossing}, 0, 0));
    CHECK_FALSE(needs_channel({near, touching}, 1, 0));
    // each of two others is farther somewhere
    other[n] = third[(n + 5) % 27] = 1;
    CHECK(needs_channel({other, third, far}, 2, 0));
    CHECK_FALSE(needs_channel({other, near, far}, 2, 0));
  }
  // of parts alike at all nodes the first has the channel
  for (int part = 0; part < 3; ++part)
    CHECK(needs_channel({near, near, near}, std::size_t(part), 0) == (part == 0));
}
