// Nastran bulk data in small fields (8 columns), large ones (16) or free ones (commas): GRID in any system of
// coordinates, CTETRA, CPENTA, CPYRAM, CHEXA, CTRIA3, CTRIA6, CTRIAR, CQUAD4, CQUAD8, CQUADR, INCLUDE, and SET of the
// case control. Properties are references; names are comments as write_nastran.cpp makes them.

#include "formats/containers/scanner.h"
#include "formats/parts/raw_mesh.h"
#include "formats/parts/wide_orders.h"
#include "formats/read/id_map.h"
#include "formats/read/included_file.h"
#include "formats/read/node_systems.h"
#include "formats/read/readers.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;

/// Lines joined to cards.
class Cards {
 public:
  explicit Cards(const Input& input) : input_(input), scan_(input) {
    // The first line of all.
    next_line();
  }

  /// The next line that is no comment starts a card; comments are told. False at the end.
  template <class Comment>
  bool next(const Comment& comment) {
    while (has_line_ && (line_.starts_with('$') || trimmed(line_).empty())) {
      comment(line_);
      next_line();
    }
    if (!has_line_) return false;
    card_at_ = line_.data();
    fields_.clear();
    widened_.clear();
    text_ = line_;
    split(true);
    next_line();
    // Continued lines begin with nothing, + or *.
    while (has_line_ && is_continuation()) {
      split(false);
      next_line();
    }
    return true;
  }
  /// In upper case without "*".
  std::string_view name() const { return name_; }
  std::string_view text() const { return text_; }
  const Input& input() const { return input_; }
  std::string_view field(std::size_t i) const { return i < fields_.size() ? fields_[i] : std::string_view(); }
  std::size_t size() const { return fields_.size(); }
  /// For lines that are no cards: the next one as it is.
  std::string_view take_line() {
    const std::string_view line = line_;
    next_line();
    return line;
  }
  bool has_line() const { return has_line_; }
  [[noreturn]] void fail(std::string_view message) const { input_.fail_at_line(card_at_, message); }

 private:
  void next_line() {
    const char* const end = input_.bytes.data() + input_.bytes.size();
    const char* at = scan_.position();
    if (started_) {
      if (at != end && *at == '\r') ++at;
      if (at != end && *at == '\n') ++at;
    }
    started_ = true;
    has_line_ = at != end;
    scan_.set_position(at);
    scan_.at_line_end();  // asks whether to go on
    scan_.set_position(at);
    scan_.skip_line();
    line_ = {at, static_cast<std::size_t>(scan_.position() - at)};
  }

  bool is_continuation() const {
    return !line_.empty() && (line_[0] == ' ' || line_[0] == '+' || line_[0] == '*' || line_[0] == ',') &&
           !trimmed(line_).empty();
  }

  void split(bool first) {
    const bool is_free = line_.find(',') != std::string_view::npos;
    std::string_view rest = is_free ? line_ : without_tabs(line_);
    const auto take = [&](std::size_t width) {
      const std::size_t end = is_free ? std::min(rest.find(','), rest.size()) : std::min(width, rest.size());
      const std::string_view field = trimmed(rest.substr(0, end));
      rest.remove_prefix(std::min(rest.size(), is_free ? end + 1 : end));
      return field;
    };
    const std::string_view head = take(8);
    const bool large = first ? head.ends_with('*') : head.starts_with('*');
    if (first) {
      name_.clear();
      for (const char c : head)
        if (c != '*') name_ += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    }
    const std::size_t count = large ? 4 : 8;
    for (std::size_t k = 0; k < count; ++k) fields_.push_back(take(large ? 16 : 8));
  }

  /// A tab leads to the next field.
  std::string_view without_tabs(std::string_view line) {
    if (line.find('\t') == std::string_view::npos) return line;
    constexpr std::size_t kField = 8;
    std::string& wide = widened_.emplace_back();
    for (const char c : line)
      c == '\t' ? static_cast<void>(wide.resize((wide.size() / kField + 1) * kField, ' ')) : wide.push_back(c);
    return wide;
  }

  const Input& input_;
  Scanner scan_;
  bool started_ = false, has_line_ = false;
  std::string_view line_, text_;
  const char* card_at_ = nullptr;
  std::string name_;
  std::vector<std::string_view> fields_;
  std::deque<std::string> widened_;  ///< lines of the card that had tabs
};

