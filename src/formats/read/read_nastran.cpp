// Nastran bulk data in small fields (8 columns), large ones (16) or free ones (commas): GRID, CTETRA, CPENTA, CPYRAM,
// CTRIA3, CTRIA6, CQUAD4, CQUAD8, and SET of the case control. Properties are references; names are comments as
// write_nastran.cpp makes them.

#include "formats/containers/scanner.h"
#include "formats/parts/raw_mesh.h"
#include "formats/parts/wide_orders.h"
#include "formats/read/id_map.h"
#include "formats/read/readers.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
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
    std::string_view rest = line_;
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

  const Input& input_;
  Scanner scan_;
  bool started_ = false, has_line_ = false;
  std::string_view line_, text_;
  const char* card_at_ = nullptr;
  std::string name_;
  std::vector<std::string_view> fields_;
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

class Nastran {
 public:
  explicit Nastran(const Input& input) : input_(input), cards_(input) { raw_.format = "Nastran"; }

  RawMesh read() {
    while (cards_.next([this](std::string_view line) { note_name(line); })) {
      const std::string_view name = cards_.name();
      if (name == "GRID") {
        read_grid();
      } else if (name == "CTETRA") {
        read_element(solids_, cards_.field(6).empty() ? 4 : 10);
      } else if (name == "CPENTA") {
        read_element(solids_, has_fields(8, 17) ? 15 : 6);
      } else if (name == "CPYRAM" || name == "CPYRA") {
        read_element(solids_, has_fields(7, 15) ? 13 : 5);
      } else if (name == "CTRIA3") {
        read_element(shells_, 3);
      } else if (name == "CTRIA6") {
        read_element(shells_, 6);
      } else if (name == "CQUAD4" || name == "CQUAD8") {
        read_element(shells_, 4);
      } else if (name.starts_with("SET ")) {
        read_set();
      } else if (name == "CHEXA") {
        ++raw_.other_elements;
      } else if (name == "INCLUDE") {
        raw_.notes.emplace_back("INCLUDE is not followed: the file that it names was not read");
      }
    }
    if (other_systems_ > 0)
      raw_.notes.push_back(
          fmt::format("{} nodes are in other coordinate systems than the basic one, which are not "
                      "read here: they are taken as if they were in it",
                      other_systems_));
    resolve();
    return std::move(raw_);
  }

 private:
  struct Element {
    std::int64_t id, property;
    std::uint8_t count;
    std::array<std::int64_t, 15> nodes;
  };

