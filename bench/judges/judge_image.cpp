// How true a mesh is to the labels of an image: octafront_judge_image IMAGE MESH [all] [series=N] [iso=V]
// Prints JSON: elements, and for each label voxels, volume in and out, Dice at the voxels' middles, the two-sided
// Hausdorff distance of its surface to its voxels' faces in voxels (sampled at corners and middles of faces), pieces
// and Euler characteristic of both. With `all` 0 is a label too; with iso=V what has the
// value V or more is one. Regions are told by their name, "label 3", or else are
// the label that most voxels in them have.

#include <octafront/octafront.h>

#include "base/core/disjoint_sets.h"
#include "base/core/parallel.h"
#include "base/geometry/triangle_tree.h"
#include "images/labels/runs.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>

namespace octafront {
namespace {

/// From the world to indices: the other way round than ImageGrid::to_world.
class ToIndex {
 public:
  explicit ToIndex(const ImageGrid& grid) : grid_(grid) {
    const auto& [a, b, c] = grid.axes;
    const double volume = dot(cross(a, b), c);
    rows_ = {cross(b, c) / volume, cross(c, a) / volume, cross(a, b) / volume};
  }
  /// In voxels: slices count 0, 1, 2, ... wherever they lie.
  Vec3 operator()(Vec3 p) const {
    const Vec3 q = p - grid_.origin;
    return {dot(rows_[0], q), dot(rows_[1], q), slice_number(dot(rows_[2], q))};
  }

 private:
  double slice_number(double at) const {
    const auto& s = grid_.slices;
    if (s.size() < 2) return at;
    const auto above = std::clamp<std::ptrdiff_t>(std::upper_bound(s.begin(), s.end(), at) - s.begin(), 1,
                                                  static_cast<std::ptrdiff_t>(s.size()) - 1);
    const auto k = static_cast<std::size_t>(above);
    return static_cast<double>(k) - 1 + (at - s[k - 1]) / (s[k] - s[k - 1]);
  }

  const ImageGrid& grid_;
  std::array<Vec3, 3> rows_;
};

/// A surface as triangles of index space.
struct Soup {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
};

struct Found {
  std::uint64_t voxels = 0, hit = 0, covered = 0, tets = 0;
  double volume_in = 0, volume_out = 0, hausdorff = 0;
  std::int64_t pieces_in = 0, pieces_out = 0, euler_in = 0, euler_out = 0;
  double beta_min = 1, beta_sum = 0;
};

double six_volumes(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  return dot(cross(b - a, c - a), d - a);
}

class Judge {
 public:
  Judge(const LabelImage& image, const TetMesh& mesh) : image_(image), mesh_(mesh), found_(image.labels.size()) {
    const ToIndex to_index(image.grid);
    for (const Vec3 p : mesh.points) index_.push_back(to_index(p));
    name_regions();
  }

  void judge() {
    count_voxels();
    sample_middles();
    measure_tets();
    measure_surfaces();
  }
  const std::vector<Found>& found() const { return found_; }

 private:
  void name_regions() {
    std::map<std::int64_t, std::uint16_t> by_value;
    for (std::uint16_t l = 0; l < image_.labels.size(); ++l) by_value[image_.labels[l].value] = l;
    std::uint32_t regions = 1;
    for (const std::uint32_t r : mesh_.region) regions = std::max(regions, r + 1);
    label_of_region_.assign(std::max<std::size_t>(regions, mesh_.region_names.size()), LabelImage::kNoRegion);
    for (std::size_t r = 0; r < mesh_.region_names.size(); ++r) {
      const std::string& name = mesh_.region_names[r];
      if (!name.starts_with("label ")) continue;
      const std::size_t digits = name.find_last_not_of("0123456789") + 1;
      std::int64_t value = 0;
      std::from_chars(name.data() + digits, name.data() + name.size(), value);
      if (digits > 0 && name[digits - 1] == '-') value = -value;
      const auto label = by_value.find(value);
      if (label != by_value.end()) label_of_region_[r] = label->second;
    }
  }
  std::uint16_t label_of(std::size_t tet) const {
    const std::uint32_t r = mesh_.region.empty() ? 0 : mesh_.region[tet];
    return r < label_of_region_.size() ? label_of_region_[r] : LabelImage::kNoRegion;
  }

