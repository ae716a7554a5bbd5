// Abaqus and CalculiX input decks (abaqus_deck.h) as a mesh: nodes, tetrahedra, wedges, pyramids and sets of parts,
// where their instances are; all else is passed over. *ELEMENT ... ELSET and *ELSET make groups of elements, *NSET of
// nodes, *SURFACE of faces or nodes; of several instances each is one more group. Triangles and quadrilaterals (shells,
// membranes) are faces, in the group of their set.

#include "formats/parts/boundary.h"
#include "formats/parts/raw_mesh.h"
#include "formats/parts/wide_orders.h"
#include "formats/read/abaqus_deck.h"
#include "formats/read/id_map.h"
#include "formats/read/readers.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <span>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;

/// Corners of the sides S1 = 123, S2 = 124, S3 = 234, S4 = 134 by the corner that they lack.
constexpr std::array<int, 4> kLacks{3, 2, 0, 1};

/// Of an element: a range of tetrahedra or triangles; of a wedge or pyramid its nodes among those listed.
struct ElementPlace {
  std::uint32_t first, last, listed;
};

/// What numbers and names mean: in an instance those of its part and its own, else those of the assembly.
struct DeckScope {
  std::string name;  ///< of an instance, in upper case
  std::vector<const DeckBlock*> blocks;
  const DeckInstance* instance = nullptr;
  IdMap nodes, solids, shells;
  std::vector<VertexIndex> points;  ///< by the places of `nodes`
  std::vector<ElementPlace> solid_places, shell_places;
};

/// A number in a scope.
struct DeckItem {
  std::size_t scope;
  std::int64_t id;
};

class Abaqus {
 public:
  explicit Abaqus(const Input& input) : input_(input), deck_(read_deck(input)) {}

  RawMesh read() {
    raw_.format = "Abaqus";
    raw_.notes = deck_.notes;
    raw_.other_elements = deck_.other_elements;
    make_scopes();
    for (DeckScope& scope : scopes_) add_nodes(scope);
    for (DeckScope& scope : scopes_)
      for (const DeckBlock* block : scope.blocks) add_elements(scope, *block);
    make_groups();
    return std::move(raw_);
  }

 private:
  static std::string one_word(const std::string& text) { return in_quotes(text); }

  std::string original(const std::string& name) const {
    const auto found = deck_.originals.find(upper(name));
    return found != deck_.originals.end() ? found->second : name;
  }

  void make_scopes() {
    scopes_.emplace_back().blocks.push_back(&deck_.assembly);
    // A deck may have parts and no assembly: each part stands where it is.
    if (deck_.instances.empty())
      for (const DeckBlock& part : deck_.parts) deck_.instances.push_back({part.name, part.name, {}, {}});
    std::set<const DeckBlock*> used;
    for (const DeckInstance& instance : deck_.instances) {
      DeckScope& scope = scopes_.emplace_back();
      scope.name = upper(instance.name);
      scope.instance = &instance;
      const DeckBlock* part = part_named(instance.part);
      if (part == nullptr && instance.own.points.empty())
        raw_.notes.push_back(fmt::format("the deck has no part {}: the instance {} is left out",
                                         one_word(instance.part), one_word(instance.name)));
      if (part != nullptr) scope.blocks.push_back(part), used.insert(part);
      scope.blocks.push_back(&instance.own);
    }
    for (const DeckBlock& part : deck_.parts)
      if (!used.contains(&part) && !part.points.empty())
        raw_.notes.push_back(fmt::format("the part {} has no instance: it is left out", one_word(part.name)));
    check_size();
  }

  /// A few words make another instance of a large part.
  void check_size() const {
    constexpr std::uint64_t kItemsPerByte = 64, kAlways = 1 << 16;
    std::uint64_t items = 0;
    for (const DeckScope& scope : scopes_)
      for (const DeckBlock* block : scope.blocks) items += block->points.size() + block->nodes_of.size();
    if (items > kItemsPerByte * deck_.bytes + kAlways || items >= kNone)
      input_.fail("the instances make more nodes and elements than such a file can need");
  }

  const DeckBlock* part_named(const std::string& name) const {
    const std::string wanted = upper(name);
    const auto found = std::find_if(deck_.parts.begin(), deck_.parts.end(),
                                    [&](const DeckBlock& part) { return upper(part.name) == wanted; });
    return found == deck_.parts.end() ? nullptr : &*found;
  }

