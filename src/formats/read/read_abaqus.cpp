// Abaqus and CalculiX input decks: nodes, tetrahedra, wedges, pyramids and sets; all else is passed over. *ELEMENT ...
// ELSET and *ELSET make groups of elements, *NSET of nodes, *SURFACE, TYPE=ELEMENT of faces. Sets may name sets;
// GENERATE, one instance of a part. Triangles and quadrilaterals (shells, membranes) are faces, in the group of their
// set.

#include "formats/containers/scanner.h"
#include "formats/parts/raw_mesh.h"
#include "formats/parts/wide_orders.h"
#include "formats/read/id_map.h"
#include "formats/read/readers.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;

std::string upper(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return out;
}

/// Lines of a deck, split at commas. Views point into the file.
class Deck {
 public:
  explicit Deck(const Input& input) : input_(input), scan_(input) {}

  /// The next line that is no comment; false at the end. Comments are told to `comment`.
  template <class Comment>
  bool next(const Comment& comment) {
    while (!scan_.at_end()) {
      at_ = scan_.position();
      line_ = scan_.rest_of_line();
      if (!line_.starts_with("**")) return true;
      comment(line_);
    }
    return false;
  }
  bool is_keyword() const { return line_.starts_with('*'); }
  std::string_view line() const { return line_; }
  const char* at() const { return at_; }
  [[noreturn]] void fail(std::string_view message) const { input_.fail_at_line(at_, message); }

  /// The fields of this line.
  const std::vector<std::string_view>& fields() {
    fields_.clear();
    std::string_view rest = line_;
    while (true) {
      const std::size_t comma = rest.find(',');
      fields_.push_back(trimmed(rest.substr(0, comma)));
      if (comma == std::string_view::npos) break;
      rest.remove_prefix(comma + 1);
    }
    // A comma at the end says that the list goes on.
    while (!fields_.empty() && fields_.back().empty()) fields_.pop_back();
    return fields_;
  }

  std::optional<std::int64_t> whole(std::string_view field) const {
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || stop != field.data() + field.size() || field.empty()) return std::nullopt;
    return value;
  }
  std::int64_t integer(std::string_view field, std::string_view what) const {
    const auto value = whole(field);
    if (!value) fail(fmt::format("expected {}, found {}", what, in_quotes(field)));
    return *value;
  }
  double real(std::string_view field) const {
    double value = 0;
    if (!parse_number(field, value) || !std::isfinite(value))
      fail(fmt::format("expected a coordinate, found {}", in_quotes(field)));
    return value;
  }

 private:
  const Input& input_;
  Scanner scan_;
  const char* at_ = nullptr;
  std::string_view line_;
  std::vector<std::string_view> fields_;
};

/// A set: ids, and names of other sets. Sets are told apart by name in upper case.
struct DeckSet {
  std::string name;
  std::vector<std::int64_t> ids;
  std::vector<std::string> names;
};

class Sets {
 public:
  DeckSet& at(std::string_view name) {
    const auto [entry, is_new] = place_.try_emplace(upper(name), sets_.size());
    if (is_new) sets_.push_back({std::string(name), {}, {}});
    return sets_[entry->second];
  }
  /// The ids of a set and of those that it names, each once: circles end.
  std::vector<std::int64_t> collect(const std::string& name) const {
    std::vector<std::int64_t> ids;
    std::vector<std::size_t> todo;
    std::set<std::size_t> seen;
    const auto find = [&](const std::string& wanted) {
      const auto found = place_.find(upper(wanted));
      if (found != place_.end() && seen.insert(found->second).second) todo.push_back(found->second);
    };
    find(name);
    while (!todo.empty()) {
      const DeckSet& next = sets_[todo.back()];
      todo.pop_back();
      ids.insert(ids.end(), next.ids.begin(), next.ids.end());
      for (const std::string& other : next.names) find(other);
    }
    return ids;
  }
  const std::vector<DeckSet>& all() const { return sets_; }