  void count_voxels() {
    const auto& size = image_.grid.size;
    const image::Runs runs(size, image_.regions);
    std::set<std::uint32_t> seen;
    for (std::size_t r = 0; r < runs.size(); ++r) {
      if (runs.run(r).region == LabelImage::kNoRegion) continue;
      Found& f = found_[runs.run(r).region];
      f.voxels += runs.run(r).end - runs.run(r).begin;
      f.pieces_in += seen.insert(runs.piece()[r]).second;
    }
    const double voxel = std::abs(dot(cross(image_.grid.axes[0], image_.grid.axes[1]), image_.grid.axes[2]));
    for (Found& f : found_) f.volume_in = voxel * static_cast<double>(f.voxels);
    euler_of_voxels();
  }

  std::uint16_t at(std::int64_t i, std::int64_t j, std::int64_t k) const {
    const auto& n = image_.grid.size;
    if (i < 0 || j < 0 || k < 0 || i >= n[0] || j >= n[1] || k >= n[2]) return LabelImage::kNoRegion;
    return image_.regions[static_cast<std::size_t>(i + n[0] * (j + std::int64_t{n[1]} * k))];
  }

  /// Cells of each dimension, closed: those of a corner, edge or face belong to all labels around it, once each.
  void euler_of_voxels() {
    const auto& n = image_.grid.size;
    std::vector<std::uint16_t> around;
    for (std::int64_t k = 0; k <= n[2]; ++k)
      for (std::int64_t j = 0; j <= n[1]; ++j)
        for (std::int64_t i = 0; i <= n[0]; ++i)
          for (unsigned kind = 0; kind < 8; ++kind) {  // bit: the cell extends along that axis
            around.clear();
            for (unsigned c = 0; c < 8; ++c) {
              if ((c & kind) != 0) continue;
              const auto back = [&](unsigned axis) { return static_cast<std::int64_t>(c >> axis & 1); };
              around.push_back(at(i - back(0), j - back(1), k - back(2)));
            }
            std::sort(around.begin(), around.end());
            around.erase(std::unique(around.begin(), around.end()), around.end());
            const int dimension = static_cast<int>((kind & 1) + (kind >> 1 & 1) + (kind >> 2));
            for (const std::uint16_t l : around)
              if (l != LabelImage::kNoRegion) found_[l].euler_in += dimension % 2 == 0 ? 1 : -1;
          }
  }

  /// The label of the tetrahedron at each voxel's middle.
  void sample_middles() {
    std::vector<std::uint32_t> seen(image_.regions.size(), kNone);
    const auto& n = image_.grid.size;
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      std::array<Vec3, 4> p;
      Box3 box;
      for (std::size_t c = 0; c < 4; ++c) box.add(p[c] = index_[mesh_.tets[t][c]]);
      const double volume = six_volumes(p[0], p[1], p[2], p[3]);
      const auto from = [&](int a) { return static_cast<std::int64_t>(std::max(0.0, std::ceil(box.lo[a]))); };
      const auto to = [&](int a) {
        return std::min<std::int64_t>(n[static_cast<std::size_t>(a)] - 1,
                                      static_cast<std::int64_t>(std::floor(box.hi[a])));
      };
      for (std::int64_t k = from(2); k <= to(2); ++k)
        for (std::int64_t j = from(1); j <= to(1); ++j)
          for (std::int64_t i = from(0); i <= to(0); ++i) {
            const Vec3 q{double(i), double(j), double(k)};
            const bool inside =
                six_volumes(q, p[1], p[2], p[3]) * volume >= 0 && six_volumes(p[0], q, p[2], p[3]) * volume >= 0 &&
                six_volumes(p[0], p[1], q, p[3]) * volume >= 0 && six_volumes(p[0], p[1], p[2], q) * volume >= 0;
            if (inside)
              seen[static_cast<std::size_t>(i + n[0] * (j + std::int64_t{n[1]} * k))] =
                  mesh_.region.empty() ? 0 : mesh_.region[t];
          }
    }
    name_by_most(seen);
    for (std::size_t v = 0; v < seen.size(); ++v) {
      const std::uint16_t label = seen[v] == kNone ? LabelImage::kNoRegion : label_of_region_[seen[v]];
      if (label == LabelImage::kNoRegion) continue;
      ++found_[label].covered;
      found_[label].hit += label == image_.regions[v];
    }
  }