  void add_nodes(DeckScope& scope) {
    for (const DeckBlock* block : scope.blocks)
      for (std::size_t i = 0; i < block->points.size(); ++i) {
        if (!scope.nodes.add(block->node_ids[i]))
          input_.fail(fmt::format("a second node {}; the file is damaged", block->node_ids[i]));
        scope.points.push_back(static_cast<VertexIndex>(raw_.points.size()));
        raw_.points.push_back(scope.instance ? scope.instance->place.of(block->points[i]) : block->points[i]);
      }
  }

  void add_elements(DeckScope& scope, const DeckBlock& block) {
    std::array<VertexIndex, 20> nodes;
    for (const DeckBlock::Element& element : block.elements) {
      for (std::size_t k = 0; k < element.kind.nodes; ++k)
        nodes[k] = node(scope, block.nodes_of[element.first + k], element.id);
      const auto all = std::span<const VertexIndex>(nodes).first(element.kind.nodes);
      element.kind.is_solid ? add_solid(scope, element.id, all) : add_shell(scope, element.id, all);
    }
  }

  VertexIndex node(const DeckScope& scope, std::int64_t id, std::int64_t element) const {
    const std::uint32_t v = scope.nodes.find(id);
    if (v != kNone) return scope.points[v];
    std::string why = fmt::format("element {} has the node {}, which the file lacks", element, id);
    for (const std::string& note : deck_.notes) why += "; " + note;
    input_.fail(why);
  }

  void add_solid(DeckScope& scope, std::int64_t id, std::span<const VertexIndex> nodes) {
    if (!scope.solids.add(id)) input_.fail(fmt::format("a second element {}; the file is damaged", id));
    ElementPlace place{static_cast<std::uint32_t>(raw_.tets.size()), 0, kNone};
    if (nodes.size() == 4 || nodes.size() == 10) {
      raw_.add_tet(nodes, 0);
    } else {
      place.listed = static_cast<std::uint32_t>(listed_.size());
      const bool is_hexahedron = nodes.size() == 8 || nodes.size() == 20;
      is_hexahedron ? raw_.add_hexahedron(nodes, 0) : raw_.add_wide_cell(nodes, 0);
      listed_.emplace_back(nodes.begin(), nodes.begin() + (is_hexahedron ? 8 : nodes.size() == 5 ? 5 : 6));
    }
    place.last = static_cast<std::uint32_t>(raw_.tets.size());
    scope.solid_places.push_back(place);
  }

  void add_shell(DeckScope& scope, std::int64_t id, std::span<const VertexIndex> nodes) {
    if (!scope.shells.add(id)) return;
    const auto first = static_cast<std::uint32_t>(raw_.triangles.size());
    raw_.add_face(nodes, 0);
    scope.shell_places.push_back({first, static_cast<std::uint32_t>(raw_.triangles.size()), kNone});
  }

  std::size_t scope_named(const std::string& instance, std::size_t otherwise) const {
    if (instance.empty()) return otherwise;
    for (std::size_t s = 1; s < scopes_.size(); ++s)
      if (scopes_[s].name == instance) return s;
    return otherwise;
  }

  const DeckSet* set_named(std::size_t scope, const std::string& name, bool of_nodes) const {
    for (const DeckBlock* block : scopes_[scope].blocks)
      if (const DeckSet* set = (of_nodes ? block->node_sets : block->element_sets).find(name)) return set;
    return nullptr;
  }

  /// Sets of sets can ask for millions of members in a few words.
  void spend(std::uint64_t members) const {
    constexpr std::uint64_t kMembersPerByte = 16, kAlways = 1 << 16;
    if ((spent_ += members) > kMembersPerByte * deck_.bytes + kAlways)
      input_.fail("the sets have more members than such a file can need; write them out, without GENERATE");
  }

  /// The numbers of a set and of those that it names, in all scopes; circles end.
  std::vector<DeckItem> items_of(std::size_t scope, const DeckSet& set, bool of_nodes) const {
    std::vector<DeckItem> items;
    std::vector<std::pair<std::size_t, const DeckSet*>> todo{{scope, &set}};
    std::set<std::pair<std::size_t, const DeckSet*>> seen{todo.front()};
    while (!todo.empty()) {
      const auto [here, next] = todo.back();
      todo.pop_back();
      for (const DeckMember& member : next->members) add_member(here, member, of_nodes, items, seen, todo);
    }
    spend(items.size());
    return items;
  }
  void add_member(std::size_t here, const DeckMember& member, bool of_nodes, std::vector<DeckItem>& items,
                  std::set<std::pair<std::size_t, const DeckSet*>>& seen,
                  std::vector<std::pair<std::size_t, const DeckSet*>>& todo) const {
    const std::size_t at = scope_named(member.instance, here);
    if (member.name.empty()) return items.push_back({at, member.id});
    const DeckSet* const other = set_named(at, member.name, of_nodes);
    if (other != nullptr && seen.insert({at, other}).second) todo.emplace_back(at, other);
  }
  /// The same of what a surface names.
  std::vector<DeckItem> items_of(std::size_t scope, const DeckMember& named, bool of_nodes) const {
    return items_of(scope, DeckSet{{}, false, {named}}, of_nodes);
  }

