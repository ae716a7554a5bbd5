#include <octafront/adapt.h>
#include <octafront/error.h>
#include <octafront/validity.h>

#include "improve/start_meshes.h"

#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using ::octafront::testing::kuhn_cube;
using ::octafront::testing::volume;

AdaptedMesh adapted_in(const TetMesh& mesh, double size, const std::string& only, int halo = 2, int threads = 0) {
  Options options;
  options.size.size = size;
  options.adapt.only = only;
  options.adapt.halo = halo;
  RunContext context;
  context.threads = threads;
  return adapt_existing(mesh, options, context);
}

/// A cube of two regions with names, a sheet, curves and sets of all kinds.
TetMesh rich_cube(int n) {
  TetMesh mesh = kuhn_cube(n);
  mesh.region.clear();
  const auto middle = [&](const auto& item) {
    Vec3 sum{};
    for (const VertexIndex v : item) sum += mesh.points[v];
    return (1.0 / static_cast<double>(item.size())) * sum;
  };
  for (const Tet& t : mesh.tets) mesh.region.push_back(middle(t).x > 0.5);
  mesh.region_names = {"left", "right"};
  mesh.patch_names = {"a", "b", "c", "d", "e", "f"};
  std::set<Triangle> seen;
  std::set<Edge> edges;
  for (const Tet& t : mesh.tets)
    for (int i = 0; i < 4; ++i) {
      Triangle f;
      for (std::size_t k = 0; k < 3; ++k) f[k] = t[static_cast<std::size_t>(kTetFaces[static_cast<std::size_t>(i)][k])];
      Triangle key = f;
      std::sort(key.begin(), key.end());
      const bool flat = std::all_of(f.begin(), f.end(), [&](VertexIndex v) { return mesh.points[v].x == 0.5; });
      if (flat && seen.insert(key).second) mesh.interfaces.push_back(f);
    }
  mesh.interface_patch.assign(mesh.interfaces.size(), 6);
  mesh.patch_names.push_back("wall");
  for (const Triangle& f : mesh.boundary)
    for (std::size_t k = 0; k < 3; ++k) {
      const Edge e = sorted_edge(f[k], f[(k + 1) % 3]);
      const Vec3 p = mesh.points[e[0]], q = mesh.points[e[1]];
      if (p.y == 0 && q.y == 0 && p.z == 0 && q.z == 0 && edges.insert(e).second) mesh.curve_edges.push_back(e);
    }
  mesh.curve.assign(mesh.curve_edges.size(), 0);
  mesh.curve_names = {"front"};
  const auto add = [&](const char* name, NamedSet::Kind kind, const auto& wanted) {
    NamedSet set{name, kind, {}};
    for (std::uint32_t i = 0; i < mesh.count(kind); ++i)
      if (wanted(i)) set.members.push_back(i);
    mesh.sets.push_back(set);
  };
  add("core", NamedSet::Kind::kElements, [&](std::uint32_t t) { return middle(mesh.tets[t]).z < 0.5; });
  add("nodes", NamedSet::Kind::kNodes, [&](std::uint32_t v) { return mesh.points[v].y == 1; });
  add("faces", NamedSet::Kind::kFaces, [&](std::uint32_t f) {
    const std::size_t outer = mesh.boundary.size();
    return middle(f < outer ? mesh.boundary[f] : mesh.interfaces[f - outer]).z < 0.5;
  });
  add("edges", NamedSet::Kind::kEdges, [&](std::uint32_t e) { return middle(mesh.curve_edges[e]).x < 0.5; });
  return mesh;
}

/// How many items keep number and bits, of those without a vertex in `changed`.
template <class Item>
void expect_same_outside(const std::vector<Item>& before, const std::vector<Item>& now,
                         const std::vector<std::uint32_t>& parts_before, const std::vector<std::uint32_t>& parts_now,
                         const std::set<VertexIndex>& outside) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (!std::all_of(before[i].begin(), before[i].end(), [&](VertexIndex v) { return outside.count(v) > 0; })) continue;
    ASSERT_LT(i, now.size());
    EXPECT_EQ(before[i], now[i]) << i;
    if (!parts_before.empty()) {
      EXPECT_EQ(parts_before[i], parts_now[i]) << i;
    }
    ++count;
  }
  EXPECT_GT(count, 0u);
}