 private:
  std::map<std::string, std::size_t> place_;
  std::vector<DeckSet> sets_;
};

/// Elements and sides of a face, "S1": 0.
struct DeckSurface {
  std::string name;
  std::vector<std::pair<std::string, int>> sides;
};

/// Corners of the sides S1 = 123, S2 = 124, S3 = 234, S4 = 134 by the corner that they lack.
constexpr std::array<int, 4> kLacks{3, 2, 0, 1};

class Abaqus {
 public:
  explicit Abaqus(const Input& input) : deck_(input), bytes_(input.bytes.size()) { raw_.format = "Abaqus"; }

  RawMesh read() {
    const auto comment = [this](std::string_view line) { note_name(line); };
    bool more = deck_.next(comment);
    while (more) {
      if (!deck_.is_keyword()) {
        more = deck_.next(comment);
        continue;
      }
      read_keyword();
      while ((more = deck_.next(comment)) && !deck_.is_keyword()) read_data();
      finish_keyword();
    }
    make_groups();
    return std::move(raw_);
  }

 private:
  enum class Section { kNone, kNodes, kElements, kNodeSet, kElementSet, kSurface };

  /// "** NAME left_part IS "left part"", as we write it.
  void note_name(std::string_view line) {
    constexpr std::string_view kHead = "** NAME ", kIs = " IS \"";
    const std::size_t is = line.find(kIs);
    if (!line.starts_with(kHead) || is == std::string_view::npos || !line.ends_with('"')) return;
    if (line.size() < is + kIs.size() + 1) return;
    originals_[upper(line.substr(kHead.size(), is - kHead.size()))] =
        line.substr(is + kIs.size(), line.size() - is - kIs.size() - 1);
  }
  std::string original(const std::string& name) const {
    const auto found = originals_.find(upper(name));
    return found != originals_.end() ? found->second : name;
  }

  std::string parameter(std::string_view key) const {
    const auto found = parameters_.find(std::string(key));
    return found != parameters_.end() ? found->second : std::string();
  }

  void read_keyword() {
    const auto& fields = deck_.fields();
    const std::string keyword = fields.empty() ? std::string() : upper(fields[0]);
    parameters_.clear();
    for (std::size_t i = 1; i < fields.size(); ++i) {
      const std::size_t equals = fields[i].find('=');
      std::string_view value = equals == std::string_view::npos ? "" : trimmed(fields[i].substr(equals + 1));
      if (value.size() >= 2 && value.front() == '"' && value.back() == '"') value = value.substr(1, value.size() - 2);
      parameters_[upper(trimmed(fields[i].substr(0, equals)))] = value;
    }
    section_ = Section::kNone;
    if (keyword == "*NODE" || keyword == "*ELEMENT") {
      section_ = keyword == "*NODE" ? Section::kNodes : Section::kElements;
      kind_ = keyword == "*NODE" ? ElementKind{} : kind_of(upper(parameter("TYPE")));
      set_name_ = parameter(keyword == "*NODE" ? "NSET" : "ELSET");
      pending_.clear();
    } else if (keyword == "*NSET" || keyword == "*ELSET") {
      section_ = keyword == "*NSET" ? Section::kNodeSet : Section::kElementSet;
      set_name_ = parameter(keyword.substr(1));
      if (set_name_.empty()) deck_.fail(fmt::format("{} has no name: {}=NAME is missing", keyword, keyword.substr(1)));
      sets().at(set_name_);
    } else if (keyword == "*SURFACE" && (parameter("TYPE").empty() || upper(parameter("TYPE")) == "ELEMENT")) {
      section_ = Section::kSurface;
      surfaces_.push_back({parameter("NAME"), {}});
    } else if (keyword == "*INCLUDE") {
      raw_.notes.push_back(fmt::format("*INCLUDE is not followed: {} was not read", one_word(parameter("INPUT"))));
    }
    generate_ = parameters_.contains("GENERATE");
  }