  /// Members of a group: nodes, tetrahedra or triangles.
  void add_group(const std::string& name, Kind kind, const std::vector<DeckItem>& items) {
    RawMesh::Group group{name, kind, {}};
    for (const auto& [s, id] : items) {
      const DeckScope& scope = scopes_[s];
      const IdMap& ids = kind == Kind::kNodes ? scope.nodes : kind == Kind::kElements ? scope.solids : scope.shells;
      const std::uint32_t i = ids.find(id);
      if (i == kNone) continue;
      const ElementPlace place = kind == Kind::kNodes      ? ElementPlace{scope.points[i], scope.points[i] + 1, kNone}
                                 : kind == Kind::kElements ? scope.solid_places[i]
                                                           : scope.shell_places[i];
      for (std::uint32_t m = place.first; m < place.last; ++m) group.members.push_back(m);
    }
    if (!group.members.empty()) raw_.groups.push_back(std::move(group));
  }

  /// Calls visit(scope, block) for each block of each scope.
  template <class Visit>
  void for_each_block(const Visit& visit) {
    for (std::size_t s = 0; s < scopes_.size(); ++s)
      for (const DeckBlock* block : scopes_[s].blocks) visit(s, *block);
  }

  /// Where several instances have a name, "INSTANCE.NAME".
  std::string name_in(std::size_t scope, const std::string& name) const {
    const bool is_unique = uses_.at(upper(name)) < 2;
    return is_unique || scope == 0 ? original(name) : scopes_[scope].instance->name + "." + original(name);
  }

  void count_names() {
    for_each_block([&](std::size_t s, const DeckBlock& block) {
      std::set<std::string> here;
      for (const auto* sets : {&block.node_sets, &block.element_sets})
        for (const DeckSet& set : sets->all()) here.insert(upper(set.name));
      for (const DeckSurface& surface : block.surfaces) {
        here.insert(upper(surface.name));
        for (const DeckSide& side : surface.sides) in_surfaces_.insert(upper(side.elements.name));
      }
      for (const std::string& name : here) uses_[name] += s > 0 ? 1 : 0;
    });
  }

  /// Sets that Abaqus makes for the sides of a surface are the surface.
  bool is_shown(const DeckSet& set) const { return !set.is_internal || !in_surfaces_.contains(upper(set.name)); }

  void add_instances() {
    if (deck_.instances.size() < 2) return;
    for (const DeckScope& scope : scopes_) {
      if (scope.solid_places.empty() || scope.instance == nullptr) continue;
      RawMesh::Group group{scope.instance->name, Kind::kElements, {}};
      for (std::uint32_t t = scope.solid_places.front().first; t < scope.solid_places.back().last; ++t)
        group.members.push_back(t);
      raw_.groups.push_back(std::move(group));
    }
  }

  void make_groups() {
    count_names();
    add_instances();
    for_each_block([&](std::size_t s, const DeckBlock& block) {
      for (const DeckSet& set : block.element_sets.all()) {
        if (!is_shown(set)) continue;
        const std::vector<DeckItem> items = items_of(s, set, false);
        add_group(name_in(s, set.name), Kind::kElements, items);
        add_group(name_in(s, set.name), Kind::kFaces, items);
      }
    });
    for_each_block([&](std::size_t s, const DeckBlock& block) {
      for (const DeckSurface& surface : block.surfaces) add_surface(s, surface);
    });
    for_each_block([&](std::size_t s, const DeckBlock& block) {
      for (const DeckSet& set : block.node_sets.all())
        if (is_shown(set)) add_group(name_in(s, set.name), Kind::kNodes, items_of(s, set, true));
    });
    // No references: regions and patches come from the groups.
    raw_.tet_ref.clear();
    raw_.triangle_ref.clear();
  }

  void add_surface(std::size_t s, const DeckSurface& surface) {
    const std::string name = name_in(s, surface.name);
    if (surface.of_nodes) {
      std::vector<DeckItem> items;
      for (const DeckSide& side : surface.sides)
        for (const DeckItem& item : items_of(s, side.elements, true)) items.push_back(item);
      return add_group(name, Kind::kNodes, items);
    }
    RawMesh::Group group{name, Kind::kFaces, {}};
    for (const DeckSide& side : surface.sides)
      for (const DeckItem& item : items_of(s, side.elements, false)) add_sides(item, side.side, group);
    if (!group.members.empty()) raw_.groups.push_back(std::move(group));
  }

