// Gmsh MSH 4.1 and 2.2, text and binary. Points, edges, triangles and tetrahedra are kept, linear or quadratic, and
// quadrilaterals as two triangles. A physical group that overlaps none of a lower tag is a reference; others are sets,
// groups of points sets of nodes. What is in no group that is a reference has the tag of its entity, or one that is
// free. All in the order of their tags.

#include "base/core/renumber.h"
#include "formats/parts/mesh_parts.h"
#include "formats/parts/msh_stream.h"
#include "formats/parts/raw_mesh.h"
#include "formats/parts/wide_orders.h"
#include "formats/parts/wide_reading.h"
#include "formats/read/readers.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

/// Nodes of an element of Gmsh's type, 0 if the type is unknown.
std::uint64_t nodes_of_type(std::int64_t type) {
  constexpr std::array<std::uint8_t, 32> kNodes{0, 2,  3,  4,  4, 8,  6,  5,  3,  6,  9, 10, 27, 18, 14, 1,
                                                8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5,  6,  20, 35, 56};
  if (type >= 0 && type < static_cast<std::int64_t>(kNodes.size())) return kNodes[static_cast<std::size_t>(type)];
  if (type == 92) return 64;
  if (type == 93) return 125;
  return 0;
}

/// What a TetMesh has of them: 0 for points to 3 for tetrahedra, linear or quadratic; -1 for others. Quadrilaterals
/// become triangles, wedges and pyramids tetrahedra.
int kept_dimension(std::int64_t type) {
  constexpr std::array<std::int8_t, 32> kDimensions{-1, 1, 2, 2, 3, 3, 3, 3, 1, 2, 2, 3, 3, 3, 3, 0,
                                                    2,  3, 3, 3, 2, 2, 2, 2, 2, 2, 1, 1, 1, 3, 3, 3};
  const bool is_known = type >= 0 && type < static_cast<std::int64_t>(kDimensions.size());
  return is_known ? kDimensions[static_cast<std::size_t>(type)] : -1;
}

/// So many of the nodes of an element are asked for: of elements of order 3 and more the corners, and none in the
/// middle of faces.
std::size_t kept_nodes(std::int64_t type) {
  if (type >= 26 && type <= 28) return 2;
  if (type >= 20 && type <= 25) return 3;
  if (type == 31) return 4;
  if (type == 13) return 15;
  if (type == 14) return 13;
  return nodes_of_type(type);
}
/// Tetrahedra of order 3 and 4.
bool is_kept_high(std::int64_t type) {
  return type == 29 || type == 30;
}
std::span<const VertexIndex> in_lattice_order(std::span<const VertexIndex> nodes, CellRoom& room) {
  const int order = nodes.size() == 20 ? 3 : 4;
  for (std::size_t k = 0; k < nodes.size(); ++k) room[lattice_node_of_gmsh(order, k)] = nodes[k];
  return std::span(room).first(nodes.size());
}
bool is_of_high_order(std::int64_t type) {
  return type >= 20 && type <= 31;
}

/// From the tags of nodes, which may have gaps and any order, to indices.
class NodeTags {
 public:
  void add(std::uint64_t tag) {
    if (!tags_.empty() && tag != tags_.back() + 1) consecutive_ = false;
    tags_.push_back(tag);
  }
  /// Returns a tag that occurs twice, if there is one.
  std::pair<bool, std::uint64_t> finish() {
    if (consecutive_) return {false, 0};
    for (std::uint32_t i = 0; i < tags_.size(); ++i) sorted_.emplace_back(tags_[i], i);
    std::sort(sorted_.begin(), sorted_.end());
    const auto twice = std::adjacent_find(sorted_.begin(), sorted_.end(),
                                          [](const auto& a, const auto& b) { return a.first == b.first; });
    return twice == sorted_.end() ? std::pair{false, std::uint64_t{0}} : std::pair{true, twice->first};
  }
  /// kNone if there is no such node.
  VertexIndex index_of(std::uint64_t tag) const {
    if (tags_.empty()) return kNone;
    if (consecutive_)
      return tag >= tags_[0] && tag - tags_[0] < tags_.size() ? static_cast<VertexIndex>(tag - tags_[0]) : kNone;
    const auto at = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair{tag, std::uint32_t{0}});
    return at != sorted_.end() && at->first == tag ? at->second : kNone;
  }
  bool empty() const { return tags_.empty(); }
  const std::vector<std::uint64_t>& tags() const { return tags_; }

 private:
  std::vector<std::uint64_t> tags_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted_;
  bool consecutive_ = true;
};

