#include "fill/front/front_index.h"

#include "fill/front/front.h"

#include <cmath>
#include <map>
#include <random>
#include <set>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// Boxes of sizes over six orders of magnitude come and go; what is found is a superset of what overlaps, each once.
TEST(FrontIndex, FindsEveryFaceThatReachesIn) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  const Box3 domain{{-3, 2, 1e3}, {5, 9, 1.01e3}};
  FrontIndex index(domain, 1e-4);
  std::map<FaceIndex, Box3> present;
  // Crowded towards one point, as sizes are: a box is about as large as it is far from there.
  const Vec3 crowded{0.3, 4.1, 1003};
  const auto random_box = [&] {
    const double size = std::pow(10.0, -6 * unit(random));
    Vec3 lo, hi;
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis] = crowded[axis] + size * (2 * unit(random) - 1.5);
      hi[axis] = lo[axis] + size * unit(random);
    }
    return Box3{lo, hi};
  };
  std::vector<FrontIndex::Found> found;
  std::size_t hits = 0;
  for (FaceIndex step = 0; step < 6000; ++step) {
    if (present.size() > 500 && unit(random) < 0.5) {
      auto it = present.lower_bound(static_cast<FaceIndex>(unit(random) * step));
      if (it == present.end()) it = present.begin();
      index.remove(it->first);
      present.erase(it);
    } else {
      present[step] = random_box();
      index.insert(step, {step, step + 1, step + 2}, present[step]);
    }
    if (step % 10 != 0) continue;
    SearchRegion region;
    region.box = random_box();
    region.center = region.box.center();
    region.radius = region.box.diagonal() / 2;
    region.normal = {1, 0, 0};
    region.offset = region.box.lo.x;
    found.clear();
    index.find(region, found);
    std::map<FaceIndex, Triangle> seen;
    for (const auto& f : found) EXPECT_TRUE(seen.emplace(f.face, f.corners).second) << "face twice";
    for (const auto& [face, box] : present)
      if (box.overlaps(region.box)) {
        // The box of the region lies inside its sphere and before its plane.
        ASSERT_TRUE(seen.contains(face)) << "face " << face << " is missing";
        EXPECT_EQ(seen[face], (Triangle{face, face + 1, face + 2}));
        ++hits;
      }
    if (step % 500 == 0) {
      EXPECT_EQ(index.first_inconsistency(), std::nullopt);
    }
    for (const auto& [face, corners] : seen) EXPECT_TRUE(present.contains(face)) << "face " << face << " was removed";
  }
  EXPECT_GT(hits, 1000u);
}

TEST(FrontIndex, LeavesOutWhatLiesBehindThePlaneOrBeyondTheSphere) {
  const Box3 domain{{0, 0, 0}, {10, 10, 10}};
  FrontIndex index(domain, 1);
  index.insert(0, {0, 1, 2}, {{4.9, 4.9, 4.0}, {5.1, 5.1, 4.2}});  // behind
  index.insert(1, {3, 4, 5}, {{5.9, 5.9, 5.9}, {6.0, 6.0, 6.0}});  // in the box's corner, beyond the sphere
  index.insert(2, {6, 7, 8}, {{4.9, 4.9, 5.2}, {5.1, 5.1, 5.4}});
  SearchRegion region;
  region.box = {{4, 4, 4}, {6, 6, 6}};
  region.center = {5, 5, 5};
  region.radius = 1;
  region.normal = {0, 0, 1};
  region.offset = 5;
  std::vector<FrontIndex::Found> found;
  index.find(region, found);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].face, 2u);
}

TEST(FrontIndex, FindsTheFacesOfOneRegionAndThoseOfNone) {
  FrontIndex index({{0, 0, 0}, {10, 10, 10}}, 1);
  const Box3 box{{4.9, 4.9, 4.9}, {5.1, 5.1, 5.1}};
  for (const FaceIndex face : {0u, 1u, 2u, 3u}) index.insert(face, {0, 1, 2}, box, face < 3 ? face : kNone);
  index.remove(0);  // another takes its place
  SearchRegion region{.box = box, .center = box.center(), .radius = 1, .normal = {0, 0, 1}, .offset = 0, .of = 2};
  const auto found = [&] {
    std::vector<FrontIndex::Found> list;
    index.find(region, list);
    std::set<FaceIndex> faces;
    for (const auto& f : list) faces.insert(f.face);
    return faces;
  };
  EXPECT_EQ(found(), (std::set<FaceIndex>{2, 3}));
  region.of = kNone;
  EXPECT_EQ(found(), (std::set<FaceIndex>{1, 2, 3}));
}

/// Both break the contract: a face is in the index once, and has three corners.
TEST(Front, FindsWhatIsWrongWithIt) {
  const auto complaint = [](const auto& broken) -> std::string {
    try {
      return broken().value_or("");
    } catch (const std::logic_error& error) {
      return error.what();
    }
  };
  const Box3 domain{{0, 0, 0}, {1, 1, 1}};
  EXPECT_EQ(complaint([&] {
              FrontIndex index(domain, 0.1);
              index.insert(3, {0, 1, 2}, {{0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}});
              index.insert(3, {0, 1, 2}, {{0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}});
              return index.first_inconsistency();
            }),
            "face 3 is not where the index looks for it");
  const auto front_with = [&](const Triangle& face) {
    return complaint([&] {
      Front front(domain, 0.1);
      for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}) front.add_vertex(p, 0.1);
      front.add_face({{0, 1, 2}});
      front.add_face({face});
      front.remove_face(0);
      return front.first_inconsistency();
    });
  };
  EXPECT_EQ(front_with({0, 2, 1}), "");
  EXPECT_EQ(front_with({0, 2, 2}), "face 1 has a corner twice");
}

TEST(BoxCulling, IsTheSameOnEveryProcessor) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> place(0, 8), extent(0, 1), direction(-1, 1);
  unsigned hits = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    BoxBlock boxes;
    CullingRegion region;
    for (int axis = 0; axis < 3; ++axis) {
      for (int s = 0; s < BoxBlock::kWidth; ++s) {
        boxes.lo[axis][s] = s < 12 ? place(random) : 1e30f;
        boxes.hi[axis][s] = s < 12 ? boxes.lo[axis][s] + extent(random) : -1e30f;
      }
      region.center[axis] = place(random);
      region.lo[axis] = region.center[axis] - 2;
      region.hi[axis] = region.center[axis] + 2;
      region.normal[axis] = direction(random);
    }
    region.squared_radius = 4;
    region.behind = direction(random);
    const unsigned found = cull_boxes_portable(boxes, region);
    EXPECT_EQ(found, cull_boxes(boxes, region));
    EXPECT_EQ(found & 0xf000, 0u);
    hits += found != 0;
  }
  EXPECT_GT(hits, 500u);
}

}  // namespace
}  // namespace octafront