  /// Regions without a name of ours.
  void name_by_most(const std::vector<std::uint32_t>& seen) {
    std::vector<std::map<std::uint16_t, std::uint64_t>> votes(label_of_region_.size());
    for (std::size_t v = 0; v < seen.size(); ++v)
      if (seen[v] != kNone && image_.regions[v] != LabelImage::kNoRegion) ++votes[seen[v]][image_.regions[v]];
    for (std::size_t r = 0; r < votes.size(); ++r) {
      if (label_of_region_[r] != LabelImage::kNoRegion) continue;
      std::uint64_t most = 0;
      for (const auto& [label, n] : votes[r])
        if (n > most) {
          most = n;
          label_of_region_[r] = label;
        }
    }
  }

  /// The faces of all tetrahedra, in order: those that two share stand side by side.
  struct Face {
    Triangle corners;  ///< ascending
    std::uint32_t tet;
    bool operator<(const Face& other) const { return std::tie(corners, tet) < std::tie(other.corners, other.tet); }
  };
  void sort_faces() {
    for (std::uint32_t t = 0; t < mesh_.tets.size(); ++t)
      for (std::size_t a = 0; a < 4; ++a) {
        const Tet& tet = mesh_.tets[t];
        Face face{{tet[(a + 1) % 4], tet[(a + 2) % 4], tet[(a + 3) % 4]}, t};
        std::sort(face.corners.begin(), face.corners.end());
        faces_.push_back(face);
      }
    std::sort(faces_.begin(), faces_.end());
  }
  /// Calls visit(face, label, label of the other side) for each face and each of its sides that has a label.
  template <class Visit>
  void for_each_side(const Visit& visit) const {
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const bool after = f > 0 && faces_[f - 1].corners == faces_[f].corners;
      const bool before = f + 1 < faces_.size() && faces_[f + 1].corners == faces_[f].corners;
      const std::uint16_t label = label_of(faces_[f].tet);
      const std::uint16_t other = after    ? label_of(faces_[f - 1].tet)
                                  : before ? label_of(faces_[f + 1].tet)
                                           : LabelImage::kNoRegion;
      if (label != LabelImage::kNoRegion) visit(faces_[f], label, other, before);
    }
  }

  /// How many different keys of each label there are.
  std::vector<std::int64_t> count_of_labels(std::vector<std::array<std::uint32_t, 3>> keys) const {
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    std::vector<std::int64_t> counts(found_.size(), 0);
    for (const auto& key : keys) ++counts[key[0]];
    return counts;
  }

