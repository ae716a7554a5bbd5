
#include "formats/parts/mesh_parts.h"

#include <octafront/io.h>

#include "base/core/parallel_arrays.h"
#include "base/core/shared_value.h"
#include "base/mesh/face_table.h"

#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace octafront::io {
namespace {

constexpr std::array kOrigins{Part::Origin::kRegion, Part::Origin::kPatch, Part::Origin::kCurve};

std::size_t corner_count(const TetMesh& mesh) {
  if (mesh.order() == 1) return mesh.points.size();
  VertexIndex corners = 0;
  for (const Tet& t : mesh.tets) corners = std::max(corners, 1 + *std::max_element(t.begin(), t.end()));
  return corners;
}

const TetMesh& empty_mesh() {
  static const TetMesh kEmpty;
  return kEmpty;
}

}  // namespace

std::string default_name(Part::Origin origin, std::uint32_t number, bool only) {
  switch (origin) {
    case Part::Origin::kRegion:
      return only ? "body" : "body_" + std::to_string(number + 1);
    case Part::Origin::kPatch:
      return "patch_" + std::to_string(number + 1);
    case Part::Origin::kCurve:
      return "curve_" + std::to_string(number + 1);
    default:
      return "set_" + std::to_string(number + 1);
  }
}

MeshParts::MeshParts(const TetMesh& mesh, Hidden hidden)
    : mesh_(mesh),
      hidden_(hidden),
      second_order_(mesh.is_second_order() && !hidden.mid_nodes),
      order_(hidden.mid_nodes ? 1 : mesh.order()),
      points_(hidden.mid_nodes ? corner_count(mesh) : mesh.points.size() - hidden.last_points),
      mids_(second_order_ ? mesh : empty_mesh()),
      high_(order_ > 2 ? mesh : empty_mesh()) {
  const std::array<std::uint32_t, 3> counts{static_cast<std::uint32_t>(tets()), static_cast<std::uint32_t>(faces()),
                                            static_cast<std::uint32_t>(edges())};
  const std::array<const std::vector<std::string>*, 3> names{&mesh.region_names, &mesh.patch_names, &mesh.curve_names};
  for (std::size_t k = 0; k < 3; ++k) {
    ByNumber by = k == 0   ? by_number(counts[k], [this](std::uint32_t i) { return region_of(i); })
                  : k == 1 ? by_number(counts[k], [this](std::uint32_t i) { return patch_of(i); })
                           : by_number(counts[k], [this](std::uint32_t i) { return curve_of(i); });
    groups_[k] = std::move(by.members);
    numbers_[k] = std::move(by.numbers);
    take_labels(kOrigins[k]);
    add_numbered(kOrigins[k], groups_[k], numbers_[k], *names[k]);
  }
  for (std::uint32_t s = 0; s < mesh.sets.size(); ++s) {
    const NamedSet& set = mesh.sets[s];
    if (hidden.faces && (set.kind == NamedSet::Kind::kFaces || set.kind == NamedSet::Kind::kEdges)) continue;
    const bool is_named = !set.name.empty();
    std::string name = is_named ? set.name : default_name(Part::Origin::kSet, s, false);
    names_.clean(name);
    std::span<const std::uint32_t> members = set.members;
    if (set.kind == NamedSet::Kind::kNodes)
      members = members.first(
          static_cast<std::size_t>(std::lower_bound(members.begin(), members.end(), points_) - members.begin()));
    parts_.push_back({Part::Origin::kSet, set.kind, s, s + 1, std::move(name), is_named, members});
  }
}

void MeshParts::take_labels(Part::Origin origin) {
  const std::vector<std::int64_t>& labels = labels_of(origin);
  const auto k = static_cast<std::size_t>(origin);
  const bool is_region = origin == Part::Origin::kRegion;
  if (labels.empty() || numbers_[k].empty()) return;
  const bool ascends = std::adjacent_find(labels.begin(), labels.end(), std::greater_equal<>()) == labels.end();
  std::vector<std::int64_t> sorted = labels;
  std::sort(sorted.begin(), sorted.end());
  // A patch that was divided keeps its number in each piece; regions are told apart.
  are_numbers_[k] = !is_region || std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
  // Files have signed numbers of 32 bits, and some of them count on from the last one.
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max() / 2;
  const bool is_complete = numbers_[k].back() < labels.size();
  if (sorted.front() < -kMost || sorted.back() > kMost) return;
  if (is_region && is_complete) labels_.assign(labels.begin(), labels.end());
  // Readers number parts in the order of their tags.
  are_tags_[k] = labels.front() > 0 && ascends && (is_complete || !is_region);
}

