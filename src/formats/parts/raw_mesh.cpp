#include "formats/parts/raw_mesh.h"

#include "base/core/renumber.h"
#include "base/geometry/predicates.h"
#include "base/geometry/tet_lattice.h"
#include "base/mesh/adjacency.h"
#include "base/mesh/face_table.h"
#include "base/mesh/label_at.h"
#include "formats/parts/boundary.h"
#include "formats/parts/mesh_parts.h"
#include "formats/parts/wide_reading.h"

#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

/// From references of a file to numbers from 0.
class Numbering {
 public:
  /// `may_keep`: references may become numbers that have gaps.
  explicit Numbering(const std::vector<std::int64_t>& refs, bool may_keep = true) {
    // Consecutive elements mostly share a reference: equal neighbours are passed over before sorting.
    for (const std::int64_t r : refs)
      if (sorted_.empty() || sorted_.back() != r) sorted_.push_back(r);
    std::sort(sorted_.begin(), sorted_.end());
    sorted_.erase(std::unique(sorted_.begin(), sorted_.end()), sorted_.end());
    constexpr std::int64_t kMostKept = 1 << 20;  // what follows may keep a table of them
    keeps_ = may_keep && (sorted_.empty() || (sorted_.front() >= 1 && sorted_.back() <= kMostKept));
  }

  std::uint32_t number(std::int64_t ref) const {
    if (keeps_) return static_cast<std::uint32_t>(ref - 1);
    return static_cast<std::uint32_t>(std::lower_bound(sorted_.begin(), sorted_.end(), ref) - sorted_.begin());
  }
  bool has(std::int64_t ref) const { return std::binary_search(sorted_.begin(), sorted_.end(), ref); }
  std::uint32_t unused() const { return sorted_.empty() ? 0 : number(sorted_.back()) + 1; }
  /// Of the numbers; empty if each is one less than its reference.
  std::vector<std::int64_t> labels() const { return keeps_ ? std::vector<std::int64_t>() : sorted_; }

 private:
  std::vector<std::int64_t> sorted_;
  bool keeps_;
};

using Kind = NamedSet::Kind;

/// Numbers and names of regions, patches or curves, of the elements of the file.
struct Numbered {
  std::vector<std::uint32_t> numbers;  ///< one per element of the file; kNone: in no group
  std::vector<std::string> names;
  std::uint32_t next = 0;  ///< a number that is free
  std::vector<std::int64_t> labels = {};
};

void set_name(std::vector<std::string>& names, std::uint32_t number, const std::string& name) {
  if (name.empty()) return;
  if (number >= names.size()) names.resize(number + 1);
  names[number] = name;
}

Numbered by_reference(const std::vector<std::int64_t>& refs, const std::map<std::int64_t, std::string>& names) {
  const Numbering numbering(refs);
  Numbered out;
  out.numbers.reserve(refs.size());
  for (const std::int64_t r : refs) out.numbers.push_back(numbering.number(r));
  for (const auto& [ref, name] : names)
    if (numbering.has(ref)) set_name(out.names, numbering.number(ref), name);
  out.next = numbering.unused();
  out.labels = numbering.labels();
  return out;
}

/// Groups that overlap no earlier one become numbers, and leave the list.
Numbered by_groups(std::vector<RawMesh::Group>& groups, Kind kind, std::size_t elements) {
  Numbered out;
  out.numbers.assign(elements, kNone);
  std::erase_if(groups, [&](const RawMesh::Group& group) {
    const auto taken = [&](std::uint32_t m) { return out.numbers[m] != kNone; };
    const auto& members = group.members;
    if (group.kind != kind || members.empty() || std::any_of(members.begin(), members.end(), taken)) return false;
    for (const std::uint32_t m : members) out.numbers[m] = out.next;
    set_name(out.names, out.next++, group.name);
    return true;
  });
  return out;
}

/// A name that writers make where there is none is none.
void forget_default_names(std::vector<std::string>& names, Part::Origin origin, bool only) {
  for (std::uint32_t n = 0; n < names.size(); ++n)
    if (names[n] == default_name(origin, n, only)) names[n].clear();
  while (!names.empty() && names.back().empty()) names.pop_back();
}

void forget_zeros(std::vector<std::uint32_t>& numbers) {
  if (std::all_of(numbers.begin(), numbers.end(), [](std::uint32_t n) { return n == 0; })) numbers.clear();
}

bool has_none(std::span<const std::uint32_t> row) {
  return std::find(row.begin(), row.end(), kNone) != row.end();
}

void note_divided(RawMesh& raw) {
  if (raw.hexahedra > 0)
    raw.notes.push_back(fmt::format(
        "{} hexahedra were divided into tetrahedra, six each where none of their edges is a point", raw.hexahedra));
}