  void measure_tets() {
    sort_faces();
    std::vector<std::array<std::uint32_t, 3>> vertices, edges;
    for (std::uint32_t t = 0; t < mesh_.tets.size(); ++t) {
      const std::uint16_t label = label_of(t);
      if (label == LabelImage::kNoRegion) continue;
      Found& f = found_[label];
      const Tet& tet = mesh_.tets[t];
      ++f.tets;
      f.volume_out += std::abs(six_volumes(mesh_.points[tet[0]], mesh_.points[tet[1]], mesh_.points[tet[2]],
                                           mesh_.points[tet[3]])) /
                      6;
      for (std::size_t a = 0; a < 4; ++a) {
        vertices.push_back({label, tet[a], 0});
        for (std::size_t b = a + 1; b < 4; ++b)
          edges.push_back({label, std::min(tet[a], tet[b]), std::max(tet[a], tet[b])});
      }
    }
    const std::vector<std::int64_t> v = count_of_labels(std::move(vertices)), e = count_of_labels(std::move(edges));
    std::vector<std::int64_t> faces(found_.size(), 0);
    DisjointSets pieces(mesh_.tets.size());
    for (std::size_t f = 0; f + 1 < faces_.size(); ++f)
      if (faces_[f].corners == faces_[f + 1].corners && label_of(faces_[f].tet) == label_of(faces_[f + 1].tet))
        pieces.join(faces_[f].tet, faces_[f + 1].tet);
    for_each_side([&](const Face&, std::uint16_t label, std::uint16_t other, bool before) {
      faces[label] += other != label || before;  // those inside a label once
    });
    std::vector<std::set<std::uint32_t>> roots(found_.size());
    for (std::uint32_t t = 0; t < mesh_.tets.size(); ++t)
      if (label_of(t) != LabelImage::kNoRegion) roots[label_of(t)].insert(pieces.find(t));
    for (std::size_t l = 0; l < found_.size(); ++l) {
      found_[l].pieces_out = static_cast<std::int64_t>(roots[l].size());
      found_[l].euler_out = v[l] - e[l] + faces[l] - static_cast<std::int64_t>(found_[l].tets);
    }
  }

  /// Faces between tetrahedra of a label and others.
  std::vector<Soup> surfaces_of_mesh() const {
    std::vector<Soup> soups(found_.size());
    for_each_side([&](const Face& face, std::uint16_t label, std::uint16_t other, bool) {
      if (label == other) return;
      for (const VertexIndex v : face.corners) soups[label].points.push_back(index_[v]);
      const auto n = static_cast<VertexIndex>(soups[label].points.size());
      soups[label].triangles.push_back({n - 3, n - 2, n - 1});
    });
    return soups;
  }

  std::vector<Soup> surfaces_of_voxels() const {
    std::vector<Soup> soups(found_.size());
    const auto& n = image_.grid.size;
    for (std::int64_t k = 0; k < n[2]; ++k)
      for (std::int64_t j = 0; j < n[1]; ++j)
        for (std::int64_t i = 0; i < n[0]; ++i) {
          const std::uint16_t l = at(i, j, k);
          if (l == LabelImage::kNoRegion) continue;
          for (int axis = 0; axis < 3; ++axis)
            for (const int side : {-1, 1}) {
              const auto step = [&](int a) { return a == axis ? side : 0; };
              if (at(i + step(0), j + step(1), k + step(2)) == l) continue;
              add_square({double(i), double(j), double(k)}, axis, side, soups[l]);
            }
        }
    return soups;
  }

  static void add_square(Vec3 middle, int axis, int side, Soup& soup) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto n = static_cast<VertexIndex>(soup.points.size());
    for (const auto& [a, b] : {std::pair{-.5, -.5}, {.5, -.5}, {.5, .5}, {-.5, .5}}) {
      Vec3 p = middle;
      p[axis] += side / 2.0;
      p[u] += a;
      p[v] += b;
      soup.points.push_back(p);
    }
    soup.triangles.push_back({n, n + 1, n + 2});
    soup.triangles.push_back({n, n + 2, n + 3});
  }

  static double farthest(const Soup& from, const Soup& to) {
    if (from.triangles.empty()) return 0;
    if (to.triangles.empty()) return TriangleTree::kFar;
    const TriangleTree tree(to.points, to.triangles);
    double most = 0;
    const auto look = [&](Vec3 p) {
      if (!tree.is_within(p, most)) most = std::max(most, std::sqrt(tree.nearest(p).squared_distance));
    };
    for (const auto& [a, b, c] : from.triangles) {
      look(from.points[a]);
      look((from.points[a] + from.points[b] + from.points[c]) / 3);
      look((from.points[b] + from.points[c]) / 2);
    }
    return most;
  }

  void measure_surfaces() {
    const std::vector<Soup> mesh = surfaces_of_mesh(), voxels = surfaces_of_voxels();
    parallel_for(
        found_.size(),
        [&](std::size_t l) {
          found_[l].hausdorff = std::max(farthest(mesh[l], voxels[l]), farthest(voxels[l], mesh[l]));
        },
        Split::kSingly);
  }

  const LabelImage& image_;
  const TetMesh& mesh_;
  std::vector<Vec3> index_;  ///< points of the mesh in voxels
  std::vector<Face> faces_;
  std::vector<std::uint16_t> label_of_region_;
  std::vector<Found> found_;
};