void MeshParts::add_numbered(Part::Origin origin, const Groups<>& members, const std::vector<std::uint32_t>& numbers,
                             const std::vector<std::string>& names) {
  const auto kind = origin == Part::Origin::kRegion  ? NamedSet::Kind::kElements
                    : origin == Part::Origin::kPatch ? NamedSet::Kind::kFaces
                                                     : NamedSet::Kind::kEdges;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::uint32_t n = numbers[i];
    const bool is_named = n < names.size() && !names[n].empty();
    const std::uint32_t tag = tag_of(origin, n);
    std::string name = is_named ? names[n] : default_name(origin, n, numbers.size() == 1);
    names_.clean(name);
    parts_.push_back({origin, kind, n, tag, std::move(name), is_named, members[i]});
  }
}

std::span<const Part> MeshParts::parts(Part::Origin origin) const {
  const auto is_of = [&](const Part& p) { return p.origin == origin; };
  const auto first = std::find_if(parts_.begin(), parts_.end(), is_of);
  const auto last = std::find_if_not(first, parts_.end(), is_of);
  return std::span(parts_).subspan(static_cast<std::size_t>(first - parts_.begin()),
                                   static_cast<std::size_t>(last - first));
}

std::span<const VertexIndex> MeshParts::tet_nodes(std::size_t t, CellRoom& room) const {
  for (std::size_t k = 0; k < nodes_per_tet(); ++k) room[k] = tet_node(t, k);
  return std::span(room).first(nodes_per_tet());
}

std::span<const VertexIndex> MeshParts::face_nodes(std::size_t f, FaceRoom& room) const {
  for (std::size_t k = 0; k < nodes_per_face(); ++k) room[k] = face_node(f, k);
  return std::span(room).first(nodes_per_face());
}

std::span<const VertexIndex> MeshParts::edge_nodes(std::size_t e, EdgeRoom& room) const {
  for (std::size_t k = 0; k < nodes_per_edge(); ++k) room[k] = edge_node(e, k);
  return std::span(room).first(nodes_per_edge());
}

std::size_t MeshParts::corner_points() const {
  return corner_count(mesh_);
}

const std::vector<Side>& MeshParts::sides() const {
  if (!sides_.empty() || faces() == 0) return sides_;
  std::vector<Triangle> all = mesh_.boundary;
  all.insert(all.end(), mesh_.interfaces.begin(), mesh_.interfaces.end());
  const FaceTable table = face_table(mesh_.points.size(), all);
  RawVector<char> is_listed = parallel_filled(mesh_.points.size(), char{0});  // most tets touch no face of the list
  parallel_for(all.size(), [&](std::size_t f) {
    for (const VertexIndex v : all[f]) SharedValue(is_listed[v]).store(1);
  });
  // Of tets by their numbers, 4 t + i: the last one behind a face, or else the first one before it.
  constexpr std::uint32_t kNobody = kNone;
  RawVector<std::uint32_t> behind = parallel_filled(all.size(), kNobody), before = parallel_filled(all.size(), kNobody);
  parallel_for(mesh_.tets.size(), [&](std::size_t t) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Triangle of_tet = face_of(mesh_.tets[t], static_cast<int>(i));
      const auto& [a, b, c] = of_tet;
      if (!is_listed[a] || !is_listed[b] || !is_listed[c]) continue;
      const std::uint32_t number = 4 * static_cast<std::uint32_t>(t) + i;
      for (const FaceTable::Entry& listed : table.group_of(of_tet)) {
        if (is_even(of_tet) == is_even(all[listed.face]))
          SharedValue(behind[listed.face]).lower_to(kNobody - 1 - number);
        else
          SharedValue(before[listed.face]).lower_to(number);
      }
    }
  });
  sides_.assign(all.size(), {kNone, -1});
  parallel_for(all.size(), [&](std::size_t f) {
    const std::uint32_t number = behind[f] != kNobody ? kNobody - 1 - behind[f] : before[f];
    if (number != kNobody) sides_[f] = {number / 4, static_cast<int>(number % 4)};
  });
  return sides_;
}