/// Where elements belong, and the physical groups that it comes to.
class MshPlaces {
 public:
  /// An entity, or what of it is in the same groups: all that elements know of where they belong.
  struct Place {
    std::int64_t entity;
    std::vector<std::int64_t> groups;  ///< ascending
    bool operator<(const Place& o) const { return std::tie(entity, groups) < std::tie(o.entity, o.groups); }
  };
  /// A number for it, which stands for the reference until all are known.
  std::int64_t place_of(int dimension, Place place) {
    std::sort(place.groups.begin(), place.groups.end());
    place.groups.erase(std::unique(place.groups.begin(), place.groups.end()), place.groups.end());
    auto& places = places_[static_cast<std::size_t>(dimension)];
    return static_cast<std::int64_t>(places.try_emplace(std::move(place), places.size()).first->second);
  }

  void name(int dimension, std::int64_t group, std::string_view name) { names_[{dimension, group}] = name; }
  void add_node(std::int64_t group, std::uint32_t node) { node_groups_[group].push_back(node); }

  /// Names, references and sets of all.
  void finish(RawMesh& raw) {
    for (const auto& [key, name] : names_) {
      if (key.first == 1) raw.curve_names[key.second] = name;
      if (key.first == 2) raw.surface_names[key.second] = name;
      if (key.first == 3) raw.region_names[key.second] = name;
    }
    for (auto& [tag, members] : node_groups_)
      raw.groups.push_back({name_of(0, tag), NamedSet::Kind::kNodes, std::move(members)});
    finish(1, raw.edge_ref, raw);
    finish(2, raw.triangle_ref, raw);
    finish(3, raw.tet_ref, raw);
  }

  /// Version 2 lists the elements of an entity once for each of its groups: equal ones are in all of them. Returns for
  /// each the first that is equal.
  template <class Row>
  std::vector<std::uint32_t> unite_equal(int dimension, const std::vector<Row>& rows, std::vector<std::int64_t>& refs) {
    auto& places = places_[static_cast<std::size_t>(dimension)];
    std::vector<const Place*> place_at(places.size());
    for (const auto& [place, number] : places) place_at[number] = &place;
    std::map<Row, std::uint32_t> first_of;
    std::vector<std::uint32_t> first(rows.size());
    std::map<std::uint32_t, Place> united;
    for (std::uint32_t i = 0; i < rows.size(); ++i) {
      Row key = rows[i];
      std::sort(key.begin(), key.end());
      first[i] = first_of.try_emplace(key, i).first->second;
      if (first[i] == i) continue;
      const auto place = [&](std::uint32_t k) { return *place_at[static_cast<std::size_t>(refs[k])]; };
      Place& all = united.try_emplace(first[i], place(first[i])).first->second;
      const std::vector<std::int64_t> more = place(i).groups;
      all.groups.insert(all.groups.end(), more.begin(), more.end());
    }
    for (auto& [i, place] : united) refs[i] = place_of(dimension, std::move(place));
    for (std::uint32_t i = 0; i < rows.size(); ++i) refs[i] = refs[first[i]];
    // Places of no element are none.
    std::set<std::int64_t> used(refs.begin(), refs.end());
    std::map<Place, std::size_t> left;
    std::vector<std::int64_t> now(places.size());
    for (const auto& [place, number] : places)
      if (used.contains(static_cast<std::int64_t>(number))) {
        now[number] = static_cast<std::int64_t>(left.size());
        left.emplace(place, left.size());
      }
    for (std::int64_t& ref : refs) ref = now[static_cast<std::size_t>(ref)];
    places = std::move(left);
    return first;
  }

 private:
  std::string name_of(int dimension, std::int64_t group) const {
    const auto name = names_.find({dimension, group});
    return name != names_.end() ? name->second : fmt::format("physical_{}", group);
  }

  /// Physical groups of a dimension that overlap none of a lower tag.
  std::set<std::int64_t> groups_apart(int dimension) const {
    std::set<std::int64_t> all, apart;
    const auto& places = places_[static_cast<std::size_t>(dimension)];
    for (const auto& [place, number] : places) all.insert(place.groups.begin(), place.groups.end());
    for (const std::int64_t group : all) {
      const auto overlaps = [&](const auto& entry) {
        const auto& groups = entry.first.groups;
        return std::binary_search(groups.begin(), groups.end(), group) &&
               std::any_of(groups.begin(), groups.end(), [&](std::int64_t g) { return apart.contains(g); });
      };
      if (std::none_of(places.begin(), places.end(), overlaps)) apart.insert(group);
    }
    return apart;
  }