/// Of second order all or none.
void check_mid_nodes(RawMesh& raw, const Input& input) {
  auto& mids = raw.mid_nodes;
  const auto lacks = [](const auto& row) { return has_none(row); };
  if (mids.empty()) return;
  if (mids.size() < raw.tets.size() || std::any_of(mids.begin(), mids.end(), lacks)) {
    raw.notes.emplace_back("tetrahedra with and without mid-side nodes are mixed: all are taken as linear");
    mids.clear();
  }
  enum : char { kUnused, kCorner };
  std::vector<char> use(raw.points.size(), kUnused);
  for (const Tet& t : raw.tets)
    for (const VertexIndex v : t) use[v] = kCorner;
  for (std::size_t t = 0; t < mids.size(); ++t)
    for (const VertexIndex v : mids[t])
      if (use[v] == kCorner)
        input.fail(
            fmt::format("the node {} (counted from 0) is a corner of one tetrahedron and a mid-side node of "
                        "tetrahedron {}; the file is damaged: export it again",
                        v, t));
}

/// The nodes inside each edge and face of an element, from the least corner on, behind these corners.
template <std::size_t kCorners, class Parts>
std::vector<std::array<VertexIndex, kCorners + 3>> rows_of_parts(const RawMesh& raw, const Parts& parts) {
  const int order = static_cast<int>(raw.high_order);
  const TetLattice& lattice = tet_lattice(order);
  const std::size_t inside = kCorners == 2 ? nodes_in_edge(order) : nodes_in_face(order);
  std::vector<std::array<VertexIndex, kCorners + 3>> rows;
  rows.reserve(raw.tets.size() * parts.size());
  for (std::size_t t = 0; t < raw.tets.size(); ++t)
    for (auto part : parts) {
      std::ranges::sort(part, {}, [&](int k) { return raw.tets[t][static_cast<std::size_t>(k)]; });
      std::array<VertexIndex, kCorners + 3>& row = rows.emplace_back();
      row.fill(kNone);
      for (std::size_t i = 0; i < kCorners; ++i) row[i] = raw.tets[t][static_cast<std::size_t>(part[i])];
      for (std::size_t k = 0; k < inside; ++k) {
        TetLattice::Weights w{};
        for (const int c : part) w[static_cast<std::size_t>(c)] = 1;
        if (kCorners == 2) w[static_cast<std::size_t>(part[1])] = static_cast<std::int8_t>(k + 1);
        const std::size_t most = kCorners == 2 ? 0 : k;
        w[static_cast<std::size_t>(part[most])] = 0;
        w[static_cast<std::size_t>(part[most])] = static_cast<std::int8_t>(order - w[0] - w[1] - w[2] - w[3]);
        row[kCorners + k] = raw.high_nodes[t * (lattice.size() - 4) + lattice.at(w) - 4];
      }
    }
  std::ranges::sort(rows);
  return rows;
}

template <std::size_t kCorners, class Parts>
void check_nodes_of_parts(const RawMesh& raw, const Parts& parts, const Input& input) {
  const auto rows = rows_of_parts<kCorners>(raw, parts);
  const auto differ = std::ranges::adjacent_find(rows, [](const auto& a, const auto& b) {
    return std::equal(a.begin(), a.begin() + kCorners, b.begin()) && a != b;
  });
  if (differ != rows.end())
    input.fail(
        fmt::format("two tetrahedra have other nodes on the {} between {} and {} (counted from 0), which they "
                    "share; the file is damaged: export it again",
                    kCorners == 2 ? "edge" : "face", (*differ)[0], (*differ)[1]));
}

/// Of one order all or none, and the same nodes where they meet.
void check_high_nodes(RawMesh& raw, const Input& input) {
  if (raw.high_order == 0) return;
  const std::size_t each = nodes_of_tet(static_cast<int>(raw.high_order)) - 4;
  if (raw.high_nodes.size() != raw.tets.size() * each || !raw.mid_nodes.empty()) {
    raw.notes.emplace_back("tetrahedra of several orders are mixed: all are taken as linear");
    raw.high_nodes.clear(), raw.mid_nodes.clear();
    raw.high_order = 0;
    return;
  }
  std::vector<bool> is_corner(raw.points.size(), false);
  for (const Tet& t : raw.tets)
    for (const VertexIndex v : t) is_corner[v] = true;
  for (std::size_t i = 0; i < raw.high_nodes.size(); ++i)
    if (is_corner[raw.high_nodes[i]])
      input.fail(
          fmt::format("the node {} (counted from 0) is a corner of one tetrahedron and a further node of "
                      "tetrahedron {}; the file is damaged: export it again",
                      raw.high_nodes[i], i / each));
  check_nodes_of_parts<2>(raw, kTetEdges, input);
  check_nodes_of_parts<3>(raw, kTetFaces, input);
}

/// Corners 2 and 3 change places.
void turn_high_nodes(std::span<VertexIndex> nodes, int order) {
  const TetLattice& lattice = tet_lattice(order);
  const std::vector<VertexIndex> before(nodes.begin(), nodes.end());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    TetLattice::Weights w = lattice.weights(4 + k);
    std::swap(w[2], w[3]);
    nodes[lattice.at(w) - 4] = before[k];
  }
}

/// Points that are gone are one behind all.
std::vector<Triangle> clamped_triangles(const RawMesh& raw, std::size_t points) {
  std::vector<Triangle> all = raw.triangles;
  for (Triangle& t : all)
    for (VertexIndex& v : t) v = std::min(v, static_cast<VertexIndex>(points));
  return all;
}

