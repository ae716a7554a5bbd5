#include "measure.h"
#include "pipe.h"
#include "steps.h"
#include "topology.h"

#include <BOPAlgo_Builder.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <fmt/format.h>

namespace octafront::cad {

namespace {

/// Most that fusing may change a solid's volume, and all volumes together, relative.
constexpr double kFuseChange = 1e-3;
/// What two solids share is an overlap from this part of the smaller one on; less is how inexactly they touch.
constexpr double kOverlap = 1e-6;

struct Overlap {
  std::size_t a, b;
  double volume;
};

/// Of the solids of a cluster, in its order.
struct Fused {
  std::vector<TopoDS_Shape> solids;
  std::vector<std::pair<TopoDS_Shape, TopoDS_Shape>> faces;  // before, after
  std::vector<Overlap> overlaps;
  bool good = false;
};

using Cluster = std::vector<std::size_t>;

/// Solids whose boxes touch, directly or through others.
std::vector<Cluster> clusters_of(const Part& part) {
  const std::size_t n = part.solids.size();
  std::vector<Box3> boxes;
  Box3 all;
  for (const Body& body : part.solids) boxes.push_back(quick_box(body.solid)), all.add(boxes.back());
  const double reach = 1e-7 * all.diagonal();
  std::vector<std::size_t> root(n);
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = i + 1; k < n; ++k) {
      const double near = reach + tolerance_of(part.solids[i].solid) + tolerance_of(part.solids[k].solid);
      const Box3 wide{boxes[i].lo - Vec3{near, near, near}, boxes[i].hi + Vec3{near, near, near}};
      if (wide.overlaps(boxes[k])) root[std::max(find(i), find(k))] = std::min(find(i), find(k));
    }
  std::vector<Cluster> by_root(n), out;
  for (std::size_t i = 0; i < n; ++i) by_root[find(i)].push_back(i);
  for (Cluster& cluster : by_root)
    if (cluster.size() > 1) out.push_back(std::move(cluster));
  return out;
}

/// The solids that `before` became; itself if nothing happened to it.
TopTools_ListOfShape images_of(BOPAlgo_Builder& builder, const TopoDS_Shape& before) {
  TopTools_ListOfShape images = builder.Modified(before);
  if (images.IsEmpty() && !builder.IsDeleted(before)) images.Append(before);
  return images;
}

Fused fused_by(const Part& part, const Cluster& cluster, BOPAlgo_GlueEnum glue) {
  Fused out;
  BOPAlgo_Builder builder;
  for (const std::size_t i : cluster) builder.AddArgument(part.solids[i].solid);
  builder.SetNonDestructive(true);
  builder.SetRunParallel(false);
  builder.SetGlue(glue);
  builder.Perform(progress_of("fusing", fmt::format("{} solids", cluster.size())));
  if (builder.HasErrors()) return out;

  TopTools_IndexedMapOfShape results;
  for (TopExp_Explorer it(builder.Shape(), TopAbs_SOLID); it.More(); it.Next()) results.Add(it.Current());
  std::vector<std::vector<std::size_t>> owners(static_cast<std::size_t>(results.Extent()));
  std::vector<std::vector<int>> owned(cluster.size());
  for (std::size_t i = 0; i < cluster.size(); ++i)
    for (const TopoDS_Shape& image : images_of(builder, part.solids[cluster[i]].solid)) {
      const int r = results.FindIndex(image);
      if (r == 0) continue;
      owners[static_cast<std::size_t>(r - 1)].push_back(i);
      owned[i].push_back(r);
    }
  bool shared = false;
  for (std::size_t r = 0; r < owners.size(); ++r) {
    if (owners[r].size() < 2) continue;
    shared = true;
    const std::size_t one = cluster[owners[r][0]], other = cluster[owners[r][1]];
    const double common = std::abs(volume_of(results(static_cast<int>(r + 1))));
    if (common > kOverlap * std::min(volume_of(part.solids[one].solid), volume_of(part.solids[other].solid)))
      out.overlaps.push_back({one, other, common});
  }
  if (shared) return out;

  double before = 0, after = 0;
  for (std::size_t i = 0; i < cluster.size(); ++i) {
    if (owned[i].size() != 1) return out;
    TopoDS_Shape solid = results(owned[i][0]);
    double volume = volume_of(solid);
    if (volume < 0) solid.Reverse(), volume = -volume;
    const double own = volume_of(part.solids[cluster[i]].solid);
    if (!(std::abs(volume - own) <= kFuseChange * own)) return out;
    before += own, after += volume;
    out.solids.push_back(solid);
    for (TopExp_Explorer it(part.solids[cluster[i]].solid, TopAbs_FACE); it.More(); it.Next())
      for (const TopoDS_Shape& image : images_of(builder, it.Current())) out.faces.emplace_back(it.Current(), image);
  }
  out.good =
      static_cast<std::size_t>(results.Extent()) == cluster.size() && std::abs(after - before) <= kFuseChange * before;
  return out;
}

/// As fused_by; what the library throws is no success.
Fused tried(const Part& part, const Cluster& cluster, BOPAlgo_GlueEnum glue) {
  try {
    return fused_by(part, cluster, glue);
  } catch (const Standard_Failure&) {
    return {};
  }
}

[[noreturn]] void refuse(const Part& part, std::vector<Overlap> overlaps) {
  std::stable_sort(overlaps.begin(), overlaps.end(),
                   [](const Overlap& a, const Overlap& b) { return a.volume > b.volume; });
  const Overlap& worst = overlaps[0];
  const auto name = [&](std::size_t i) {
    return part.solids[i].labels.name.empty() ? std::to_string(i + 1) : "'" + part.solids[i].labels.name + "'";
  };
  throw Refusal(fmt::format("solids {} and {} overlap in {:.3g} mm^3{}", name(worst.a), name(worst.b), worst.volume,
                            overlaps.size() > 1 ? fmt::format(" (and {} more overlaps)", overlaps.size() - 1) : ""));
}

void take_fused(const Cluster& cluster, const Fused& fused, Part& part) {
  for (std::size_t i = 0; i < cluster.size(); ++i) part.solids[cluster[i]].solid = fused.solids[i];
  for (const auto& [before, after] : fused.faces) pass_labels(before, after, part.face_labels);
}

}  // namespace

void fuse(Part& part) {
  for (const Cluster& cluster : clusters_of(part)) {
    const std::string what = fmt::format("{} solids from {} on", cluster.size(), in_words(part, cluster[0]));
    send_progress("fusing", what);
    Fused fused = tried(part, cluster, BOPAlgo_GlueOff);
    if (!fused.overlaps.empty()) refuse(part, fused.overlaps);
    if (!fused.good) {
      send_progress("fusing", what + ", as solids that only touch");
      fused = tried(part, cluster, BOPAlgo_GlueShift);
    }
    if (fused.good) {
      take_fused(cluster, fused, part);
    } else {
      part.fused = false;
      part.notes.push_back(
          fmt::format("{} could not be given common faces without a change of volume, and stay separate", what));
    }
  }
}

}  // namespace octafront::cad