  /// References and sets of what the places of elements are.
  void finish(int dimension, std::vector<std::int64_t>& refs, RawMesh& raw) {
    const auto& places = places_[static_cast<std::size_t>(dimension)];
    const std::set<std::int64_t> apart = groups_apart(dimension);
    std::set<std::int64_t> taken = apart;
    for (const auto& [place, number] : places) taken.insert(place.groups.begin(), place.groups.end());
    std::int64_t free = taken.empty() ? 1 : *taken.rbegin() + 1;
    for (const auto& [place, number] : places) free = std::max(free, place.entity + 1);
    std::vector<std::int64_t> ref_of(places.size());
    std::vector<std::vector<std::int64_t>> sets_of(places.size());
    for (const auto& [place, number] : places) {
      std::int64_t& ref = ref_of[number] = kNone;
      for (const std::int64_t group : place.groups)
        apart.contains(group) ? static_cast<void>(ref = group) : sets_of[number].push_back(group);
      if (ref == kNone) ref = taken.insert(place.entity).second ? place.entity : free++;
    }
    std::map<std::int64_t, std::vector<std::uint32_t>> sets;
    for (std::uint32_t i = 0; i < refs.size(); ++i) {
      const auto number = static_cast<std::size_t>(refs[i]);
      for (const std::int64_t group : sets_of[number]) sets[group].push_back(i);
      refs[i] = ref_of[number];
    }
    for (auto& [tag, members] : sets)
      raw.groups.push_back(
          {name_of(dimension, tag), kKindOfDimension[static_cast<std::size_t>(dimension)], std::move(members)});
  }

  std::map<std::pair<int, std::int64_t>, std::string> names_;  ///< by dimension and tag
  std::array<std::map<Place, std::size_t>, 4> places_;         ///< by dimension
  std::map<std::int64_t, std::vector<std::uint32_t>> node_groups_;
};

/// From places to places in the order of the tags; empty if they are in order.
std::vector<std::uint32_t> places_by_tag(const std::vector<std::uint64_t>& tags) {
  if (std::is_sorted(tags.begin(), tags.end())) return {};
  std::vector<std::uint32_t> order(tags.size()), place(tags.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return tags[a] < tags[b]; });
  for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
  return place;
}
template <class T>
void permute(std::vector<T>& items, const std::vector<std::uint32_t>& place) {
  if (items.empty() || place.empty()) return;
  std::vector<T> ordered(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) ordered[place[i]] = items[i];
  items = std::move(ordered);
}

/// The same of rows of equal length, of a list that has one for each place.
void permute_rows(std::vector<VertexIndex>& items, const std::vector<std::uint32_t>& place) {
  if (items.empty() || place.empty() || items.size() % place.size() != 0) return;
  const std::size_t each = items.size() / place.size();
  std::vector<VertexIndex> ordered(items.size());
  for (std::size_t i = 0; i < place.size(); ++i)
    std::copy_n(items.begin() + static_cast<std::ptrdiff_t>(i * each), each,
                ordered.begin() + static_cast<std::ptrdiff_t>(place[i] * each));
  items = std::move(ordered);
}

/// Of wide cells or faces, whose parts have one tag and stay together.
template <class Wide>
void sort_wide(std::vector<Wide>& wide, const std::vector<std::uint32_t>& place) {
  if (place.empty()) return;
  for (Wide& w : wide) w.first = place[w.first];
  std::sort(wide.begin(), wide.end(), [](const Wide& a, const Wide& b) { return a.first < b.first; });
}

/// Files list by entity; tags tell the order in which things were made.
void sort_by_tags(RawMesh& raw, const std::vector<std::uint64_t>& node_tags,
                  const std::array<std::vector<std::uint64_t>, 4>& element_tags) {
  std::array<std::vector<std::uint32_t>, 4> place{places_by_tag(node_tags)};
  for (std::size_t d = 1; d < 4; ++d) place[d] = places_by_tag(element_tags[d]);
  permute(raw.points, place[0]);
  permute(raw.field.at_points, place[0]);
  permute(raw.field.at_triangles, place[2]);
  permute(raw.field.at_tets, place[3]);
  if (!place[0].empty()) {
    renumber(raw.tets, place[0]);
    renumber(raw.triangles, place[0]);
    renumber(raw.edges, place[0]);
    for (auto& mids : raw.mid_nodes)
      for (VertexIndex& v : mids)
        if (v != kNone) v = place[0][v];
    for (VertexIndex& v : raw.high_nodes) v = place[0][v];
    renumber_wide(raw, place[0]);
  }
  sort_wide(raw.wide_cells, place[3]);
  sort_wide(raw.wide_faces, place[2]);
  permute(raw.edges, place[1]);
  permute(raw.edge_ref, place[1]);
  permute(raw.triangles, place[2]);
  permute(raw.triangle_ref, place[2]);
  permute(raw.tets, place[3]);
  permute(raw.mid_nodes, place[3]);
  permute_rows(raw.high_nodes, place[3]);
  permute(raw.tet_ref, place[3]);
  if (!place[0].empty())
    for (RawMesh::Period& period : raw.periods)
      for (auto& pair : period.pairs)
        for (VertexIndex& v : pair) v = place[0][v];
  for (RawMesh::Group& group : raw.groups) {
    const auto& to = place[dimension_of(group.kind)];
    if (!to.empty())
      for (std::uint32_t& m : group.members) m = to[m];
  }
}

