#include "base/mesh/joined.h"

#include "base/mesh/label_at.h"
#include "base/mesh/renumber_mesh.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace octafront {
namespace {

using Kind = NamedSet::Kind;

template <class T>
void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// Numbers of things with names: as those of one part come, they get theirs in the whole.
class Names {
 public:
  Names(std::vector<std::string>& names, std::vector<std::int64_t>& labels) : names_(names), labels_(labels) {
    for (std::uint32_t n = 0; n < names.size(); ++n) known_.try_emplace(names[n], n);
  }

  void next_part(const std::vector<std::string>& names, const std::vector<std::int64_t>& labels) {
    of_part_ = &names, labels_of_part_ = &labels;
    here_.clear();
  }
  std::uint32_t operator()(std::uint32_t n) {
    const auto [at, is_new] = here_.try_emplace(n, static_cast<std::uint32_t>(names_.size()));
    if (!is_new) return at->second;
    const std::string name = n < of_part_->size() ? (*of_part_)[n] : std::string();
    if (const auto known = known_.find(name); known != known_.end()) return at->second = known->second;
    if (!name.empty()) known_.emplace(name, at->second);
    names_.push_back(name);
    add_label(n);
    return at->second;
  }

 private:
  /// Where another name has the number already, the next one behind all.
  void add_label(std::uint32_t n) {
    if (labels_of_part_->empty()) return;
    const std::int64_t label = label_at(*labels_of_part_, n);
    const bool is_taken = std::ranges::find(labels_, label) != labels_.end();
    labels_.push_back(is_taken ? label_at(labels_, labels_.size()) : label);
  }

  std::vector<std::string>& names_;
  std::vector<std::int64_t>& labels_;
  std::map<std::string, std::uint32_t> known_;
  std::map<std::uint32_t, std::uint32_t> here_;
  const std::vector<std::string>* of_part_ = nullptr;
  const std::vector<std::int64_t>* labels_of_part_ = nullptr;
};

VertexIndex corner_count(const TetMesh& mesh) {
  auto corners = static_cast<VertexIndex>(mesh.points.size());
  for (const auto& mids : mesh.mid_nodes) corners = std::min(corners, *std::ranges::min_element(mids));
  if (!mesh.high_nodes.empty()) corners = *std::ranges::min_element(mesh.high_nodes);
  return corners;
}

class Joining {
 public:
  explicit Joining(TetMesh named)
      : mesh_(std::move(named)),
        regions_(mesh_.region_names, mesh_.region_labels),
        patches_(mesh_.patch_names, mesh_.patch_labels),
        curves_(mesh_.curve_names, mesh_.curve_labels) {}

  TetMesh run(std::vector<TetMesh> parts) {
    place_points(parts);
    for (TetMesh& part : parts) fill_up(part);
    // Faces of the boundary come before those inside.
    for (const TetMesh& part : parts) outer_ += part.boundary.size();
    for (TetMesh& part : parts) add(part);
    append(mesh_.face_layers, inner_layers_);
    for (auto& [key, members] : sets_) {
      std::ranges::sort(members);
      mesh_.sets.push_back({key.first, key.second, std::move(members)});
    }
    std::ranges::stable_sort(mesh_.split_faces, {}, &SplitFace::patch);
    std::ranges::stable_sort(mesh_.opened_contacts, {}, &OpenedContact::first);
    return std::move(mesh_);
  }

 private:
  void place_points(std::vector<TetMesh>& parts) {
    std::vector<VertexIndex> corners;
    std::size_t all = 0;
    for (const TetMesh& part : parts) all += corners.emplace_back(corner_count(part));
    std::size_t corner = 0, mid = all;
    std::vector<Vec3> mids;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      std::vector<VertexIndex> number(parts[p].points.size());
      for (VertexIndex v = 0; v < number.size(); ++v) {
        number[v] = static_cast<VertexIndex>(v < corners[p] ? corner++ : mid++);
        (v < corners[p] ? mesh_.points : mids).push_back(parts[p].points[v]);
      }
      renumber_vertices(parts[p], number);
    }
    append(mesh_.points, mids);
  }