  static std::string one_word(const std::string& text) { return in_quotes(text); }

  Sets& sets() { return section_ == Section::kNodeSet || section_ == Section::kNodes ? node_sets_ : element_sets_; }

  /// Nodes of an element of that type that is kept, and whether it is a solid. 0: not kept.
  struct ElementKind {
    std::size_t nodes = 0;
    bool is_solid = false;
  };
  static ElementKind kind_of(std::string_view type) {
    if (const std::size_t solid = nodes_of_solid(type); solid > 0) return {solid, true};
    return {nodes_of_shell(type), false};
  }
  static std::size_t nodes_of_solid(std::string_view type) {
    const auto is = [&](std::string_view head) { return type.starts_with(head); };
    if (is("C3D15V")) return 0;
    if (is("C3D15") || is("DC3D15") || is("AC3D15")) return 15;
    if (is("C3D6") || is("DC3D6") || is("AC3D6")) return 6;
    if (is("C3D5") || is("DC3D5") || is("AC3D5")) return 5;
    if (is("C3D10") || is("DC3D10") || is("AC3D10")) return 10;
    if (is("C3D4") || is("DC3D4") || is("AC3D4")) return 4;
    return 0;
  }
  static std::size_t nodes_of_shell(std::string_view type) {
    const auto is = [&](std::string_view head) { return type.starts_with(head); };
    if (is("S4") || is("M3D4") || is("SFM3D4") || type == "DS4") return 4;
    if (is("S8R") || is("M3D8") || is("SFM3D8") || type == "DS8") return 8;
    if (type == "STRI65" || type == "M3D6" || type == "SFM3D6" || type == "S6" || type == "DS6" || type == "CPS6")
      return 6;
    if (type == "S3" || type == "S3R" || type == "STRI3" || type == "M3D3" || type == "SFM3D3" || type == "DS3" ||
        type == "CPS3")
      return 3;
    return 0;
  }

  void read_data() {
    const auto& fields = deck_.fields();
    switch (section_) {
      case Section::kNodes:
        return read_node(fields);
      case Section::kElements:
        return read_element(fields);
      case Section::kNodeSet:
      case Section::kElementSet:
        return read_set(fields);
      case Section::kSurface:
        return read_side(fields);
      default:
        return;
    }
  }

  void read_node(const std::vector<std::string_view>& fields) {
    if (fields.size() < 2) deck_.fail("expected a node: its number and coordinates");
    const std::int64_t id = deck_.integer(fields[0], "the number of a node");
    std::array<double, 3> xyz{};
    for (std::size_t i = 0; i < 3 && i + 1 < fields.size(); ++i) xyz[i] = deck_.real(fields[i + 1]);
    if (!node_ids_.add(id)) deck_.fail(fmt::format("a second node {}; the file is damaged", id));
    raw_.points.push_back({xyz[0], xyz[1], xyz[2]});
    if (!set_name_.empty()) sets().at(set_name_).ids.push_back(id);
  }

  void read_element(const std::vector<std::string_view>& fields) {
    if (kind_.nodes == 0) {
      // The lines of an element of another kind: counted by those that do not go on.
      raw_.other_elements += !deck_.line().ends_with(',');
      return;
    }
    for (const std::string_view field : fields) pending_.push_back(deck_.integer(field, "a number of an element"));
    const std::size_t count = kind_.nodes;
    if (pending_.size() <= count) return;
    if (pending_.size() > count + 1) deck_.fail(fmt::format("element {} has more than {} nodes", pending_[0], count));
    std::array<VertexIndex, 15> nodes;
    for (std::size_t k = 0; k < count; ++k) nodes[k] = node(pending_[k + 1]);
    const std::int64_t id = pending_[0];
    pending_.clear();
    kind_.is_solid ? add_solid(id, std::span(nodes).first(count)) : add_shell(id, std::span(nodes).first(count));
    if (!set_name_.empty()) sets().at(set_name_).ids.push_back(id);
  }