Combinations combinations(const MeshParts& mesh, NamedSet::Kind kind) {
  const std::size_t count = kind == NamedSet::Kind::kNodes   ? mesh.points()
                            : kind == NamedSet::Kind::kEdges ? mesh.edges()
                            : kind == NamedSet::Kind::kFaces ? mesh.faces()
                                                             : mesh.tets();
  // Each part divides what came before; the combination 0 is that of none.
  std::vector<std::vector<std::uint32_t>> parts(1);
  std::vector<std::uint32_t> of(count, 0), members{static_cast<std::uint32_t>(count)};
  for (std::uint32_t p = 0; p < mesh.parts().size(); ++p) {
    if (mesh.parts()[p].kind != kind) continue;
    std::map<std::uint32_t, std::uint32_t> divided;
    for (const std::uint32_t m : mesh.parts()[p].members) {
      const auto [entry, is_new] = divided.try_emplace(of[m], static_cast<std::uint32_t>(parts.size()));
      if (is_new) {
        parts.push_back(parts[of[m]]);
        parts.back().push_back(p);
        members.push_back(0);
      }
      --members[of[m]];
      of[m] = entry->second;
      ++members[of[m]];
    }
  }
  Combinations out;
  std::vector<std::uint32_t> order(parts.size()), number(parts.size(), kNone);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return parts[a] < parts[b]; });
  for (const std::uint32_t c : order) {
    if (members[c] == 0 || (c == 0 && kind == NamedSet::Kind::kNodes)) continue;
    number[c] = static_cast<std::uint32_t>(out.parts.size());
    out.parts.push_back(std::move(parts[c]));
  }
  for (std::uint32_t& c : of) c = number[c];
  out.members =
      group_by_owner(out.parts.size(), static_cast<std::uint32_t>(of.size()), [&](std::uint32_t i) { return of[i]; });
  out.of = std::move(of);
  return out;
}

std::vector<VertexIndex> MeshParts::nodes_of(const Part& part) const {
  std::vector<bool> is_of(points_, false);
  const auto mark = [&](std::span<const VertexIndex> nodes) {
    for (const VertexIndex v : nodes)
      if (v < points_) is_of[v] = true;
  };
  CellRoom tet;
  FaceRoom face_room;
  EdgeRoom edge;
  for (const std::uint32_t m : part.members) {
    switch (part.kind) {
      case NamedSet::Kind::kNodes:
        is_of[m] = true;
        break;
      case NamedSet::Kind::kEdges:
        mark(edge_nodes(m, edge));
        break;
      case NamedSet::Kind::kFaces:
        mark(face_nodes(m, face_room));
        break;
      case NamedSet::Kind::kElements:
        mark(tet_nodes(m, tet));
        break;
    }
  }
  std::vector<VertexIndex> nodes;
  for (VertexIndex v = 0; v < is_of.size(); ++v)
    if (is_of[v]) nodes.push_back(v);
  return nodes;
}

}  // namespace octafront::io

namespace octafront {

std::vector<GroupInfo> groups_of(const TetMesh& mesh) {
  constexpr std::array kOrigins{"region", "patch", "curve"};
  constexpr std::array kKinds{"nodes", "edges", "faces", "elements"};
  std::vector<GroupInfo> all;
  const io::MeshParts parts(mesh, {.mid_nodes = true});
  for (const io::Part& part : parts.parts()) {
    const bool is_set = part.origin == io::Part::Origin::kSet;
    all.push_back(
        {is_set ? kKinds[static_cast<std::size_t>(part.kind)] : kOrigins[static_cast<std::size_t>(part.origin)],
         part.name, part.members.size()});
  }
  return all;
}

}  // namespace octafront