  /// What may be left out of one part, and not of another.
  static void fill_up(TetMesh& part) {
    part.region.resize(part.tets.size(), 0);
    part.patch.resize(part.boundary.size(), 0);
    part.interface_patch.resize(part.interfaces.size(), 0);
    part.curve.resize(part.curve_edges.size(), 0);
    part.source.resize(part.boundary.size(), kNone);
    part.face_layers.resize(part.boundary.size() + part.interfaces.size(), kNone);
  }

  void add(const TetMesh& part) {
    regions_.next_part(part.region_names, part.region_labels);
    patches_.next_part(part.patch_names, part.patch_labels);
    curves_.next_part(part.curve_names, part.curve_labels);
    add_sets(part);
    for (const WideCell& cell : part.wide_cells)
      mesh_.wide_cells.push_back({cell.first + count(mesh_.tets), cell.tet_count, cell.nodes});
    for (const WideFace& face : part.wide_faces)
      mesh_.wide_faces.push_back({face.first + count(mesh_.boundary), face.nodes});
    append(mesh_.tets, part.tets), append(mesh_.mid_nodes, part.mid_nodes);
    append(mesh_.high_nodes, part.high_nodes), mesh_.high_order = part.high_order;
    append(mesh_.boundary, part.boundary), append(mesh_.source, part.source);
    append(mesh_.interfaces, part.interfaces), append(mesh_.curve_edges, part.curve_edges);
    const auto inner = part.face_layers.begin() + std::ssize(part.boundary);
    mesh_.face_layers.insert(mesh_.face_layers.end(), part.face_layers.begin(), inner);
    inner_layers_.insert(inner_layers_.end(), inner, part.face_layers.end());
    for (const std::uint32_t r : part.region) mesh_.region.push_back(regions_(r));
    for (const std::uint32_t p : part.patch) mesh_.patch.push_back(patches_(p));
    for (const std::uint32_t p : part.interface_patch) mesh_.interface_patch.push_back(patches_(p));
    for (const std::uint32_t c : part.curve) mesh_.curve.push_back(curves_(c));
    for (const SplitFace& face : part.split_faces) mesh_.split_faces.push_back({face.nodes, patches_(face.patch)});
    for (const auto& [first, second, conforming] : part.opened_contacts)
      mesh_.opened_contacts.push_back({patches_(first), patches_(second), conforming});
  }

  void add_sets(const TetMesh& part) {
    for (const NamedSet& set : part.sets) {
      std::vector<std::uint32_t>& members = sets_[{set.name, set.kind}];
      for (const std::uint32_t m : set.members) members.push_back(member_now(part, set.kind, m));
    }
  }

  std::uint32_t member_now(const TetMesh& part, Kind kind, std::uint32_t m) const {
    if (kind == Kind::kNodes) return m;
    if (kind == Kind::kEdges) return m + count(mesh_.curve_edges);
    if (kind == Kind::kElements) return m + count(mesh_.tets);
    if (m < part.boundary.size()) return m + count(mesh_.boundary);
    return static_cast<std::uint32_t>(m - part.boundary.size() + outer_) + count(mesh_.interfaces);
  }

  template <class T>
  static std::uint32_t count(const std::vector<T>& list) {
    return static_cast<std::uint32_t>(list.size());
  }

  TetMesh mesh_;
  Names regions_, patches_, curves_;
  std::size_t outer_ = 0;
  std::vector<std::uint32_t> inner_layers_;
  std::map<std::pair<std::string, Kind>, std::vector<std::uint32_t>> sets_;
};

}  // namespace

TetMesh joined_meshes(std::vector<TetMesh> parts, TetMesh named) {
  const bool has_layers = std::ranges::any_of(parts, [](const TetMesh& part) { return !part.face_layers.empty(); });
  const bool has_sources = std::ranges::any_of(parts, [](const TetMesh& part) { return !part.source.empty(); });
  TetMesh mesh = Joining(std::move(named)).run(std::move(parts));
  if (!has_layers) mesh.face_layers.clear();
  if (!has_sources) mesh.source.clear();
  return mesh;
}

}  // namespace octafront