void print(const LabelImage& image, const TetMesh& mesh, const std::vector<Found>& found) {
  const QualitySummary q = summarize_quality(mesh);
  const auto poor = std::count_if(mesh.tets.begin(), mesh.tets.end(), [&](const Tet& t) {
    constexpr double kPoorBeta = 0.1, kPoorAngle = 8;
    const auto& [a, b, c, d] = std::array{mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]};
    const auto angles = dihedral_angles(a, b, c, d);
    return radius_ratio(a, b, c, d) < kPoorBeta || *std::min_element(angles.begin(), angles.end()) < kPoorAngle;
  });
  fmt::print(
      "{{\"elements\": {}, \"beta_mean\": {:.6f}, \"beta_min\": {:.6g}, \"dihedral_min\": {:.4f}, \"dihedral_max\": "
      "{:.4f}, \"poor\": {},\n\"labels\": [",
      mesh.tets.size(), q.beta_mean, q.beta_min, q.dihedral_min, q.dihedral_max, poor);
  for (std::size_t l = 0; l < found.size(); ++l) {
    const Found& f = found[l];
    const double both = static_cast<double>(f.voxels + f.covered);
    fmt::print(
        "{}{{\"value\": {}, \"voxels\": {}, \"tets\": {}, \"volume_in\": {:.9g}, \"volume_out\": {:.9g}, \"dice\": "
        "{:.6f}, "
        "\"hausdorff\": {}, \"pieces\": [{}, {}], \"euler\": [{}, {}]}}",
        l == 0 ? "\n" : ",\n", image.labels[l].value, f.voxels, f.tets, f.volume_in, f.volume_out,
        both > 0 ? 2 * static_cast<double>(f.hit) / both : 0,
        std::isfinite(f.hausdorff) ? fmt::format("{:.4f}", f.hausdorff) : "null", f.pieces_in, f.pieces_out, f.euler_in,
        f.euler_out);
  }
  fmt::print("]}}\n");
}

LabelImage image_of(const std::string& file, const std::vector<std::string>& words) {
  ImageChoice choice;
  LabelOptions options;
  std::optional<double> iso;
  for (const std::string& word : words) {
    if (word == "all") options.ignore.emplace();
    if (word.starts_with("series=")) choice.series = static_cast<std::uint32_t>(std::stoul(word.substr(7)));
    if (word.starts_with("iso=")) iso = std::stod(word.substr(4));
  }
  const Image read = read_image(file, choice);
  if (iso) return labels_of_bands(read, {{*iso, std::numeric_limits<double>::infinity(), "body"}});
  return labels_of(read, options);
}

}  // namespace
}  // namespace octafront

int main(int count, char** arguments) {
  using namespace octafront;
  if (count < 3) return 2;
  try {
    const LabelImage image = image_of(arguments[1], std::vector<std::string>(arguments + 3, arguments + count));
    const TetMesh mesh = read_mesh(arguments[2]);
    Judge judge(image, mesh);
    judge.judge();
    print(image, mesh, judge.found());
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