  void add_sides(const DeckItem& item, int side, RawMesh::Group& group) {
    const DeckScope& scope = scopes_[item.scope];
    const std::uint32_t solid = scope.solids.find(item.id), shell = scope.shells.find(item.id);
    if (solid == kNone && shell != kNone) {
      for (std::uint32_t f = scope.shell_places[shell].first; f < scope.shell_places[shell].last; ++f)
        group.members.push_back(f);
    } else if (solid != kNone && side >= 0) {
      add_side(side_of(scope.solid_places[solid], static_cast<std::size_t>(side)), group);
    } else if (solid != kNone && side == DeckSide::kFree) {
      const ElementPlace& place = scope.solid_places[solid];
      for (std::size_t k = 0; k < (place.listed == kNone ? 4 : 6); ++k)
        if (const auto nodes = side_of(place, k); is_free(nodes)) add_side(nodes, group);
    }
  }

  void add_side(const std::vector<VertexIndex>& nodes, RawMesh::Group& group) {
    if (nodes.size() < 3) return;
    for (std::uint32_t k = raw_.add_face(nodes, 0); k > 0; --k)
      group.members.push_back(static_cast<std::uint32_t>(raw_.triangles.size()) - k);
  }

  /// Whether a side is no other element's, which its triangles tell.
  bool is_free(const std::vector<VertexIndex>& nodes) {
    if (free_.empty())
      for (const Triangle& t : boundary_of(raw_.tets, raw_.points.size())) free_.insert(t);
    return free_.has_face(nodes);
  }

  /// Faces of one tetrahedron only.
  struct FreeFaces {
    std::set<Triangle> faces;

    bool empty() const { return faces.empty(); }
    void insert(const Triangle& t) { faces.insert(face_key(t)); }
    /// A triangle, or a quadrilateral by either of its diagonals.
    bool has_face(const std::vector<VertexIndex>& nodes) const {
      const auto has = [&](std::size_t i, std::size_t j, std::size_t k) {
        return faces.contains(face_key({nodes[i], nodes[j], nodes[k]}));
      };
      if (nodes.size() < 3) return false;
      return has(0, 1, 2) || (nodes.size() == 4 && has(0, 1, 3));
    }
  };

  /// The corners of a side; of a wedge that stands for a pyramid each once.
  std::vector<VertexIndex> side_of(const ElementPlace& solid, std::size_t side) const {
    std::vector<VertexIndex> nodes;
    const auto add = [&](VertexIndex v) {
      if (std::find(nodes.begin(), nodes.end(), v) == nodes.end()) nodes.push_back(v);
    };
    if (solid.listed != kNone) {
      const std::vector<VertexIndex>& of = listed_[solid.listed];
      const std::span<const std::array<std::size_t, 4>> sides =
          of.size() == 8   ? std::span<const std::array<std::size_t, 4>>(kHexahedronFaces)
          : of.size() == 6 ? std::span<const std::array<std::size_t, 4>>(kWedgeFaces)
                           : std::span<const std::array<std::size_t, 4>>(kPyramidFaces);
      if (side >= sides.size()) return nodes;
      for (const std::size_t k : sides[side]) add(of[k]);
    } else if (side < kLacks.size()) {
      for (const int k : kTetFaces[static_cast<std::size_t>(kLacks[side])])
        add(raw_.tets[solid.first][static_cast<std::size_t>(k)]);
    }
    return nodes;
  }

  const Input& input_;
  DeckModel deck_;
  RawMesh raw_;
  std::vector<DeckScope> scopes_;
  std::vector<std::vector<VertexIndex>> listed_;
  std::map<std::string, std::size_t> uses_;  ///< of names, by instances
  std::set<std::string> in_surfaces_;        ///< names of sets
  FreeFaces free_;
  mutable std::uint64_t spent_ = 0;  ///< members of sets so far
};

}  // namespace

Told told_abaqus(const FileHead& head) {
  const bool is_ls_dyna = head.input.bytes.starts_with("*KEYWORD");
  return head.first.starts_with('*') && head.first.size() > 1 && !is_ls_dyna ? Told::kFirstLetter : Told::kNot;
}

RawMesh read_abaqus(const Input& input) {
  return Abaqus(input).read();
}

}  // namespace octafront::io