/// Faces that are there several times, as sides of elements in several groups, become one.
void merge_equal_triangles(RawMesh& raw, std::size_t points) {
  const FaceTable table = face_table(points + 1, clamped_triangles(raw, points));
  std::vector<std::uint32_t> first(raw.triangles.size());
  table.for_each_group([&](const Triangle&, std::span<const FaceTable::Entry> same) {
    for (const FaceTable::Entry& entry : same) first[entry.face] = same.front().face;
  });
  for (RawMesh::Group& group : raw.groups)
    if (group.kind == Kind::kFaces)
      for (std::uint32_t& m : group.members) m = first[m];
}

/// Brings a file's mesh in order, step by step.
class Ordering {
 public:
  Ordering(RawMesh&& raw, const Input& input) : raw_(std::move(raw)), input_(input) {}

  MeshFile result() {
    require_tets();
    for (const auto step :
         {&Ordering::match_wide_cells, &Ordering::number_points, &Ordering::take_tets, &Ordering::take_wide_cells,
          &Ordering::take_faces, &Ordering::take_edges, &Ordering::take_sets, &Ordering::take_periods}) {
      input_.context.check();
      (this->*step)();
    }
    note_divided(raw_);
    if (raw_.other_elements > 0)
      raw_.notes.push_back(fmt::format("{} elements of other kinds were left out", raw_.other_elements));
    return {std::move(mesh_), std::move(raw_.format), std::move(raw_.notes), turned_, turned_wide_};
  }

 private:
  void require_tets() const {
    if (!raw_.tets.empty()) return;
    input_.fail(raw_.other_elements + raw_.triangles.size() > 0
                    ? fmt::format("holds no tetrahedra, only {} triangles and {} elements of other kinds",
                                  raw_.triangles.size(), raw_.other_elements)
                    : "holds no tetrahedra");
  }

  void match_wide_cells() {
    divide_like_wide_cells(raw_);
    add_diagonals(raw_);
    check_mid_nodes(raw_, input_);
    check_high_nodes(raw_, input_);
  }

  /// Corners first, then mid-side nodes; unused ones go.
  void number_points() {
    const std::size_t n = raw_.points.size();
    std::vector<char> use(n, 0);
    for (const Tet& t : raw_.tets)
      for (const VertexIndex v : t) use[v] = 1;
    for (const auto& mids : raw_.mid_nodes)
      for (const VertexIndex v : mids) use[v] = 2;
    for (const VertexIndex v : raw_.high_nodes) use[v] = 2;
    number_.assign(n, kNone);
    for (const char wanted : {1, 2})
      for (VertexIndex v = 0; v < n; ++v) {
        if (use[v] != wanted) continue;
        number_[v] = static_cast<VertexIndex>(mesh_.points.size());
        mesh_.points.push_back(raw_.points[v]);
      }
    renumber(raw_.tets, number_);
    renumber(raw_.mid_nodes, number_);
    for (VertexIndex& v : raw_.high_nodes) v = number_[v];
    // Triangles and edges at dropped points bound no tetrahedron; they go with what does not match.
    renumber(raw_.triangles, number_);
    renumber(raw_.edges, number_);
    renumber_wide(raw_, number_);
    std::vector<Vec3>().swap(raw_.points);
  }