  void add_solid(std::int64_t id, std::span<const VertexIndex> nodes) {
    if (!solid_ids_.add(id)) deck_.fail(fmt::format("a second element {}; the file is damaged", id));
    Place place{static_cast<std::uint32_t>(raw_.tets.size()), 0, kNone};
    if (nodes.size() == 4 || nodes.size() == 10) {
      raw_.add_tet(nodes, 0);
    } else {
      place.listed = static_cast<std::uint32_t>(listed_.size());
      raw_.add_wide_cell(nodes, 0);
      listed_.emplace_back(nodes.begin(), nodes.begin() + (nodes.size() == 5 ? 5 : 6));
    }
    place.last = static_cast<std::uint32_t>(raw_.tets.size());
    solids_.push_back(place);
  }

  void add_shell(std::int64_t id, std::span<const VertexIndex> nodes) {
    if (!shell_ids_.add(id)) return;
    const auto first = static_cast<std::uint32_t>(raw_.triangles.size());
    raw_.add_face(nodes, 0);
    shells_.push_back({first, static_cast<std::uint32_t>(raw_.triangles.size()), kNone});
  }

  VertexIndex node(std::int64_t id) {
    const std::uint32_t v = node_ids_.find(id);
    if (v == kNone) deck_.fail(fmt::format("there is no node {} (nodes must come before elements)", id));
    return v;
  }

  /// A few words can ask for millions of members: all sets together have no more than a multiple of the file's bytes.
  void spend(std::uint64_t members) {
    constexpr std::uint64_t kMembersPerByte = 16, kAlways = 1 << 16;
    const std::uint64_t most = kMembersPerByte * bytes_ + kAlways;
    if (members > most || (spent_ += members) > most)
      deck_.fail("the sets up to here have more members than such a file can need; write them out, without GENERATE");
  }

  void read_set(const std::vector<std::string_view>& fields) {
    DeckSet& set = sets().at(set_name_);
    if (generate_) {
      if (fields.size() < 2) deck_.fail("expected the first and the last number, and the step");
      const std::int64_t first = deck_.integer(fields[0], "a number"), last = deck_.integer(fields[1], "a number"),
                         step = fields.size() > 2 ? deck_.integer(fields[2], "a step") : 1;
      const std::uint64_t range = static_cast<std::uint64_t>(last) - static_cast<std::uint64_t>(first);
      if (step < 1 || last < first) deck_.fail(fmt::format("the numbers {} to {} in steps of {}", first, last, step));
      spend(range / static_cast<std::uint64_t>(step));
      for (std::uint64_t i = 0; i <= range; i += static_cast<std::uint64_t>(step))
        set.ids.push_back(first + static_cast<std::int64_t>(i));
      return;
    }
    for (const std::string_view field : fields) {
      if (field.empty()) continue;
      if (const auto id = deck_.whole(field)) {
        set.ids.push_back(*id);
      } else {
        set.names.emplace_back(field);
      }
    }
  }

  void read_side(const std::vector<std::string_view>& fields) {
    if (fields.size() < 2 || fields[1].size() < 2 || (fields[1][0] != 'S' && fields[1][0] != 's')) return;
    if (fields[1][1] < '1' || fields[1][1] > '5') return;
    surfaces_.back().sides.emplace_back(fields[0], fields[1][1] - '1');
  }

  void finish_keyword() {
    if (section_ == Section::kElements && !pending_.empty())
      deck_.fail("an element has too few nodes; the file is truncated: copy or export it again");
    section_ = Section::kNone;
  }