/// The field that is asked for, by tags of nodes and elements.
class MshData {
 public:
  /// Values at nodes or in elements by their tags. Names, times and counts are text also in binary files.
  void read(MshStream& in, const Input& input, RawMesh& raw, bool of_nodes) {
    Scanner& text = in.text();
    std::string name;
    const std::int64_t names = text.integer("the number of names");
    for (std::int64_t i = 0; i < names; ++i) {
      text.at_end();
      std::string_view line = text.rest_of_line();
      if (line.size() >= 2 && line.front() == '"' && line.back() == '"') line = line.substr(1, line.size() - 2);
      if (i == 0) name = line;
    }
    const std::int64_t times = text.integer("the number of times");
    for (std::int64_t i = 0; i < times; ++i) text.number("a time");
    const std::int64_t counts = text.integer("the number of counts");
    std::array<std::int64_t, 3> known{0, 1, 0};
    for (std::int64_t i = 0; i < counts; ++i) {
      const std::int64_t value = text.integer("a count");
      if (i < 3) known[static_cast<std::size_t>(i)] = value;
    }
    in.skip_line_end();
    const auto components = static_cast<std::uint64_t>(known[1]), count = static_cast<std::uint64_t>(known[2]);
    if (known[1] < 1 || known[1] > 9 || known[2] < 0) in.fail("a field of no known kind; the file is damaged");
    in.check_count(count, components, 0, 1, "values");
    // A later step of a field goes before the one before.
    const bool is_wanted = components == 1 && raw.field.offer(input, name);
    std::vector<std::pair<std::uint64_t, double>> values;
    for (std::uint64_t i = 0; i < count; ++i) {
      const auto tag = static_cast<std::uint64_t>(in.int32("the tag of a value"));
      for (std::uint64_t k = 0; k < components; ++k) {
        const double value = in.real("a value");
        if (is_wanted) values.emplace_back(tag, value);
      }
    }
    if (!is_wanted) return;
    std::sort(values.begin(), values.end());
    data_[of_nodes ? 0 : 1] = std::move(values);
  }

  void finish(RawMesh& raw, const std::vector<std::uint64_t>& node_tags,
              const std::array<std::vector<std::uint64_t>, 4>& element_tags) const {
    raw.field.at_points = values_of(0, node_tags);
    raw.field.at_triangles = values_of(1, element_tags[2]);
    raw.field.at_tets = values_of(1, element_tags[3]);
  }

 private:
  /// The values of a field in the order of these tags; empty unless each has one.
  std::vector<double> values_of(std::size_t of_elements, const std::vector<std::uint64_t>& tags) const {
    const auto& known = data_[of_elements];
    std::vector<double> values;
    if (known.empty()) return values;
    for (const std::uint64_t tag : tags) {
      const auto at = std::lower_bound(known.begin(), known.end(), tag,
                                       [](const auto& entry, std::uint64_t t) { return entry.first < t; });
      if (at == known.end() || at->first != tag) return {};
      values.push_back(at->second);
    }
    return values;
  }

  std::array<std::vector<std::pair<std::uint64_t, double>>, 2> data_;
};

/// Entities of version 4, by dimension and tag.
class MshEntityTable {
 public:
  /// What parts have of entities is named by them, too.
  void read_of_parts(MshStream& in) {
    in.size("the number of partitions");
    const std::uint64_t ghosts = in.size("the number of ghost entities");
    in.check_count(ghosts, 0, 0, 2, "ghost entities");
    in.skip_int32(2 * ghosts);
    read(in, true);
  }

  void read(MshStream& in, bool of_parts = false) {
    std::array<std::uint64_t, 4> counts;
    for (std::uint64_t& n : counts) n = in.size("a number of entities");
    for (int dimension = 0; dimension < 4; ++dimension) {
      const std::uint64_t reals = dimension == 0 ? 3 : 6;
      in.check_count(counts[static_cast<std::size_t>(dimension)], reals, dimension == 0 ? 1 : 2, 1, "entities");
      for (std::uint64_t i = 0; i < counts[static_cast<std::size_t>(dimension)]; ++i) {
        const std::int64_t tag = in.int32("the tag of an entity");
        if (of_parts) {
          const std::int64_t parent_dimension = in.int32("the dimension of a parent");
          const std::int64_t parent = in.int32("the tag of a parent");
          if (parent_dimension == dimension) parent_[{dimension, tag}] = parent;
          const std::uint64_t partitions = in.size("the number of partitions of an entity");
          in.check_count(partitions, 0, 0, 1, "partitions");
          in.skip_int32(partitions);
        }
        in.skip_real(reals);
        const std::uint64_t groups = in.size("the number of physical groups");
        if (groups > 0) {
          in.check_count(groups, 0, 0, 1, "physical groups");
          std::vector<std::int64_t>& of_entity = physical_[{dimension, tag}];
          // The sign tells the orientation of the entity in its group.
          for (std::uint64_t g = 0; g < groups; ++g) of_entity.push_back(std::abs(in.int32("a physical group")));
        }
        if (dimension > 0) in.skip_int32(in.size("the number of bounding entities"));
      }
    }
  }