  void take_tets() {
    mesh_.tets = std::move(raw_.tets);
    mesh_.mid_nodes = std::move(raw_.mid_nodes);
    mesh_.high_nodes = std::move(raw_.high_nodes), mesh_.high_order = raw_.high_order;
    const std::size_t each = mesh_.high_nodes_per_tet();
    is_turned_.assign(mesh_.tets.size(), false);
    const auto& p = mesh_.points;
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      auto& [a, b, c, d] = mesh_.tets[t];
      if (orient3d(p[a], p[b], p[c], p[d]) >= 0) continue;
      is_turned_[t] = true;
      std::swap(c, d);
      turn_high_nodes(std::span(mesh_.high_nodes).subspan(t * each, each), mesh_.order());
      if (mesh_.mid_nodes.empty()) continue;
      auto& m = mesh_.mid_nodes[t];
      std::swap(m[1], m[2]);
      std::swap(m[3], m[4]);
    }
    Numbered regions = raw_.tet_ref.empty() ? by_groups(raw_.groups, Kind::kElements, mesh_.tets.size())
                                            : by_reference(raw_.tet_ref, raw_.region_names);
    for (std::uint32_t& n : regions.numbers)
      if (n == kNone) n = regions.next;
    mesh_.region = std::move(regions.numbers);
    forget_zeros(mesh_.region);
    mesh_.region_names = std::move(regions.names);
    mesh_.region_labels = std::move(regions.labels);
    if (!raw_.region_labels.empty() && !mesh_.region.empty()) take_region_labels();
    const bool only =
        std::adjacent_find(mesh_.region.begin(), mesh_.region.end(), std::not_equal_to<>()) == mesh_.region.end();
    forget_default_names(mesh_.region_names, Part::Origin::kRegion, only);
  }

  /// Where the file has labels beside the references of regions.
  void take_region_labels() {
    std::vector<std::int64_t> labels(1 + *std::max_element(mesh_.region.begin(), mesh_.region.end()));
    for (std::size_t n = 0; n < labels.size(); ++n) labels[n] = static_cast<std::int64_t>(n) + 1;
    for (std::size_t t = 0; t < mesh_.region.size(); ++t) {
      const auto label = raw_.region_labels.find(raw_.tet_ref[t]);
      if (label != raw_.region_labels.end()) labels[mesh_.region[t]] = label->second;
    }
    mesh_.region_labels = std::move(labels);
  }

  /// Programs differ in which way the triangles of a wedge face: a file whose wedges are all the other way round has
  /// that convention, and nothing is inverted.
  void take_wide_cells() {
    mesh_.wide_cells = std::move(raw_.wide_cells);
    std::size_t wedges = 0;
    turned_wide_ = turn_wide_cells(mesh_.wide_cells, is_turned_, wedges);
    if (wedges > 0)
      raw_.notes.push_back(fmt::format("{} wedges face the other way here, as all in this file: turned", wedges));
    turned_ = static_cast<std::uint64_t>(std::count(is_turned_.begin(), is_turned_.end(), true));
    if (turned_ > 0) raw_.notes.push_back(fmt::format("{} inverted tetrahedra were turned", turned_));
  }

  /// The triangles of the file where they are faces of the boundary, in their order, then what is missing; those
  /// between two tetrahedra are interfaces.
  void take_faces() {
    if (raw_.triangle_ref.empty()) merge_equal_triangles(raw_, mesh_.points.size());
    Numbered patches = raw_.triangle_ref.empty() ? by_groups(raw_.groups, Kind::kFaces, raw_.triangles.size())
                                                 : by_reference(raw_.triangle_ref, raw_.surface_names);
    // Without any group a triangle says no more than that it is there.
    const std::uint32_t free = patches.next;
    face_of_.assign(raw_.triangles.size(), kNone);
    std::vector<std::uint32_t> inside;
    const SidesOfWideCells sides(mesh_);
    take_boundary(patches, free, inside, sides);
    take_wide_faces(sides);
    take_interfaces(patches, free, inside);
    forget_zeros(mesh_.patch);
    forget_zeros(mesh_.interface_patch);
    mesh_.patch_names = std::move(patches.names);
    mesh_.patch_labels = std::move(patches.labels);
    forget_default_names(mesh_.patch_names, Part::Origin::kPatch, false);
  }

  void take_boundary(const Numbered& patches, std::uint32_t free, std::vector<std::uint32_t>& inside,
                     const SidesOfWideCells& sides) {
    // Sorted by vertices already.
    std::vector<Triangle> faces = boundary_of(mesh_.tets, mesh_.points.size());
    std::vector<std::uint32_t> taken_by(faces.size(), kNone);
    const auto patch_of = [&](std::size_t i) { return patches.numbers[i] == kNone ? free : patches.numbers[i]; };
    for (std::uint32_t i = 0; i < raw_.triangles.size(); ++i) {
      if (has_none(raw_.triangles[i])) continue;
      const Triangle key = face_key(raw_.triangles[i]);
      const auto at = std::lower_bound(faces.begin(), faces.end(), key,
                                       [](const Triangle& f, const Triangle& k) { return face_key(f) < k; });
      if (at == faces.end() || face_key(*at) != key) {
        inside.push_back(i);
        continue;
      }
      std::uint32_t& taken = taken_by[static_cast<std::size_t>(at - faces.begin())];
      face_of_[i] = taken == kNone ? static_cast<std::uint32_t>(mesh_.boundary.size()) : taken;
      if (taken != kNone) continue;
      taken = face_of_[i];
      // Keep the corner that the file has first, so that a triangle that faces outward already stays as it is.
      Triangle outward = *at;
      while (outward[0] != raw_.triangles[i][0]) std::rotate(outward.begin(), outward.begin() + 1, outward.end());
      mesh_.boundary.push_back(outward);
      mesh_.patch.push_back(patch_of(i));
      if (!raw_.triangle_source.empty()) mesh_.source.push_back(raw_.triangle_source[i]);
      if (!raw_.triangle_layers.empty()) mesh_.face_layers.push_back(raw_.triangle_layers[i]);
    }
    const std::size_t given = mesh_.boundary.size();
    const auto add = [&](std::size_t f) {
      taken_by[f] = static_cast<std::uint32_t>(mesh_.boundary.size());
      mesh_.boundary.push_back(faces[f]);
      mesh_.patch.push_back(free);
      if (!raw_.triangle_source.empty()) mesh_.source.push_back(kNone);
      if (!raw_.triangle_layers.empty()) mesh_.face_layers.push_back(kNone);
    };
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if (taken_by[f] != kNone) continue;
      add(f);
      const std::size_t other = sides.other_half(faces, f);
      if (other >= faces.size() || taken_by[other] != kNone) continue;
      mesh_.wide_faces.push_back({taken_by[f], sides.around(faces[f])});
      add(other);
    }
    if (given > 0 && given < mesh_.boundary.size())
      raw_.notes.push_back(
          fmt::format("{} boundary faces that the file lacks were added", mesh_.boundary.size() - given));
  }

  /// Quadrilaterals of the file that are sides of wedges and pyramids, and whose triangles still follow each other.
  void take_wide_faces(const SidesOfWideCells& sides) {
    std::vector<WideFace> given;
    for (const WideFace& face : raw_.wide_faces) {
      const std::uint32_t first = face_of_[face.first], second = face_of_[face.first + 1];
      if (first >= mesh_.boundary.size() || second != first + 1) continue;
      if (const auto outward = sides.outward(face.nodes)) given.push_back({first, *outward});
    }
    mesh_.wide_faces.insert(mesh_.wide_faces.end(), given.begin(), given.end());
    std::sort(mesh_.wide_faces.begin(), mesh_.wide_faces.end(),
              [](const WideFace& a, const WideFace& b) { return a.first < b.first; });
    const auto again = [](const WideFace& a, const WideFace& b) { return b.first < a.first + 2; };
    mesh_.wide_faces.erase(std::unique(mesh_.wide_faces.begin(), mesh_.wide_faces.end(), again),
                           mesh_.wide_faces.end());
  }

  void take_interfaces(const Numbered& patches, std::uint32_t free, const std::vector<std::uint32_t>& inside) {
    std::vector<Triangle> faces;
    for (const std::uint32_t i : inside) faces.push_back(raw_.triangles[i]);
    const FaceTable table = face_table(mesh_.points.size(), faces);
    std::vector<std::uint8_t> tets(faces.size(), 0);
    for (const Tet& t : mesh_.tets)
      for (int i = 0; i < 4; ++i)
        for (const FaceTable::Entry& listed : table.group_of(face_of(t, i))) ++tets[listed.face];
    std::size_t dropped = 0;
    for (std::size_t k = 0; k < inside.size(); ++k) {
      dropped += tets[k] < 2;
      if (tets[k] < 2) continue;
      // A triangle that is there twice is taken once.
      const std::uint32_t first = table.group_of(faces[k]).front().face, i = inside[k];
      if (first < k) {
        face_of_[i] = face_of_[inside[first]];
        continue;
      }
      face_of_[i] = static_cast<std::uint32_t>(mesh_.boundary.size() + mesh_.interfaces.size());
      mesh_.interfaces.push_back(faces[k]);
      mesh_.interface_patch.push_back(patches.numbers[i] == kNone ? free : patches.numbers[i]);
      if (!raw_.triangle_layers.empty()) mesh_.face_layers.push_back(raw_.triangle_layers[i]);
    }
    if (dropped > 0) raw_.notes.push_back(fmt::format("{} triangles that bound no tetrahedron were left out", dropped));
  }

  void take_edges() {
    Numbered curves = raw_.edge_ref.empty() ? by_groups(raw_.groups, Kind::kEdges, raw_.edges.size())
                                            : by_reference(raw_.edge_ref, raw_.curve_names);
    edge_of_.assign(raw_.edges.size(), kNone);
    if (raw_.edges.empty()) return;
    std::vector<std::pair<Edge, std::uint32_t>> wanted;
    std::vector<bool> marked(mesh_.points.size(), false);
    for (std::uint32_t i = 0; i < raw_.edges.size(); ++i) {
      auto [a, b] = raw_.edges[i];
      if (a == kNone || b == kNone || a == b) continue;
      marked[a] = marked[b] = true;
      wanted.push_back({{std::min(a, b), std::max(a, b)}, i});
    }
    std::sort(wanted.begin(), wanted.end());
    const std::vector<bool> is_edge = edges_of_tets(wanted, marked);
    // The first of equal ones, in the order of the file.
    std::vector<std::uint32_t> first(raw_.edges.size(), kNone);
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      if (!is_edge[k]) continue;
      const bool again = k > 0 && wanted[k].first == wanted[k - 1].first;
      first[wanted[k].second] = again ? first[wanted[k - 1].second] : wanted[k].second;
    }
    for (std::uint32_t i = 0; i < raw_.edges.size(); ++i) {
      if (first[i] == kNone) continue;
      edge_of_[i] = first[i] == i ? static_cast<std::uint32_t>(mesh_.curve_edges.size()) : edge_of_[first[i]];
      if (first[i] != i) continue;
      mesh_.curve_edges.push_back(raw_.edges[i]);
      mesh_.curve.push_back(curves.numbers[i] == kNone ? curves.next : curves.numbers[i]);
    }
    const auto dropped = std::count(first.begin(), first.end(), kNone);
    if (dropped > 0) raw_.notes.push_back(fmt::format("{} edges of no tetrahedron were left out", dropped));
    forget_zeros(mesh_.curve);
    mesh_.curve_names = std::move(curves.names);
    mesh_.curve_labels = std::move(curves.labels);
    forget_default_names(mesh_.curve_names, Part::Origin::kCurve, false);
  }

  std::vector<bool> edges_of_tets(const std::vector<std::pair<Edge, std::uint32_t>>& wanted,
                                  const std::vector<bool>& marked) const {
    std::vector<bool> found(wanted.size(), false);
    for (const Tet& t : mesh_.tets)
      for (const auto& [i, j] : kTetEdges) {
        const VertexIndex a = t[static_cast<std::size_t>(i)], b = t[static_cast<std::size_t>(j)];
        if (!marked[a] || !marked[b]) continue;
        const std::pair<Edge, std::uint32_t> key{{std::min(a, b), std::max(a, b)}, 0};
        for (auto at = std::lower_bound(wanted.begin(), wanted.end(), key);
             at != wanted.end() && at->first == key.first; ++at)
          found[static_cast<std::size_t>(at - wanted.begin())] = true;
      }
    return found;
  }

  void take_sets() {
    // Sets of nodes come last: what they may repeat must be there.
    for (RawMesh::Group& group : raw_.groups)
      if (group.kind != Kind::kNodes) take_set(group);
    const auto is_of_nodes = [](const RawMesh::Group& group) { return group.kind == Kind::kNodes; };
    if (std::none_of(raw_.groups.begin(), raw_.groups.end(), is_of_nodes)) return;
    const MeshParts parts(mesh_);
    for (RawMesh::Group& group : raw_.groups)
      if (is_of_nodes(group)) take_set(group, &parts);
  }

  /// Pairs of nodes that are left; periods without any go.
  void take_periods() {
    bool turns = false;
    const std::array<Vec3, 3> unit{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (const RawMesh::Period& period : raw_.periods) {
      const auto number = static_cast<std::uint32_t>(mesh_.periods.size());
      const std::size_t before = mesh_.periodic_nodes.size();
      for (const auto& [copy, original] : period.pairs)
        if (const VertexIndex a = number_[copy], b = number_[original]; a != kNone && b != kNone && a != b)
          mesh_.periodic_nodes.push_back({number, a, b});
      if (mesh_.periodic_nodes.size() == before) continue;
      mesh_.periods.push_back(period.shift);
      mesh_.period_rotations.push_back(period.rotation);
      turns = turns || period.rotation != unit;
    }
    if (!turns) mesh_.period_rotations.clear();
    auto& pairs = mesh_.periodic_nodes;
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  }

  void take_set(RawMesh::Group& group, const MeshParts* parts = nullptr) {
    const std::vector<std::uint32_t>* number = group.kind == Kind::kNodes   ? &number_
                                               : group.kind == Kind::kFaces ? &face_of_
                                               : group.kind == Kind::kEdges ? &edge_of_
                                                                            : nullptr;
    auto& members = group.members;
    if (number)
      for (std::uint32_t& m : members) m = (*number)[m];
    std::sort(members.begin(), members.end());
    members.erase(std::lower_bound(members.begin(), members.end(), kNone), members.end());
    members.erase(std::unique(members.begin(), members.end()), members.end());
    if (parts == nullptr || !is_implied(group, *parts))
      mesh_.sets.push_back({std::move(group.name), group.kind, std::move(members)});
  }

  /// Solvers want the nodes of patches as sets too: a set of nodes that a part of its name has anyhow says nothing new.
  static bool is_implied(const RawMesh::Group& group, const MeshParts& parts) {
    if (group.kind != Kind::kNodes) return false;
    return std::any_of(parts.parts().begin(), parts.parts().end(), [&](const Part& part) {
      return part.name == group.name && parts.nodes_of(part) == group.members;
    });
  }

  RawMesh raw_;
  const Input& input_;
  TetMesh mesh_;
  std::uint64_t turned_ = 0, turned_wide_ = 0;
  std::vector<bool> is_turned_;                   ///< per tetrahedron
  std::vector<VertexIndex> number_;               ///< of the points of the file
  std::vector<std::uint32_t> face_of_, edge_of_;  ///< of the triangles and edges of the file
};

}  // namespace

