#include "surface/edits/sweep.h"

#include "base/mesh/edge_table.h"
#include "support/named_surfaces.h"
#include "surface/edits/walk.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace octafront::surface {
namespace {

/// Triangles are wanted while a size at their corners is above 1. Work on one lowers these, and raises that of a vertex
/// beyond an edge: of triangles before and behind it.
class Toy {
 public:
  Toy() : mesh_(make_input_surface(surface_, make_edge_table(surface_.points.size(), surface_.triangles))) {
    for (VertexIndex v = 0; v < mesh_.size.size(); ++v) mesh_.size[v] = v % 37 == 5 ? 9 : 0;
  }

  std::vector<std::uint32_t> visited_one_by_one() {
    for (std::uint32_t t = 0; t < mesh_.triangle_count(); ++t)
      if (is_wanted(t)) work(t);
    return visited_;
  }
  std::vector<std::uint32_t> visited_by_sweep() {
    const auto is_changed = [&](std::uint32_t t) {
      return std::ranges::any_of(mesh_.triangle(t),
                                 [&](VertexIndex v) { return mesh_.is_marked(v, WorkingMesh::kForSweep); });
    };
    sweep(
        mesh_, [&] { return mesh_.triangle_count(); }, [&](std::uint32_t t) { return is_wanted(t); }, is_changed,
        [&](std::uint32_t t) { return is_wanted(t) && work(t); });
    return visited_;
  }

 private:
  bool is_wanted(std::uint32_t t) const {
    return std::ranges::any_of(mesh_.triangle(t), [&](VertexIndex v) { return mesh_.size[v] > 1; });
  }
  bool work(std::uint32_t t) {
    visited_.push_back(t);
    if (t % 5 == 0) return false;
    double most = 0;
    for (const VertexIndex v : mesh_.triangle(t)) {
      most = std::max(most, mesh_.size[v]);
      mesh_.size[v] = 0;
      mesh_.mark_star_changed(v);
    }
    const VertexIndex beyond = mesh_.apex(mesh_.twin[3 * t]);
    mesh_.size[beyond] = most - 1;
    mesh_.mark_star_changed(beyond);
    return true;
  }

  SurfaceMesh surface_ = testing::icosphere(4);
  WorkingMesh mesh_;
  std::vector<std::uint32_t> visited_;
};

TEST(Sweep, VisitsWhatOneThreadWouldInItsOrder) {
  const std::vector<std::uint32_t> wanted = Toy().visited_one_by_one();
  EXPECT_GT(wanted.size(), 100u);
  EXPECT_EQ(Toy().visited_by_sweep(), wanted);
}

}  // namespace
}  // namespace octafront::surface