  std::span<const std::int64_t> groups_of(int dimension, std::int64_t entity) const {
    const auto physical = physical_.find({dimension, entity});
    return physical == physical_.end() ? std::span<const std::int64_t>() : physical->second;
  }
  /// What it is a part of, or itself.
  std::int64_t whole_of(int dimension, std::int64_t entity) const {
    const auto parent = parent_.find({dimension, entity});
    return parent == parent_.end() ? entity : parent->second;
  }

 private:
  std::map<std::pair<int, std::int64_t>, std::vector<std::int64_t>> physical_;
  std::map<std::pair<int, std::int64_t>, std::int64_t> parent_;  ///< of those of parts
};

class Msh {
 public:
  explicit Msh(const Input& input) : input_(input), in_(input) {}

  RawMesh read() {
    for (std::string_view name = in_.next_section(); !name.empty(); name = in_.next_section()) {
      if (name == "MeshFormat") {
        read_format();
      } else if (name == "PhysicalNames") {
        read_names();
      } else if (name == "PartitionedEntities" && version_ == 4) {
        entities_.read_of_parts(in_);
      } else if (name == "Entities" && version_ == 4) {
        entities_.read(in_);
      } else if (name == "Nodes") {
        require_format();
        version_ == 4 ? read_nodes_4() : read_nodes_2();
        if (const auto [twice, tag] = tags_.finish(); twice)
          in_.fail(fmt::format("two nodes have the tag {}; the file is damaged: export it again", tag));
      } else if (name == "Elements") {
        require_format();
        has_elements_ = true;
        version_ == 4 ? read_elements_4() : read_elements_2();
      } else if (name == "Periodic" && !tags_.empty()) {
        version_ == 4 ? read_periodic_4() : read_periodic_2();
      } else if (input_.field != nullptr && (name == "NodeData" || name == "ElementData")) {
        data_.read(in_, input_, raw_, name == "NodeData");
      } else {
        in_.skip_section(name);
        continue;
      }
      in_.end_section(name);
    }
    if (!has_elements_)
      input_.fail("has no section $Elements; it is truncated or holds no mesh: copy or export it again");
    unite_equal_elements();
    places_.finish(raw_);
    data_.finish(raw_, tags_.tags(), element_tags_);
    sort_by_tags(raw_, tags_.tags(), element_tags_);
    if (high_order_ > 0 && raw_.high_order == 0)
      raw_.notes.push_back(fmt::format("{} elements of order 3 and more are taken as linear", high_order_));
    raw_.format = version_ == 4 ? "Gmsh MSH 4.1" : "Gmsh MSH 2.2";
    return std::move(raw_);
  }

 private:
  void require_format() const {
    if (version_ == 0) in_.fail("the section $MeshFormat must come first; the file is damaged: export it again");
  }

  void read_format() {
    const double version = in_.text().number("the version of the format");
    const std::int64_t type = in_.text().integer("the type of the file (0 or 1)");
    const std::int64_t size = in_.text().integer("the size of a number");
    if (version != 4.1 && !(version >= 2 && version < 3))
      in_.fail(fmt::format(
          "version {} of Gmsh's format is not read here; save it as 4.1 (gmsh FILE -save -format msh41)", version));
    if (size != 8) in_.fail(fmt::format("numbers of {} bytes are not read here; save it on a 64-bit machine", size));
    version_ = version == 4.1 ? 4 : 2;
    if (type == 0) return;
    in_.set_binary();
    in_.skip_line_end();
    if (in_.int32("the mark of the byte order") != 1)
      in_.fail("big-endian files are not read here; save it on a little-endian machine or as text");
  }