TEST(AdaptOnly, OutsideStaysWithItsNumbers) {
  const TetMesh start = rich_cube(10);
  // A corner of .3, in two layers: nothing with a coordinate of .6 and more may change.
  const AdaptedMesh made = adapted_in(start, 0.03, "box:0.25,0.0,0.0,0.55,0.25,0.25");
  EXPECT_EQ(first_defect(made.mesh), std::nullopt);
  EXPECT_GT(made.mesh.tets.size(), start.tets.size() + 1000);
  EXPECT_NEAR(volume(made.mesh), 1, 1e-12);
  std::set<VertexIndex> outside;
  for (VertexIndex v = 0; v < start.points.size(); ++v) {
    const Vec3 p = start.points[v];
    if (p.x < 0.85 && p.y < 0.55 && p.z < 0.55) continue;
    outside.insert(v);
    EXPECT_EQ(made.mesh.points[v], start.points[v]);
    EXPECT_EQ(made.old_of_new[v], v);
  }
  const std::vector<std::uint32_t> none;
  expect_same_outside(start.tets, made.mesh.tets, start.region, made.mesh.region, outside);
  expect_same_outside(start.boundary, made.mesh.boundary, start.patch, made.mesh.patch, outside);
  expect_same_outside(start.interfaces, made.mesh.interfaces, start.interface_patch, made.mesh.interface_patch,
                      outside);
  expect_same_outside(start.curve_edges, made.mesh.curve_edges, start.curve, made.mesh.curve, outside);
}

/// Sizes of what names stand for: they are planar or bounded by planes, so they stay to rounding.
std::map<std::string, double> measures(const TetMesh& mesh) {
  std::map<std::string, double> sum;
  const auto& p = mesh.points;
  const auto area = [&](const Triangle& t) { return 0.5 * length(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]])); };
  const auto volume_of = [&](const Tet& t) {
    return dot(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]), p[t[3]] - p[t[0]]) / 6;
  };
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) sum[mesh.region_names[mesh.region[t]]] += volume_of(mesh.tets[t]);
  for (std::size_t f = 0; f < mesh.boundary.size(); ++f) sum[mesh.patch_names[mesh.patch[f]]] += area(mesh.boundary[f]);
  for (std::size_t f = 0; f < mesh.interfaces.size(); ++f)
    sum[mesh.patch_names[mesh.interface_patch[f]]] += area(mesh.interfaces[f]);
  for (const Edge& e : mesh.curve_edges) sum["front"] += length(p[e[1]] - p[e[0]]);
  for (const NamedSet& set : mesh.sets)
    for (const std::uint32_t m : set.members) switch (set.kind) {
        case NamedSet::Kind::kElements:
          sum[set.name] += volume_of(mesh.tets[m]);
          break;
        case NamedSet::Kind::kFaces:
          sum[set.name] +=
              area(m < mesh.boundary.size() ? mesh.boundary[m] : mesh.interfaces[m - mesh.boundary.size()]);
          break;
        case NamedSet::Kind::kEdges:
          sum[set.name] += length(p[mesh.curve_edges[m][1]] - p[mesh.curve_edges[m][0]]);
          break;
        case NamedSet::Kind::kNodes:
          break;
      }
  return sum;
}

void expect_same_measures(const TetMesh& a, const TetMesh& b) {
  const auto had = measures(a), has = measures(b);
  ASSERT_EQ(had.size(), has.size());
  for (const auto& [name, value] : had) EXPECT_NEAR(value, has.at(name), 1e-12) << name;
}

TEST(AdaptOnly, NamedPartsStayWhereTheyAre) {
  const TetMesh start = rich_cube(8);
  for (const double size : {0.04, 0.5}) {
    const AdaptedMesh made = adapted_in(start, size, "box:0.3,0,0,0.7,0.4,0.4");
    EXPECT_EQ(first_defect(made.mesh), std::nullopt);
    expect_same_measures(start, made.mesh);
    // Nodes of the set: y = 1, which is outside and keeps its numbers where the mesh has as many.
    EXPECT_EQ(made.mesh.sets[1].members.size(), start.sets[1].members.size());
    for (const VertexIndex v : made.mesh.sets[1].members) EXPECT_EQ(made.mesh.points[v].y, 1);
    if (size < 0.1) {
      EXPECT_EQ(made.mesh.sets[1], start.sets[1]);
    }
  }
}