/// "1.5-7", "1.5D+3" and the usual ways.
bool parse_real(std::string_view text, double& value) {
  std::string usual;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == 'D' || c == 'd' || c == 'e' || c == 'E') {
      usual += 'e';
    } else {
      if (i > 0 && (c == '-' || c == '+') && usual.back() != 'e') usual += 'e';
      usual += c;
    }
  }
  // "1.e+3": a plus in the exponent is known to from_chars.
  return parse_number(usual, value) && std::isfinite(value);
}

/// Calls visit(edge, place of its mid-side node among the nodes) for the edges of a solid of second order.
template <class Visit>
void for_each_mid(std::span<const VertexIndex> nodes, const Visit& visit) {
  constexpr std::array<std::array<std::size_t, 2>, 6> kTetrahedron{{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};
  const std::span<const std::array<std::size_t, 2>> edges =
      nodes.size() == 10   ? std::span<const std::array<std::size_t, 2>>(kTetrahedron)
      : nodes.size() == 15 ? std::span<const std::array<std::size_t, 2>>(kWedgeEdges)
      : nodes.size() == 13 ? std::span<const std::array<std::size_t, 2>>(kPyramidEdges)
                           : std::span<const std::array<std::size_t, 2>>();
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const VertexIndex a = nodes[edges[k][0]], b = nodes[edges[k][1]];
    visit(Edge{std::min(a, b), std::max(a, b)}, nodes.size() - edges.size() + k);
  }
}

/// Numbers of nodes or elements in the file, and their places in the mesh.
using Places = std::vector<std::pair<std::int64_t, std::uint32_t>>;

/// The sets of the case control, and what comments say of them.
class CaseSets {
 public:
  void call(std::int64_t number, std::string name, bool of_nodes) { names_[number] = {std::move(name), of_nodes}; }

  /// SET 5 = 1, 4 THRU 9, ... over lines that end with a comma.
  void read(Cards& cards) {
    std::string text(cards.text());
    while (trimmed(text).ends_with(',') && cards.has_line()) text.append(cards.take_line());
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) return;
    const std::string_view number = trimmed(std::string_view(text).substr(4, equals - 4));
    std::int64_t id = 0;
    if (std::from_chars(number.data(), number.data() + number.size(), id).ec != std::errc()) return;
    std::string_view rest = std::string_view(text).substr(equals + 1);
    Ranges& ranges = ranges_[id];
    while (!rest.empty()) {
      const std::size_t comma = std::min(rest.find(','), rest.size());
      std::string_view item = trimmed(rest.substr(0, comma));
      rest.remove_prefix(std::min(rest.size(), comma + 1));
      std::int64_t first = 0, last = 0;
      const auto [stop, error] = std::from_chars(item.data(), item.data() + item.size(), first);
      if (error != std::errc()) continue;  // "ALL", "EXCEPT"
      last = first;
      item = trimmed(item.substr(static_cast<std::size_t>(stop - item.data())));
      if (item.starts_with("THRU")) {
        item = trimmed(item.substr(4));
        if (std::from_chars(item.data(), item.data() + item.size(), last).ec != std::errc()) last = first;
      }
      ranges.emplace_back(first, last);
    }
  }

  void put_into(RawMesh& raw, Places& node_of, Places& tet_of, Places& triangle_of) const {
    std::size_t nameless = 0;
    for (const auto& [id, ranges] : ranges_) {
      const auto found = names_.find(id);
      // Without a name a set may be of anything.
      nameless += found == names_.end();
      if (found == names_.end()) continue;
      const auto& [name, of_nodes] = found->second;
      if (of_nodes) {
        add_set(raw, name, Kind::kNodes, ranges, node_of);
      } else {
        add_set(raw, name, Kind::kElements, ranges, tet_of);
        add_set(raw, name, Kind::kFaces, ranges, triangle_of);
      }
    }
    if (nameless > 0)
      raw.notes.push_back(
          fmt::format("{} SET of the case control left out: the file does not say what they are of", nameless));
  }

 private:
  using Ranges = std::vector<std::pair<std::int64_t, std::int64_t>>;

  /// `of`: ids and places. Ranges may be far wider than the mesh.
  static void add_set(RawMesh& raw, const std::string& name, Kind kind, Ranges ranges, Places& of) {
    std::sort(of.begin(), of.end());
    std::sort(ranges.begin(), ranges.end());
    RawMesh::Group group{name, kind, {}};
    std::size_t r = 0;
    for (const auto& [id, place] : of) {
      while (r < ranges.size() && ranges[r].second < id) ++r;
      if (r < ranges.size() && ranges[r].first <= id) group.members.push_back(place);
    }
    if (!group.members.empty()) raw.groups.push_back(std::move(group));
  }

  std::map<std::int64_t, std::pair<std::string, bool>> names_;  ///< and whether it is of nodes
  std::map<std::int64_t, Ranges> ranges_;
};