bool RawMesh::Field::offer(const Input& input, std::string_view name, std::uint64_t of_components) {
  if (input.field == nullptr) return false;
  const bool is_tensor = of_components == 6 || of_components == 9;
  const bool is_known = !input.wants_tensors   ? of_components == 1
                        : input.field->empty() ? is_tensor
                                               : of_components >= 1 && of_components <= 9;
  if (!is_known) return false;
  if (std::find(names.begin(), names.end(), name) == names.end()) names.emplace_back(name);
  const bool is_wanted = input.field->empty() ? names.size() == 1 : *input.field == name;
  if (is_wanted) components = of_components;
  return is_wanted;
}

void RawMesh::Field::take(std::span<const double> values, const RawMesh& raw) {
  const auto take_for = [&](std::size_t elements, std::vector<double>& taken) {
    while (taken.size() < elements * values.size()) taken.insert(taken.end(), values.begin(), values.end());
  };
  take_for(raw.tets.size(), at_tets), take_for(raw.triangles.size(), at_triangles);
}

void RawMesh::add_tet(std::span<const VertexIndex> nodes, std::int64_t ref, const MidOrder& order) {
  tets.push_back({nodes[0], nodes[1], nodes[2], nodes[3]});
  tet_ref.push_back(ref);
  const bool has_mids = nodes.size() >= 10;
  if (!has_mids && mid_nodes.empty()) return;
  std::array<VertexIndex, 6> mids;
  mids.fill(kNone);
  mid_nodes.resize(tets.size() - 1, mids);
  for (std::size_t i = 0; has_mids && i < 6; ++i) mids[order[i]] = nodes[4 + i];
  mid_nodes.push_back(mids);
}