  void read_names() {
    Scanner& text = in_.text();
    const std::int64_t count = text.integer("the number of names");
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t dimension = text.integer("the dimension of a physical group");
      const std::int64_t tag = text.integer("the tag of a physical group");
      std::string_view name = text.rest_of_line();
      // Some programs put words of their own behind the name.
      const std::size_t last = name.rfind('"');
      if (last == 0 || last == std::string_view::npos || name.front() != '"') text.fail_expected("a name in quotes");
      name = name.substr(1, last - 1);
      if (dimension >= 0 && dimension < 4) places_.name(static_cast<int>(dimension), tag, name);
    }
  }

  void add_node(std::uint64_t tag) {
    if (raw_.points.size() >= kNone - 1) in_.fail(fmt::format("holds more than {} nodes", kNone - 1));
    tags_.add(tag);
  }

  Vec3 point() {
    const double x = in_.real("a coordinate"), y = in_.real("a coordinate"), z = in_.real("a coordinate");
    return {x, y, z};
  }

  void read_nodes_4() {
    const std::uint64_t blocks = in_.size("the number of blocks of nodes");
    in_.skip_size(3);
    for (std::uint64_t b = 0; b < blocks; ++b) {
      const std::int64_t dimension = in_.int32("the dimension of an entity");
      in_.skip_int32(1);
      const bool parametric = in_.int32("whether nodes have parameters") != 0;
      const std::uint64_t count = in_.size("the number of nodes");
      if (dimension < 0 || dimension > 3)
        in_.fail(fmt::format("an entity of dimension {}; the file is damaged", dimension));
      const std::uint64_t parameters = parametric ? static_cast<std::uint64_t>(dimension) : 0;
      in_.check_count(count, 3 + parameters, 1, 0, "nodes");
      for (std::uint64_t i = 0; i < count; ++i) add_node(in_.size("the tag of a node"));
      for (std::uint64_t i = 0; i < count; ++i) {
        raw_.points.push_back(point());
        in_.skip_real(parameters);
      }
    }
  }

  void read_nodes_2() {
    const std::uint64_t count = static_cast<std::uint64_t>(in_.text().integer("the number of nodes"));
    in_.skip_line_end();
    in_.check_count(count, 3, 0, 1, "nodes");
    for (std::uint64_t i = 0; i < count; ++i) {
      add_node(static_cast<std::uint64_t>(in_.int32("the tag of a node")));
      raw_.points.push_back(point());
    }
  }

  VertexIndex node(std::uint64_t tag) const {
    const VertexIndex v = tags_.index_of(tag);
    if (v == kNone)
      in_.fail(tags_.empty() ? "the elements come before the nodes, which is not read here; export it again"
                             : fmt::format("an element has the node {}, which the file lacks; the file is damaged: "
                                           "export it again",
                                           tag));
    return v;
  }

  /// An element of a kept type.
  template <class Tag>
  void add_element(std::int64_t type, std::uint64_t tag, std::int64_t ref, std::span<const std::int64_t> groups,
                   const Tag& next_tag) {
    std::array<VertexIndex, 128> nodes;
    std::array<VertexIndex, 15> ours;
    CellRoom high;
    const std::size_t count = nodes_of_type(type);
    for (std::size_t i = 0; i < count; ++i) nodes[i] = node(next_tag());
    const std::span<const VertexIndex> all = std::span(nodes).first(kept_nodes(type));
    high_order_ += is_of_high_order(type) && !is_kept_high(type);
    const int dimension = kept_dimension(type);
    const auto d = static_cast<std::size_t>(dimension);
    std::uint32_t index = nodes[0], parts = 1;
    if (dimension == 3) {
      index = static_cast<std::uint32_t>(raw_.tets.size());
      if (is_kept_high(type))
        raw_.add_high_tet(in_lattice_order(all, high), ref);
      else if (all.size() == 4 || all.size() == 10)
        raw_.add_tet(all, ref, kGmshMids);
      else if (type == 5 || type == 12 || type == 17)
        parts = raw_.add_hexahedron(all, ref, tags_.tags());
      else
        parts = raw_.add_wide_cell(in_our_order(all, kGmshWide, ours), ref, tags_.tags());
    } else if (dimension == 2) {
      index = static_cast<std::uint32_t>(raw_.triangles.size());
      parts = raw_.add_face(all, ref);
    } else if (dimension == 1) {
      index = static_cast<std::uint32_t>(raw_.edges.size());
      raw_.edges.push_back({nodes[0], nodes[1]});
      raw_.edge_ref.push_back(ref);
    }
    if (dimension > 0) return static_cast<void>(element_tags_[d].insert(element_tags_[d].end(), parts, tag));
    for (const std::int64_t group : groups) places_.add_node(group, index);
  }

  void unite_equal_elements() {
    if (is_in_several_groups_[1]) places_.unite_equal(1, raw_.edges, raw_.edge_ref);
    if (is_in_several_groups_[2]) places_.unite_equal(2, raw_.triangles, raw_.triangle_ref);
    if (is_in_several_groups_[3]) drop_equal_tets(places_.unite_equal(3, raw_.tets, raw_.tet_ref));
  }

  void drop_equal_tets(const std::vector<std::uint32_t>& first) {
    std::vector<std::uint32_t> now(first.size(), kNone);
    std::uint32_t kept = 0;
    for (std::uint32_t t = 0; t < first.size(); ++t) {
      if (first[t] != t) continue;
      now[t] = kept;
      raw_.tets[kept] = raw_.tets[t], raw_.tet_ref[kept] = raw_.tet_ref[t];
      element_tags_[3][kept] = element_tags_[3][t];
      if (!raw_.mid_nodes.empty()) raw_.mid_nodes[kept] = raw_.mid_nodes[t];
      const std::size_t each = raw_.high_order > 0 ? raw_.high_nodes.size() / first.size() : 0;
      std::copy_n(raw_.high_nodes.begin() + static_cast<std::ptrdiff_t>(t * each), each,
                  raw_.high_nodes.begin() + static_cast<std::ptrdiff_t>(kept * each));
      ++kept;
    }
    raw_.tets.resize(kept), raw_.tet_ref.resize(kept), element_tags_[3].resize(kept);
    if (!raw_.mid_nodes.empty()) raw_.mid_nodes.resize(kept);
    raw_.high_nodes.resize(raw_.high_nodes.size() / first.size() * kept);
    std::erase_if(raw_.wide_cells, [&](const WideCell& cell) { return now[cell.first] == kNone; });
    for (WideCell& cell : raw_.wide_cells) cell.first = now[cell.first];
  }

  /// The period with this matrix of four rows; those of points and curves, which surfaces have too, are none.
  RawMesh::Period* period_of(std::int64_t dimension, const std::vector<double>& affine) {
    if (dimension != 2 || affine.size() != 16) return nullptr;
    const double* const m = affine.data();
    const std::array<Vec3, 3> rotation{{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}}};
    const Vec3 shift{m[3], m[7], m[11]};
    for (RawMesh::Period& known : raw_.periods)
      if (known.rotation == rotation && known.shift == shift) return &known;
    raw_.periods.push_back({rotation, shift});
    return &raw_.periods.back();
  }

  void add_pair(RawMesh::Period* period, std::uint64_t copy, std::uint64_t original) {
    const VertexIndex a = tags_.index_of(copy), b = tags_.index_of(original);
    if (period && a != kNone && b != kNone) period->pairs.push_back({a, b});
  }

  void read_periodic_4() {
    for (std::uint64_t left = in_.size("the number of periodic entities"); left > 0; --left) {
      const std::int64_t dimension = in_.int32("the dimension of an entity");
      in_.skip_int32(2);
      const std::uint64_t numbers = in_.size("the number of values of a matrix");
      in_.check_count(numbers, 1, 0, 0, "values of a matrix");
      std::vector<double> affine;
      for (std::uint64_t i = 0; i < numbers; ++i) affine.push_back(in_.real("a value of a matrix"));
      RawMesh::Period* const period = period_of(dimension, affine);
      const std::uint64_t count = in_.size("the number of pairs of nodes");
      in_.check_count(count, 0, 2, 0, "pairs of nodes");
      for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t copy = in_.size("the tag of a node");
        add_pair(period, copy, in_.size("the tag of a node"));
      }
    }
  }

  /// Text also in binary files.
  void read_periodic_2() {
    Scanner& text = in_.text();
    for (std::int64_t left = text.integer("the number of periodic entities"); left > 0; --left) {
      const std::int64_t dimension = text.integer("the dimension of an entity");
      text.integer("the tag of an entity"), text.integer("the tag of an entity");
      std::vector<double> affine;
      if (text.peek_word() == "Affine") {
        text.word();
        while (!text.at_line_end()) affine.push_back(text.number("a value of a matrix"));
      }
      RawMesh::Period* const period = period_of(dimension, affine);
      for (std::int64_t count = text.integer("the number of pairs of nodes"); count > 0; --count) {
        const std::int64_t copy = text.integer("the tag of a node");
        add_pair(period, static_cast<std::uint64_t>(copy),
                 static_cast<std::uint64_t>(text.integer("the tag of a node")));
      }
    }
  }

  std::uint64_t known_nodes_of_type(std::int64_t type) {
    const std::uint64_t nodes = nodes_of_type(type);
    if (nodes == 0) in_.fail(fmt::format("elements of type {} are not known here; export linear tetrahedra", type));
    return nodes;
  }

  void read_elements_4() {
    const std::uint64_t blocks = in_.size("the number of blocks of elements");
    in_.skip_size(3);
    for (std::uint64_t b = 0; b < blocks; ++b) {
      const std::int64_t dimension = in_.int32("the dimension of an entity");
      const std::int64_t entity = in_.int32("the tag of an entity");
      const std::int64_t type = in_.int32("the type of elements");
      const std::uint64_t nodes = known_nodes_of_type(type);
      const std::uint64_t count = in_.size("the number of elements");
      in_.check_count(count, 0, nodes + 1, 0, "elements");
      const std::span<const std::int64_t> groups = entities_.groups_of(static_cast<int>(dimension), entity);
      const std::int64_t whole = entities_.whole_of(static_cast<int>(dimension), entity);
      if (kept_dimension(type) < 0) {
        raw_.other_elements += count;
        in_.skip_size(count * (nodes + 1));
        continue;
      }
      const std::int64_t ref = places_.place_of(kept_dimension(type), {whole, {groups.begin(), groups.end()}});
      for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t tag = in_.size("the tag of an element");
        add_element(type, tag, ref, groups, [this] { return in_.size("a node of an element"); });
      }
    }
  }

  /// One element of version 2 behind its type: tags, the first two of which are the physical group and the entity.
  void read_element_2(std::int64_t type, std::uint64_t number, std::int64_t tag_count) {
    std::array<std::int64_t, 2> tags{};
    for (std::int64_t k = 0; k < tag_count; ++k) {
      const std::int64_t tag = in_.int32("a tag of an element");
      if (k < 2) tags[static_cast<std::size_t>(k)] = tag;
    }
    if (kept_dimension(type) < 0) {
      ++raw_.other_elements;
      in_.skip_int32(known_nodes_of_type(type));
      return;
    }
    // The sign tells the orientation of the entity in its group.
    tags[0] = std::abs(tags[0]);
    const int dimension = kept_dimension(type);
    const std::span<const std::int64_t> groups(tags.data(), tags[0] != 0);
    const auto [known, is_new] = group_of_entity_.try_emplace({dimension, tags[1]}, tags[0]);
    if (known->second != tags[0]) is_in_several_groups_[static_cast<std::size_t>(dimension)] = true;
    // Consecutive elements mostly share a place.
    if (const std::array<std::int64_t, 3> here{dimension, tags[0], tags[1]}; here != last_place_ || last_ref_ < 0) {
      last_place_ = here;
      last_ref_ = places_.place_of(dimension, {tags[1], {groups.begin(), groups.end()}});
    }
    add_element(type, number, last_ref_, groups,
                [this] { return static_cast<std::uint64_t>(in_.int32("a node of an element")); });
  }

  void read_elements_2() {
    const std::int64_t count = in_.text().integer("the number of elements");
    in_.skip_line_end();
    in_.check_count(static_cast<std::uint64_t>(count), 0, 0, 2, "elements");
    for (std::int64_t i = 0; i < count;) {
      std::uint64_t number = in_.is_binary() ? 0 : static_cast<std::uint64_t>(in_.int32("the number of an element"));
      const std::int64_t type = in_.int32("the type of an element");
      const std::int64_t together = in_.is_binary() ? in_.int32("the number of elements") : 1;
      const std::int64_t tag_count = in_.int32("the number of tags of an element");
      if (together < 1 || together > count - i || tag_count < 0 || tag_count > 1000)
        in_.fail(
            fmt::format("{} elements with {} tags each; the file is damaged: export it again", together, tag_count));
      for (std::int64_t k = 0; k < together; ++k) {
        if (in_.is_binary()) number = static_cast<std::uint64_t>(in_.int32("the number of an element"));
        read_element_2(type, number, tag_count);
      }
      i += together;
    }
  }

  const Input& input_;
  MshStream in_;
  int version_ = 0;
  bool has_elements_ = false;
  NodeTags tags_;
  std::uint64_t high_order_ = 0;  ///< elements of order 3 and more
  MshEntityTable entities_;
  MshPlaces places_;
  std::map<std::pair<int, std::int64_t>, std::int64_t> group_of_entity_;  ///< the first one, of version 2
  std::array<bool, 4> is_in_several_groups_{};                            ///< some entity of the dimension
  std::array<std::int64_t, 3> last_place_{};
  std::int64_t last_ref_ = -1;
  std::array<std::vector<std::uint64_t>, 4> element_tags_;
  MshData data_;
  RawMesh raw_;
};

}  // namespace

Told told_msh(const FileHead& head) {
  if (head.first == "$MeshFormat") return Told::kMagic;
  // Comments are sections like any other and may come first.
  const bool follows = head.first.starts_with('$') && head.input.bytes.find("$MeshFormat") != std::string_view::npos;
  return follows ? Told::kFirstLetter : Told::kNot;
}

RawMesh read_msh(const Input& input) {
  return Msh(input).read();
}

}  // namespace octafront::io