  void make_groups() {
    // No references: regions and patches come from the groups.
    raw_.tet_ref.clear();
    raw_.triangle_ref.clear();
    const auto add = [&](const DeckSet& set, const Sets& of, Kind kind, const IdMap& ids,
                         const std::vector<Place>* places) {
      const std::vector<std::int64_t> all = of.collect(set.name);
      spend(all.size());
      RawMesh::Group group{original(set.name), kind, {}};
      for (const std::int64_t id : all)
        if (const std::uint32_t i = ids.find(id); i != kNone) {
          const Place place = places ? (*places)[i] : Place{i, i + 1, kNone};
          for (std::uint32_t m = place.first; m < place.last; ++m) group.members.push_back(m);
        }
      if (!group.members.empty()) raw_.groups.push_back(std::move(group));
    };
    for (const DeckSet& set : element_sets_.all()) {
      add(set, element_sets_, Kind::kElements, solid_ids_, &solids_);
      add(set, element_sets_, Kind::kFaces, shell_ids_, &shells_);
    }
    for (const DeckSurface& surface : surfaces_) add_surface(surface);
    for (const DeckSet& set : node_sets_.all()) add(set, node_sets_, Kind::kNodes, node_ids_, nullptr);
    raw_.triangle_ref.clear();
  }

  void add_surface(const DeckSurface& surface) {
    RawMesh::Group group{original(surface.name), Kind::kFaces, {}};
    for (const auto& [elements, side] : surface.sides) {
      const auto one = deck_.whole(elements);
      const std::vector<std::int64_t> ids = one ? std::vector{*one} : element_sets_.collect(elements);
      spend(ids.size());
      for (const std::int64_t id : ids) {
        const std::uint32_t s = solid_ids_.find(id);
        if (s == kNone) continue;
        const std::vector<VertexIndex> nodes = side_of(solids_[s], static_cast<std::size_t>(side));
        if (nodes.size() < 3) continue;
        for (std::uint32_t k = raw_.add_face(nodes, 0); k > 0; --k)
          group.members.push_back(static_cast<std::uint32_t>(raw_.triangles.size()) - k);
      }
    }
    if (!group.members.empty()) raw_.groups.push_back(std::move(group));
  }

  /// Of an element: a range of tetrahedra or triangles; of a wedge or pyramid its nodes in `listed_`.
  struct Place {
    std::uint32_t first, last, listed;
  };

  /// The corners of a side; of a wedge that stands for a pyramid each once.
  std::vector<VertexIndex> side_of(const Place& solid, std::size_t side) const {
    std::vector<VertexIndex> nodes;
    const auto add = [&](VertexIndex v) {
      if (std::find(nodes.begin(), nodes.end(), v) == nodes.end()) nodes.push_back(v);
    };
    if (solid.listed != kNone) {
      const std::vector<VertexIndex>& of = listed_[solid.listed];
      for (const std::size_t k : (of.size() == 6 ? kWedgeFaces : kPyramidFaces)[side]) add(of[k]);
    } else if (side < kLacks.size()) {
      for (const int k : kTetFaces[static_cast<std::size_t>(kLacks[side])])
        add(raw_.tets[solid.first][static_cast<std::size_t>(k)]);
    }
    return nodes;
  }

  Deck deck_;
  std::uint64_t bytes_, spent_ = 0;
  RawMesh raw_;
  Section section_ = Section::kNone;
  std::map<std::string, std::string> parameters_;  ///< of the keyword
  std::map<std::string, std::string> originals_;
  std::string set_name_;
  ElementKind kind_;  ///< of the elements that are read
  bool generate_ = false;
  std::vector<std::int64_t> pending_;  ///< numbers of the element so far
  IdMap node_ids_, solid_ids_, shell_ids_;
  std::vector<Place> solids_, shells_;
  std::vector<std::vector<VertexIndex>> listed_;
  Sets node_sets_, element_sets_;
  std::vector<DeckSurface> surfaces_;
};

}  // namespace

RawMesh read_abaqus(const Input& input) {
  return Abaqus(input).read();
}

}  // namespace octafront::io