void RawMesh::add_high_tet(std::span<const VertexIndex> nodes, std::int64_t ref) {
  add_tet(nodes.first(4), ref);
  const std::uint32_t order = nodes.size() == nodes_of_tet(3) ? 3 : 4;
  if (high_order != 0 && high_order != order) return;  // a file that mixes them has too few of either
  high_order = order;
  high_nodes.insert(high_nodes.end(), nodes.begin() + 4, nodes.end());
}

std::uint32_t RawMesh::add_face(std::span<const VertexIndex> nodes, std::int64_t ref) {
  const bool is_triangle = nodes.size() == 3 || nodes.size() == 6;
  if (is_triangle) {
    triangles.push_back({nodes[0], nodes[1], nodes[2]});
  } else {
    const double first = squared_length(points[nodes[2]] - points[nodes[0]]);
    const double second = squared_length(points[nodes[3]] - points[nodes[1]]);
    // Of equal ones that at the lowest node: whoever lists the face, and from wherever, divides it alike.
    const bool at_lowest = std::min(nodes[0], nodes[2]) < std::min(nodes[1], nodes[3]);
    const std::size_t k = first < second || (first == second && at_lowest) ? 0 : 1;
    wide_faces.push_back({static_cast<std::uint32_t>(triangles.size()), {nodes[0], nodes[1], nodes[2], nodes[3]}});
    triangles.push_back({nodes[k], nodes[k + 1], nodes[k + 2]});
    triangles.push_back({nodes[k], nodes[k + 2], nodes[(k + 3) % 4]});
  }
  triangle_ref.resize(triangles.size(), ref);
  return is_triangle ? 1 : 2;
}