class Nastran {
 public:
  explicit Nastran(const Input& input) : input_(input) { raw_.format = "Nastran"; }

  RawMesh read() {
    read_cards(input_, 0);
    resolve();
    return std::move(raw_);
  }

 private:
  /// A grid point as it stands in the file.
  struct Grid {
    std::int64_t id, system;  ///< kDefault: that of GRDSET
    Vec3 numbers;
  };
  static constexpr std::int64_t kDefault = -1;

  struct Element {
    std::int64_t id, property;
    std::uint8_t count;
    std::array<std::int64_t, 15> nodes;  ///< kBlank: a mid-side node that is left out
  };
  static constexpr std::int64_t kBlank = std::numeric_limits<std::int64_t>::min();

  /// A system of coordinates by three points, or by three grid points.
  struct System {
    NodeSystem::Kind kind;
    std::int64_t within = 0;              ///< the system of the points
    std::array<Vec3, 3> points{};         ///< the origin, one on Z, one towards X
    std::array<std::int64_t, 3> grids{};  ///< 0: by points
    enum class State { kGiven, kWanted, kKnown } state = State::kGiven;
    NodeSystem known = {};
  };

  void read_cards(const Input& input, int depth) {
    Cards cards(input);
    cards_ = &cards;
    while (cards.next([this](std::string_view line) { note_name(line); })) {
      if (cards.name() == "ENDDATA") break;
      if (cards.name() == "INCLUDE" || cards.name().starts_with("INCLUDE ") || cards.name().starts_with("INCLUDE'")) {
        include(cards, depth);
      } else {
        read_card(cards.name());
      }
    }
  }

  void read_card(std::string_view name) {
    if (name == "GRID") {
      read_grid();
    } else if (name == "GRDSET") {
      if (!cards_->field(1).empty()) default_system_ = integer(cards_->field(1), "a system of coordinates");
    } else if (name.starts_with("CORD") && name.size() == 6) {
      read_system(name);
    } else if (name == "CTETRA") {
      read_element(solids_, has_some(6, 12) ? 10 : 4, 4);
    } else if (name == "CPENTA") {
      read_element(solids_, has_some(8, 17) ? 15 : 6, 6);
    } else if (name == "CPYRAM" || name == "CPYRA") {
      read_element(solids_, has_some(7, 15) ? 13 : 5, 5);
    } else if (name == "CTRIA3" || name == "CTRIA6" || name == "CTRIAR") {
      read_element(shells_, 3, 3);
    } else if (name == "CQUAD4" || name == "CQUAD8" || name == "CQUADR") {
      read_element(shells_, 4, 4);
    } else if (name.starts_with("SET ")) {
      sets_.read(*cards_);
    } else if (is_other_element(name)) {
      ++raw_.other_elements;
    } else if (name == "CHEXA") {
      read_element(solids_, 8, 8);
    }
  }

  /// Bars, springs, masses, rigid bodies.
  static bool is_other_element(std::string_view name) {
    constexpr std::array<std::string_view, 16> kOthers{"CBAR",   "CBEAM", "CROD", "CONROD", "CTUBE", "CELAS1",
                                                       "CELAS2", "CBUSH", "CGAP", "CSHEAR", "CONM1", "CONM2",
                                                       "RBE1",   "RBE2",  "RBE3", "CTRIAX6"};
    return std::find(kOthers.begin(), kOthers.end(), name) != kOthers.end();
  }

