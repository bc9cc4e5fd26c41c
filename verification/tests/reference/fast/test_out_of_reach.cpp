// What proves that a point keeps clear of objects.
#include <catch2/catch.hpp>

#include "reference/fast/out_of_reach.h"

using namespace foldproof;

TEST_CASE("out of reach: twice the way since the query is taken off the clearance") {
  const std::vector<Object> floor{{"floor", RigidObject{HalfSpace{}, {}, Motion{}}, 0}};
  ObjectsOverSpan objects(floor, {0, 0.1, 0.1});
  const Vector3 asked(0.2, -0.3, 0.5), aside = asked + Vector3(0.1, 0, 0);
  CHECK_FALSE(out_of_reach(objects, asked, Vector3::Zero(), 0.1));  // nothing was asked yet
  objects.at(asked);
  CHECK(out_of_reach(objects, asked, {0, 0, -4.9}, 0.1));
  CHECK_FALSE(out_of_reach(objects, asked, {0, 0, -5.1}, 0.1));
  // .5 - 2 * .1 = .3 are left
  CHECK(out_of_reach(objects, aside, {0, 0, -2.9}, 0.1));
  CHECK_FALSE(out_of_reach(objects, aside, {0, 0, -3.1}, 0.1));
  CHECK_FALSE(out_of_reach(objects, aside, {3.1, 0, 0}, 0.1));  // whichever way it goes
  CHECK_FALSE(out_of_reach(objects, asked + Vector3(0, 0.25, 0), Vector3::Zero(), 0.1));
  objects.at({0.2, -0.3, -0.5});
  CHECK_FALSE(out_of_reach(objects, {0.2, -0.3, -0.5}, Vector3::Zero(), 0.1));  // inside
}

TEST_CASE("out of reach: it is the speed against the object that counts, and each object does") {
  Motion down;
  down.velocity = {0, 0, -6};
  const std::vector<Object> one{{"floor", RigidObject{HalfSpace{}, {}, down}, 0}};
  const Pose above{Eigen::Quaterniond(Eigen::AngleAxisd(std::acos(-1.0), Vector3::UnitX())),
                   {0, 0, 0.8}};
  const std::vector<Object> two{one[0], {"lid", RigidObject{HalfSpace{}, above, Motion{}}, 0}};
  const Vector3 p(0.2, -0.3, 0.5);
  ObjectsOverSpan of_one(one, {0, 0.1, 0.1}), of_two(two, {0, 0.1, 0.1});
  of_one.at(p);
  of_two.at(p);
  CHECK(out_of_reach(of_one, p, {0, 0, -6}, 0.1));
  CHECK_FALSE(out_of_reach(of_one, p, Vector3::Zero(), 0.1));
  CHECK_FALSE(out_of_reach(of_two, p, {0, 0, -6}, 0.1));  // .3 below the lid, which rests
  CHECK(out_of_reach(of_two, p, {0, 0, -2.5}, 0.1));
}