MeshFile ordered_mesh(RawMesh raw, const Input& input) {
  return Ordering(std::move(raw), input).result();
}

namespace {

/// Labels that just count from 1 say nothing.
void forget_counting(std::vector<std::int64_t>& labels) {
  for (std::size_t n = 0; n < labels.size(); ++n)
    if (labels[n] != static_cast<std::int64_t>(n) + 1) return;
  labels.clear();
}

/// The labels of so many numbers.
std::vector<std::int64_t> labels_of_all(const std::vector<std::int64_t>& labels, std::size_t count) {
  std::vector<std::int64_t> all;
  for (std::size_t n = 0; n < count; ++n) all.push_back(label_at(labels, n));
  return all;
}

/// Regions numbered without gaps, each with its label.
void close_gaps(TetMesh& mesh) {
  if (mesh.region.empty()) return;
  const Numbering numbering(std::vector<std::int64_t>(mesh.region.begin(), mesh.region.end()), false);
  std::vector<std::string> names;
  std::vector<std::int64_t> labels;
  for (const std::int64_t r : numbering.labels()) {
    const auto n = static_cast<std::size_t>(r);
    names.push_back(n < mesh.region_names.size() ? mesh.region_names[n] : std::string());
    labels.push_back(label_at(mesh.region_labels, n));
  }
  for (std::uint32_t& r : mesh.region) r = numbering.number(r);
  mesh.region_names = std::move(names);
  forget_counting(labels);
  mesh.region_labels = std::move(labels);
  forget_zeros(mesh.region);
}

/// Faces between two regions that the mesh does not list are a patch behind all. Returns how many.
std::size_t add_missing_interfaces(TetMesh& mesh) {
  if (mesh.region.empty()) return 0;
  std::vector<Triangle> found;
  const FaceTable listed = face_table(mesh.points.size(), mesh.interfaces);
  half_face_table(mesh.tets, mesh.points.size())
      .for_each_group([&](const Triangle& key, std::span<const FaceTable::Entry> on_face) {
        if (on_face.size() != 2 || !listed.group_of(key).empty()) return;
        const std::uint32_t one = on_face[0].face, other = on_face[1].face;
        if (mesh.region[one / 4] != mesh.region[other / 4]) found.push_back(corners_of(mesh.tets, one));
      });
  if (found.empty()) return 0;
  std::uint32_t free = 1;
  for (const auto* patch : {&mesh.patch, &mesh.interface_patch})
    for (const std::uint32_t p : *patch) free = std::max(free, p + 1);
  mesh.interface_patch.resize(mesh.interfaces.size(), 0);
  mesh.interfaces.insert(mesh.interfaces.end(), found.begin(), found.end());
  mesh.interface_patch.resize(mesh.interfaces.size(), free);
  return found.size();
}

/// Boundary and interfaces of a mesh, with the regions on both sides. `by_references`: the numbers of patches mean
/// something.
SurfaceMesh walls_of(TetMesh mesh, bool by_references, std::vector<std::string>& notes) {
  close_gaps(mesh);
  if (const std::size_t added = add_missing_interfaces(mesh); added > 0)
    notes.push_back(fmt::format("{} faces between regions that the file lacks were added", added));
  SurfaceMesh surface;
  surface.triangles = std::move(mesh.boundary);
  surface.triangles.insert(surface.triangles.end(), mesh.interfaces.begin(), mesh.interfaces.end());
  const std::size_t outside = surface.triangles.size() - mesh.interfaces.size();
  if (!mesh.patch.empty() || !mesh.interface_patch.empty()) {
    surface.patch = std::move(mesh.patch);
    surface.patch.resize(outside, 0);
    surface.patch.insert(surface.patch.end(), mesh.interface_patch.begin(), mesh.interface_patch.end());
    surface.patch.resize(surface.triangles.size(), 0);
  }
  surface.sides.assign(surface.triangles.size(), {kNone, kNone});
  const FaceTable table = face_table(mesh.points.size(), surface.triangles);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (int i = 0; i < 4; ++i)
      for (const FaceTable::Entry& entry : table.group_of(face_of(mesh.tets[t], i))) {
        const auto& [a, b, c] = surface.triangles[entry.face];
        const auto& p = mesh.points;
        const int side = orient3d(p[a], p[b], p[c], p[mesh.tets[t][static_cast<std::size_t>(i)]]) > 0 ? 0 : 1;
        surface.sides[entry.face][static_cast<std::size_t>(side)] = mesh.region.empty() ? 0 : mesh.region[t];
      }
  surface.points = std::move(mesh.points);
  surface.patch_names = std::move(mesh.patch_names);
  surface.region_names = std::move(mesh.region_names);
  surface.region_labels = std::move(mesh.region_labels);
  const bool is_plain = std::all_of(surface.sides.begin(), surface.sides.end(), [](const Sides& s) {
    return s == Sides{kNone, 0};
  });
  if (is_plain) surface.sides.clear();
  // Patches of a complex are divided by their sides, and each piece keeps the number.
  if (!is_plain && by_references && !surface.patch.empty())
    mesh.patch_labels =
        labels_of_all(mesh.patch_labels, 1 + *std::max_element(surface.patch.begin(), surface.patch.end()));
  surface.patch_labels = std::move(mesh.patch_labels);
  return surface;
}

void note_curves(std::size_t edges, std::vector<std::string>& notes) {
  if (edges > 0)
    notes.push_back(fmt::format("{} edges of lines are left out: a surface has none but where patches meet", edges));
}

/// Groups of a file without tetrahedra.
std::vector<PlacedSet> placed_groups(const RawMesh& raw) {
  std::vector<PlacedSet> sets;
  for (const RawMesh::Group& group : raw.groups) {
    PlacedSet set{group.name, group.kind, {}};
    const auto add = [&](const auto& row) {
      for (const VertexIndex v : row) set.places.push_back(raw.points[v]);
    };
    for (const std::uint32_t m : group.members) {
      if (group.kind == Kind::kNodes) set.places.push_back(raw.points[m]);
      if (group.kind == Kind::kEdges) add(raw.edges[m]);
      if (group.kind == Kind::kFaces) add(raw.triangles[m]);
    }
    if (!set.places.empty()) sets.push_back(std::move(set));
  }
  return sets;
}

}  // namespace