  /// INCLUDE 'FILE', over several lines if need be.
  void include(Cards& cards, int depth) {
    constexpr int kMostNested = 8, kMostFiles = 1000;
    std::string text(trimmed(cards.text().substr(std::string_view("INCLUDE").size())));
    const char quote = text.empty() ? ' ' : text.front();
    const bool is_quoted = quote == '\'' || quote == '"';
    while (is_quoted && text.find(quote, 1) == std::string::npos && cards.has_line())
      text += trimmed(cards.take_line());
    std::string name = is_quoted ? text.substr(1, text.find(quote, 1) - 1) : text.substr(0, text.find_first_of(" \t$"));
    if (depth >= kMostNested || ++files_ > kMostFiles) cards.fail("includes too many files, or itself");
    std::optional<LoadedFile> file = included_file(cards.input(), name);
    if (!file) {
      raw_.notes.push_back(
          fmt::format("INCLUDE names {}, which is not in the folder of the file: it was not read", in_quotes(name)));
      return;
    }
    read_cards(file->input(), depth + 1);
    cards_ = &cards;
  }

  std::int64_t integer(std::string_view field, std::string_view what) const {
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || field.empty() || stop != field.data() + field.size())
      cards_->fail(fmt::format("expected {}, found {}", what, in_quotes(field)));
    return value;
  }
  double real(std::string_view field) const {
    double value = 0;
    if (!field.empty() && !parse_real(field, value))
      cards_->fail(fmt::format("expected a coordinate, found {}", in_quotes(field)));
    return value;
  }
  Vec3 point(std::size_t first) const {
    return {real(cards_->field(first)), real(cards_->field(first + 1)), real(cards_->field(first + 2))};
  }

  void read_grid() {
    const std::int64_t id = integer(cards_->field(0), "the number of a node");
    const std::int64_t system =
        cards_->field(1).empty() ? kDefault : integer(cards_->field(1), "a system of coordinates");
    const Grid grid{id, system, point(2)};
    if (!node_ids_.add(id)) {
      // Some programs list a node in each file that needs it.
      const Grid& known = grids_[node_ids_.find(id)];
      if (known.system != system || known.numbers != grid.numbers)
        cards_->fail(fmt::format("a second node {}; the file is damaged", id));
      return;
    }
    grids_.push_back(grid);
  }

  /// CORD2R, CORD2C, CORD2S by points, CORD1R ... by grid points, two in a card.
  void read_system(std::string_view name) {
    const auto kind = name[5] == 'R'   ? NodeSystem::Kind::kRectangular
                      : name[5] == 'C' ? NodeSystem::Kind::kCylindrical
                                       : NodeSystem::Kind::kPolar;
    if (name[4] == '2') {
      System& system = systems_[integer(cards_->field(0), "the number of a system of coordinates")];
      system = {kind};
      if (!cards_->field(1).empty()) system.within = integer(cards_->field(1), "a system of coordinates");
      system.points = {point(2), point(5), point(8)};
      return;
    }
    if (name[4] != '1') return;
    for (const std::size_t first : {0, 4}) {
      if (cards_->field(first).empty()) continue;
      System& system = systems_[integer(cards_->field(first), "the number of a system of coordinates")];
      system = {kind};
      for (std::size_t k = 0; k < 3; ++k)
        system.grids[k] = integer(cards_->field(first + 1 + k), "the number of a node");
    }
  }

  /// Whether some of these fields is not empty: mid-side nodes may be left out.
  bool has_some(std::size_t begin, std::size_t end) const {
    for (std::size_t i = begin; i < end; ++i)
      if (!cards_->field(i).empty()) return true;
    return false;
  }

  void read_element(std::vector<Element>& to, std::uint8_t count, std::uint8_t corners) {
    Element e{integer(cards_->field(0), "the number of an element"), 0, count, {}};
    e.property = cards_->field(1).empty() ? e.id : integer(cards_->field(1), "the number of a property");
    for (std::size_t k = 0; k < count; ++k) {
      const std::string_view field = cards_->field(2 + k);
      const bool is_blank = k >= corners && (field.empty() || field == "0");
      e.nodes[k] = is_blank ? kBlank : integer(field, "the number of a node");
    }
    to.push_back(e);
  }

  /// In the basic system.
  Vec3 place_of(const Grid& grid) {
    const std::int64_t system = grid.system == kDefault ? default_system_ : grid.system;
    return system == 0 ? grid.numbers : system_of(system).global(grid.numbers);
  }
  const NodeSystem& system_of(std::int64_t number) {
    const auto found = systems_.find(number);
    if (found == systems_.end())
      input_.fail(fmt::format("nodes are in the system of coordinates {}, which the file lacks{}", number,
                              raw_.notes.empty() ? "" : "; " + raw_.notes.back()));
    System& system = found->second;
    if (system.state == System::State::kKnown) return system.known;
    if (system.state == System::State::kWanted)
      input_.fail(fmt::format("the system of coordinates {} is said by itself", number));
    system.state = System::State::kWanted;
    std::array<Vec3, 3> at = system.points;
    for (std::size_t k = 0; k < 3; ++k) {
      if (system.grids[k] != 0) {
        const std::uint32_t grid = node_ids_.find(system.grids[k]);
        if (grid == kNone)
          input_.fail(fmt::format("the system of coordinates {} has the node {}, which the file lacks", number,
                                  system.grids[k]));
        at[k] = place_of(grids_[grid]);
      } else if (system.within != 0) {
        at[k] = system_of(system.within).global(at[k]);
      }
    }
    system.known.kind = system.kind;
    system.known.origin = at[0];
    if (!set_axes_by_zx(system.known, at[1] - at[0], at[2] - at[0]))
      input_.fail(fmt::format("the points of the system of coordinates {} lie on one line", number));
    system.state = System::State::kKnown;
    return system.known;
  }

  /// "$ NAME PSOLID 1 "left part"", "$ NAME SET 2 GRID "near"".
  void note_name(std::string_view line) {
    constexpr std::string_view kHead = "$ NAME ";
    if (!line.starts_with(kHead)) return;
    const std::size_t open = line.find('"'), close = line.rfind('"');
    if (open == std::string_view::npos || close <= open) return;
    const std::string name(line.substr(open + 1, close - open - 1));
    std::string_view words = line.substr(kHead.size(), open - kHead.size());
    const std::size_t blank = words.find(' ');
    if (blank == std::string_view::npos) return;
    const std::string_view of = words.substr(0, blank);
    words.remove_prefix(blank + 1);
    std::int64_t number = 0;
    const auto [stop, error] = std::from_chars(words.data(), words.data() + words.size(), number);
    if (error != std::errc()) return;
    words.remove_prefix(static_cast<std::size_t>(stop - words.data()));
    if (of == "PSOLID") raw_.region_names[number] = name;
    if (of == "PSHELL") shell_names_[number] = name;
    if (of == "SET") sets_.call(number, name, trimmed(words) == "GRID");
  }

  VertexIndex node(const Element& e, std::size_t k) const {
    if (e.nodes[k] == kBlank) return kNone;
    const std::uint32_t v = node_ids_.find(e.nodes[k]);
    if (v == kNone)
      input_.fail(fmt::format("element {} has the node {}, which the file lacks{}", e.id, e.nodes[k],
                              raw_.notes.empty() ? "; it is damaged: export it again" : "; " + raw_.notes.back()));
    return v;
  }

  /// The nodes of a solid, a wedge or pyramid in our order.
  std::span<const VertexIndex> nodes_of(const Element& e, std::array<VertexIndex, 15>& room) const {
    std::array<VertexIndex, 15> nodes;
    for (std::size_t k = 0; k < e.count; ++k) nodes[k] = node(e, k);
    const std::span<const VertexIndex> all = std::span(nodes).first(e.count);
    if (e.count != 4 && e.count != 8 && e.count != 10) return in_our_order(all, kCgnsWide, room);
    std::copy(all.begin(), all.end(), room.begin());
    return std::span(room).first(e.count);
  }

  /// A mid-side node that an element leaves out is that of a neighbour, else in the middle.
  void find_blank_mids() {
    const auto has_blank = [](const Element& e) {
      return std::find(e.nodes.begin(), e.nodes.begin() + e.count, kBlank) != e.nodes.begin() + e.count;
    };
    if (std::none_of(solids_.begin(), solids_.end(), has_blank)) return;
    std::array<VertexIndex, 15> room;
    for (const Element& e : solids_) {
      const auto nodes = nodes_of(e, room);
      for_each_mid(nodes, [&](const Edge& edge, std::size_t k) {
        if (nodes[k] != kNone) mid_of_.try_emplace(edge, nodes[k]);
      });
    }
  }
  VertexIndex mid_of(const Edge& edge) {
    const auto [entry, is_new] = mid_of_.try_emplace(edge, static_cast<VertexIndex>(raw_.points.size()));
    if (is_new) raw_.points.push_back((raw_.points[edge[0]] + raw_.points[edge[1]]) * 0.5), ++made_mids_;
    return entry->second;
  }

  void add_solid(const Element& e, Places& place) {
    std::array<VertexIndex, 15> room;
    const auto nodes = nodes_of(e, room);
    for_each_mid(nodes, [&](const Edge& edge, std::size_t k) {
      if (room[k] == kNone) room[k] = mid_of(edge);
    });
    const auto first = static_cast<std::uint32_t>(raw_.tets.size());
    if (e.count == 4 || e.count == 10)
      raw_.add_tet(nodes, e.property);
    else if (e.count == 8)
      raw_.add_hexahedron(nodes, e.property);
    else
      raw_.add_wide_cell(nodes, e.property);
    for (std::uint32_t t = first; t < raw_.tets.size(); ++t) place.emplace_back(e.id, t);
  }

  void add_shell(const Element& e, std::int64_t shift, Places& place) {
    std::array<VertexIndex, 4> nodes;
    for (std::size_t k = 0; k < e.count; ++k) nodes[k] = node(e, k);
    const auto first = static_cast<std::uint32_t>(raw_.triangles.size());
    raw_.add_face(std::span(nodes).first(e.count), e.property - shift);
    for (std::uint32_t f = first; f < raw_.triangles.size(); ++f) place.emplace_back(e.id, f);
  }

  void resolve() {
    for (const Grid& grid : grids_) raw_.points.push_back(place_of(grid));
    find_blank_mids();
    Places tet_of, triangle_of, node_of;
    std::int64_t last_solid = 0, first_shell = std::numeric_limits<std::int64_t>::max();
    for (const Element& e : solids_) {
      add_solid(e, tet_of);
      last_solid = std::max(last_solid, e.property);
    }
    for (const Element& e : shells_) first_shell = std::min(first_shell, e.property);
    // Properties of shells that count on behind those of solids are counted from 1.
    const std::int64_t shift = first_shell > last_solid ? last_solid : 0;
    for (const Element& e : shells_) add_shell(e, shift, triangle_of);
    for (const auto& [property, name] : shell_names_) raw_.surface_names[property - shift] = name;
    if (made_mids_ > 0)
      raw_.notes.push_back(fmt::format("{} mid-side nodes that elements leave out were put in the middle", made_mids_));
    for (std::uint32_t v = 0; v < grids_.size(); ++v) node_of.emplace_back(grids_[v].id, v);
    sets_.put_into(raw_, node_of, tet_of, triangle_of);
  }

  const Input& input_;
  Cards* cards_ = nullptr;  ///< of the file that is read
  int files_ = 0;           ///< that were included
  RawMesh raw_;
  IdMap node_ids_;
  std::vector<Grid> grids_;
  std::map<std::int64_t, System> systems_;
  std::int64_t default_system_ = 0;
  std::map<Edge, VertexIndex> mid_of_;
  std::uint64_t made_mids_ = 0;
  std::vector<Element> solids_, shells_;
  std::map<std::int64_t, std::string> shell_names_;
  CaseSets sets_;
};

}  // namespace

Told told_nastran(const FileHead& head) {
  if (head.input.bytes.starts_with("*KEYWORD")) return Told::kNot;  // of LS-DYNA
  const bool is_ours =
      head.ends_in({".bdf", ".nas"}) || head.has_line("BEGIN BULK") || head.has_line("GRID") || head.has_line("CTETRA");
  return is_ours ? Told::kLines : Told::kNot;
}

RawMesh read_nastran(const Input& input) {
  return Nastran(input).read();
}

}  // namespace octafront::io