TEST(AdaptOnly, CoarserMeshesHaveNoHolesAndSayWhatMoved) {
  const TetMesh start = rich_cube(12);
  const AdaptedMesh made = adapted_in(start, 0.4, "sphere:0.25,0.25,0.25,0.2");
  EXPECT_EQ(first_defect(made.mesh), std::nullopt);
  ASSERT_LT(made.mesh.points.size(), start.points.size());
  expect_same_measures(start, made.mesh);
  std::set<VertexIndex> old;
  std::size_t moved = 0;
  for (VertexIndex v = 0; v < made.old_of_new.size(); ++v) {
    const VertexIndex o = made.old_of_new[v];
    if (o == kNone) continue;
    EXPECT_TRUE(old.insert(o).second);
    moved += o != v;
    // Only those whose number there is no more got another one.
    if (o != v) {
      EXPECT_GE(o, made.mesh.points.size());
    }
  }
  EXPECT_LE(moved, start.points.size() - made.mesh.points.size());
  for (TetIndex t = 0; t < made.old_tet_of_new.size(); ++t) {
    const TetIndex o = made.old_tet_of_new[t];
    if (o == kNone) continue;
    if (o != t) {
      EXPECT_GE(o, made.mesh.tets.size());
    }
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_EQ(start.points[start.tets[o][k]], made.mesh.points[made.mesh.tets[t][k]]);
  }
}

TEST(AdaptOnly, NoHaloMeansNoneOfTheOthers) {
  const TetMesh start = rich_cube(6);
  const AdaptedMesh made = adapted_in(start, 0.05, "right", 0);
  EXPECT_EQ(first_defect(made.mesh), std::nullopt);
  EXPECT_GT(made.mesh.tets.size(), 4 * start.tets.size());
  for (TetIndex t = 0; t < start.tets.size(); ++t)
    if (start.region[t] == 0) {
      EXPECT_EQ(start.tets[t], made.mesh.tets[t]);
    }
}

TEST(AdaptOnly, SeveralPlacesAndSetsByName) {
  const TetMesh start = rich_cube(6);
  const TetMesh whole = adapted_in(start, 0.1, "left;right").mesh;
  EXPECT_GT(whole.tets.size(), 2 * start.tets.size());
  EXPECT_EQ(first_defect(whole), std::nullopt);
  EXPECT_GT(adapted_in(start, 0.1, "core").mesh.tets.size(), start.tets.size());
  EXPECT_GT(adapted_in(start, 0.1, "front", 0).mesh.tets.size(), start.tets.size());
  EXPECT_GT(adapted_in(start, 0.1, "wall", 0).mesh.tets.size(), start.tets.size());
  EXPECT_GT(adapted_in(start, 0.1, "faces", 0).mesh.tets.size(), start.tets.size());
}

TEST(AdaptOnly, SameBitsForAnyNumberOfThreads) {
  const TetMesh start = kuhn_cube(16);
  const std::string only = "sphere:0.5,0.5,0.5,0.3";
  const AdaptedMesh one = adapted_in(start, 0.026, only, 2, 1), two = adapted_in(start, 0.026, only, 2, 2);
  EXPECT_GT(one.mesh.points.size(), 16000u);  // several pieces
  EXPECT_EQ(one.mesh, two.mesh);
  EXPECT_EQ(one.old_tet_of_new, two.old_tet_of_new);
}

TEST(AdaptOnly, FixedPointsKeepEverything) {
  const TetMesh start = kuhn_cube(4);
  const AdaptedMesh made = adapted_in(start, 0.01, "box:0.4,0.4,0.4,0.41,0.41,0.41", 0);
  EXPECT_EQ(made.mesh.points.size(), start.points.size());  // no vertex has all of its elements in the place
  EXPECT_EQ(made.mesh.tets, start.tets);
}

TEST(AdaptOnly, WhatIsNoPlaceIsRefused) {
  const TetMesh start = rich_cube(2);
  EXPECT_THROW(adapted_in(start, 0.2, "box:0,0,0,1,1"), OptionError);
  EXPECT_THROW(adapted_in(start, 0.2, "box:0,0,0,1,1,x"), OptionError);
  EXPECT_THROW(adapted_in(start, 0.2, "sphere:0,0,0,0"), OptionError);
  EXPECT_THROW(adapted_in(start, 0.2, "nobody"), OptionError);
  EXPECT_THROW(adapted_in(start, 0.2, "box:5,5,5,6,6,6"), OptionError);
  EXPECT_THROW(adapted_in(start, 0.2, "left", -1), OptionError);
  TetMesh broken = start;
  std::swap(broken.tets[0][0], broken.tets[0][1]);
  EXPECT_THROW(adapted_in(broken, 0.2, "left;right"), InputError);
}

}  // namespace
}  // namespace octafront