SurfaceFile surface_of(RawMesh raw, const Input& input) {
  if (!raw.tets.empty()) {
    const bool by_references = !raw.triangle_ref.empty();
    MeshFile file = ordered_mesh(std::move(raw), input);
    std::vector<PlacedSet> sets = placed_sets(file.mesh);
    note_curves(file.mesh.curve_edges.size(), file.notes);
    file.notes.push_back(fmt::format("boundary and interfaces of {} tetrahedra taken", file.mesh.tets.size()));
    if (file.mesh.is_second_order()) file.notes.emplace_back("mid-side nodes are left out: surfaces are linear");
    SurfaceMesh walls = walls_of(std::move(file.mesh), by_references, file.notes);
    return {std::move(walls), file.format, std::move(file.notes), {}, {}, std::move(sets)};
  }
  if (raw.triangles.empty())
    input.fail(fmt::format("holds no triangles ({} elements of other kinds): there is no surface to mesh",
                           raw.other_elements));
  SurfaceFile file;
  Numbered patches = raw.triangle_ref.empty() ? by_groups(raw.groups, Kind::kFaces, raw.triangles.size())
                                              : by_reference(raw.triangle_ref, raw.surface_names);
  for (std::uint32_t& n : patches.numbers)
    if (n == kNone) n = patches.next;
  forget_zeros(patches.numbers);
  file.sets = placed_groups(raw);
  file.surface.points = std::move(raw.points);
  file.surface.triangles = std::move(raw.triangles);
  file.surface.patch = std::move(patches.numbers);
  file.surface.patch_names = std::move(patches.names);
  file.surface.patch_labels = std::move(patches.labels);
  forget_default_names(file.surface.patch_names, Part::Origin::kPatch, false);
  file.format = std::move(raw.format);
  file.notes = std::move(raw.notes);
  note_curves(raw.edges.size(), file.notes);
  if (raw.other_elements > 0)
    file.notes.push_back(fmt::format("{} elements of other kinds were left out", raw.other_elements));
  return file;
}

}  // namespace octafront::io