  std::int64_t integer(std::string_view field, std::string_view what) const {
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || field.empty() || stop != field.data() + field.size())
      cards_.fail(fmt::format("expected {}, found {}", what, in_quotes(field)));
    return value;
  }

  void read_grid() {
    const std::int64_t id = integer(cards_.field(0), "the number of a node");
    other_systems_ += !cards_.field(1).empty() && cards_.field(1) != "0";
    std::array<double, 3> xyz{};
    for (std::size_t i = 0; i < 3; ++i)
      if (!cards_.field(2 + i).empty() && !parse_real(cards_.field(2 + i), xyz[i]))
        cards_.fail(fmt::format("expected a coordinate, found {}", in_quotes(cards_.field(2 + i))));
    if (!node_ids_.add(id)) cards_.fail(fmt::format("a second node {}; the file is damaged", id));
    raw_.points.push_back({xyz[0], xyz[1], xyz[2]});
    nodes_.push_back(id);
  }

  /// Whether none of these fields is empty: mid-side nodes may be left out.
  bool has_fields(std::size_t begin, std::size_t end) const {
    for (std::size_t i = begin; i < end; ++i)
      if (cards_.field(i).empty()) return false;
    return true;
  }

  void read_element(std::vector<Element>& to, std::uint8_t count) {
    Element e{integer(cards_.field(0), "the number of an element"), 0, count, {}};
    e.property = cards_.field(1).empty() ? e.id : integer(cards_.field(1), "the number of a property");
    for (std::size_t k = 0; k < count; ++k) e.nodes[k] = integer(cards_.field(2 + k), "the number of a node");
    to.push_back(e);
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
    if (of == "SET") set_names_[number] = {name, trimmed(words) == "GRID"};
  }

  /// SET 5 = 1, 4 THRU 9, ... over lines that end with a comma.
  void read_set() {
    std::string text(cards_.text());
    while (trimmed(text).ends_with(',') && cards_.has_line()) text.append(cards_.take_line());
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) return;
    const std::string_view number = trimmed(std::string_view(text).substr(4, equals - 4));
    std::int64_t id = 0;
    if (std::from_chars(number.data(), number.data() + number.size(), id).ec != std::errc()) return;
    std::string_view rest = std::string_view(text).substr(equals + 1);
    std::vector<std::pair<std::int64_t, std::int64_t>>& ranges = sets_[id];
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

  VertexIndex node(const Element& e, std::size_t k) const {
    const std::uint32_t v = node_ids_.find(e.nodes[k]);
    if (v == kNone)
      input_.fail(fmt::format("element {} has the node {}, which the file lacks; the file is damaged: export it again",
                              e.id, e.nodes[k]));
    return v;
  }

  using Places = std::vector<std::pair<std::int64_t, std::uint32_t>>;

  void add_solid(const Element& e, Places& place) {
    std::array<VertexIndex, 15> nodes, ours;
    for (std::size_t k = 0; k < e.count; ++k) nodes[k] = node(e, k);
    const std::span<const VertexIndex> all = std::span(nodes).first(e.count);
    const auto first = static_cast<std::uint32_t>(raw_.tets.size());
    if (e.count == 4 || e.count == 10)
      raw_.add_tet(all, e.property);
    else
      raw_.add_wide_cell(in_our_order(all, kCgnsWide, ours), e.property);
    for (std::uint32_t t = first; t < raw_.tets.size(); ++t) place.emplace_back(e.id, t);
  }

  void add_shell(const Element& e, std::int64_t shift, Places& place) {
    std::array<VertexIndex, 8> nodes;
    for (std::size_t k = 0; k < e.count; ++k) nodes[k] = node(e, k);
    const auto first = static_cast<std::uint32_t>(raw_.triangles.size());
    raw_.add_face(std::span(nodes).first(e.count), e.property - shift);
    for (std::uint32_t f = first; f < raw_.triangles.size(); ++f) place.emplace_back(e.id, f);
  }

  void resolve() {
    std::vector<std::pair<std::int64_t, std::uint32_t>> tet_of, triangle_of, node_of;
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
    for (const auto& [id, ranges] : sets_) {
      const auto found = set_names_.find(id);
      // Without a name a set may be of anything.
      if (found == set_names_.end()) continue;
      const auto& [name, of_nodes] = found->second;
      if (of_nodes) {
        if (node_of.empty())
          for (std::uint32_t v = 0; v < nodes_.size(); ++v) node_of.emplace_back(nodes_[v], v);
        add_set(name, Kind::kNodes, ranges, node_of);
      } else {
        add_set(name, Kind::kElements, ranges, tet_of);
        add_set(name, Kind::kFaces, ranges, triangle_of);
      }
    }
  }

  /// `of`: ids and places. Ranges may be far wider than the mesh.
  void add_set(const std::string& name, Kind kind, std::vector<std::pair<std::int64_t, std::int64_t>> ranges,
               std::vector<std::pair<std::int64_t, std::uint32_t>>& of) {
    std::sort(of.begin(), of.end());
    std::sort(ranges.begin(), ranges.end());
    RawMesh::Group group{name, kind, {}};
    std::size_t r = 0;
    for (const auto& [id, place] : of) {
      while (r < ranges.size() && ranges[r].second < id) ++r;
      if (r < ranges.size() && ranges[r].first <= id) group.members.push_back(place);
    }
    if (!group.members.empty()) raw_.groups.push_back(std::move(group));
  }

  const Input& input_;
  Cards cards_;
  RawMesh raw_;
  IdMap node_ids_;
  std::vector<std::int64_t> nodes_;  ///< their numbers
  std::vector<Element> solids_, shells_;
  std::uint64_t other_systems_ = 0;
  std::map<std::int64_t, std::string> shell_names_;
  std::map<std::int64_t, std::pair<std::string, bool>> set_names_;  ///< and whether it is of nodes
  std::map<std::int64_t, std::vector<std::pair<std::int64_t, std::int64_t>>> sets_;
};

}  // namespace

RawMesh read_nastran(const Input& input) {
  return Nastran(input).read();
}

}  // namespace octafront::io
