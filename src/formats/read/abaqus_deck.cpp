#include "formats/read/abaqus_deck.h"

#include "formats/read/included_file.h"
#include "formats/read/node_systems.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

/// Rows of the matrix that turns about a line by an angle in degrees.
std::array<Vec3, 3> rotation_about(Vec3 axis, double degrees) {
  const Vec3 u = axis * (1 / length(axis));
  const auto [s, c] = sine_and_cosine(degrees);
  const double t = 1 - c;
  return {{{c + u.x * u.x * t, u.x * u.y * t - u.z * s, u.x * u.z * t + u.y * s},
           {u.y * u.x * t + u.z * s, c + u.y * u.y * t, u.y * u.z * t - u.x * s},
           {u.z * u.x * t - u.y * s, u.z * u.y * t + u.x * s, c + u.z * u.z * t}}};
}

std::uint8_t nodes_of_solid(std::string_view type) {
  const auto is = [&](std::string_view head) { return type.starts_with(head); };
  if (is("C3D15V")) return 0;
  if (is("C3D20") || is("DC3D20") || is("AC3D20")) return 20;
  if (is("C3D8") || is("DC3D8") || is("AC3D8")) return 8;
  if (is("C3D15") || is("DC3D15") || is("AC3D15")) return 15;
  if (is("C3D6") || is("DC3D6") || is("AC3D6")) return 6;
  if (is("C3D5") || is("DC3D5") || is("AC3D5")) return 5;
  if (is("C3D10") || is("DC3D10") || is("AC3D10")) return 10;
  if (is("C3D4") || is("DC3D4") || is("AC3D4")) return 4;
  return 0;
}

std::uint8_t nodes_of_shell(std::string_view type) {
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

/// Reads line by line; where a line belongs follows from the keywords before it.
class DeckReader {
 public:
  explicit DeckReader(const Input& input) : lines_(input) {}

  DeckModel read() {
    const auto comment = [this](std::string_view line) { note_name(line); };
    bool more = lines_.next(comment);
    while (more) {
      if (!lines_.is_keyword()) {
        more = lines_.next(comment);
        continue;
      }
      read_keyword();
      data_lines_ = 0;
      while ((more = lines_.next(comment)) && !lines_.is_keyword()) read_data();
      finish_keyword();
    }
    if (!generated_.empty()) note_generated();
    model_.bytes = lines_.bytes();
    return std::move(model_);
  }

 private:
  enum class Section { kNone, kNodes, kElements, kNodeSet, kElementSet, kSurface, kInstance, kSystem };

  /// "** NAME left_part IS "left part"", as we write it.
  void note_name(std::string_view line) {
    constexpr std::string_view kHead = "** NAME ", kIs = " IS \"";
    const std::size_t is = line.find(kIs);
    if (!line.starts_with(kHead) || is == std::string_view::npos || !line.ends_with('"')) return;
    if (line.size() < is + kIs.size() + 1) return;
    model_.originals[upper(line.substr(kHead.size(), is - kHead.size()))] =
        line.substr(is + kIs.size(), line.size() - is - kIs.size() - 1);
  }

  std::string parameter(std::string_view key) const {
    const auto found = parameters_.find(std::string(key));
    return found != parameters_.end() ? found->second : std::string();
  }

  void read_parameters(const std::vector<std::string_view>& fields) {
    parameters_.clear();
    for (std::size_t i = 1; i < fields.size(); ++i) {
      const std::size_t equals = fields[i].find('=');
      std::string_view value = equals == std::string_view::npos ? "" : trimmed(fields[i].substr(equals + 1));
      if (value.size() >= 2 && value.front() == '"' && value.back() == '"') value = value.substr(1, value.size() - 2);
      parameters_[upper(trimmed(fields[i].substr(0, equals)))] = value;
    }
  }

  void read_keyword() {
    const auto& fields = lines_.fields();
    const std::string keyword = fields.empty() ? std::string() : upper(fields[0]);
    read_parameters(fields);
    section_ = Section::kNone;
    generate_ = parameters_.contains("GENERATE");
    if (keyword == "*NODE") {
      section_ = Section::kNodes;
      set_name_ = parameter("NSET");
      const std::string kind = upper(parameter("SYSTEM"));
      system_.kind = kind == "C"   ? NodeSystem::Kind::kCylindrical
                     : kind == "S" ? NodeSystem::Kind::kLatitude
                                   : NodeSystem::Kind::kRectangular;
    } else if (keyword == "*ELEMENT") {
      section_ = Section::kElements;
      kind_ = deck_kind_of(upper(parameter("TYPE")));
      set_name_ = parameter("ELSET");
      pending_.clear();
    } else if (keyword == "*NSET" || keyword == "*ELSET") {
      begin_set(keyword);
    } else if (keyword == "*SURFACE") {
      begin_surface();
    } else if (keyword == "*PART") {
      model_.parts.push_back({parameter("NAME"), {}, {}, {}, {}, {}, {}, {}});
      is_in_part_ = true, system_ = {};
    } else if (keyword == "*END PART") {
      is_in_part_ = false, system_ = {};
    } else if (keyword == "*INSTANCE") {
      model_.instances.push_back({parameter("NAME"), parameter("PART"), {}, {}});
      is_in_instance_ = true, system_ = {};
      section_ = Section::kInstance;
    } else if (keyword == "*END INSTANCE") {
      is_in_instance_ = false, system_ = {};
    } else if (keyword == "*SYSTEM") {
      section_ = Section::kSystem;
      system_ = {};
    } else if (keyword == "*NGEN" || keyword == "*NFILL" || keyword == "*NCOPY" || keyword == "*ELGEN" ||
               keyword == "*ELCOPY" || keyword == "*NMAP") {
      generated_.insert(keyword);
    }
    if (const std::string file = parameter("INPUT"); !file.empty()) read_file(keyword, file);
  }

  /// Lines of another file, which are data of the keyword, or all of *INCLUDE.
  void read_file(const std::string& keyword, const std::string& file) {
    if (keyword != "*INCLUDE" && section_ == Section::kNone) return;
    if (lines_.include(file)) return;
    const std::string what =
        fmt::format("{} names {}, which is not in the folder of the deck", keyword, in_quotes(file));
    if (keyword != "*INCLUDE") lines_.fail(what + ": put it there");
    model_.notes.push_back(what + ": it was not read");
  }

  void begin_set(const std::string& keyword) {
    section_ = keyword == "*NSET" ? Section::kNodeSet : Section::kElementSet;
    set_name_ = parameter(keyword.substr(1));
    if (set_name_.empty()) lines_.fail(fmt::format("{} has no name: {}=NAME is missing", keyword, keyword.substr(1)));
    DeckSet& set = sets().at(set_name_);
    set.is_internal = set.is_internal || parameters_.contains("INTERNAL");
  }

  void begin_surface() {
    const std::string type = upper(parameter("TYPE"));
    const bool of_nodes = type == "NODE";
    if (parameters_.contains("COMBINE") || (!type.empty() && type != "ELEMENT" && !of_nodes)) {
      model_.notes.push_back(fmt::format("the surface {} is {}: left out", in_quotes(parameter("NAME")),
                                         type.empty() || type == "ELEMENT" ? "made of others" : "of type " + type));
      return;
    }
    section_ = Section::kSurface;
    block().surfaces.push_back({parameter("NAME"), of_nodes, {}});
  }

  DeckBlock& block() {
    if (is_in_instance_) return model_.instances.back().own;
    return is_in_part_ ? model_.parts.back() : model_.assembly;
  }
  DeckSets& sets() {
    const bool of_nodes = section_ == Section::kNodeSet || section_ == Section::kNodes;
    return of_nodes ? block().node_sets : block().element_sets;
  }

  void read_data() {
    const auto& fields = lines_.fields();
    ++data_lines_;
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
      case Section::kInstance:
        return read_place(fields);
      case Section::kSystem:
        return read_system(fields);
      default:
        return;
    }
  }

  void read_node(const std::vector<std::string_view>& fields) {
    if (fields.size() < 2) lines_.fail("expected a node: its number and coordinates");
    const std::int64_t id = lines_.integer(fields[0], "the number of a node");
    std::array<double, 3> xyz{};
    for (std::size_t i = 0; i < 3 && i + 1 < fields.size(); ++i)
      if (!fields[i + 1].empty()) xyz[i] = lines_.real(fields[i + 1]);
    block().node_ids.push_back(id);
    block().points.push_back(system_.global({xyz[0], xyz[1], xyz[2]}));
    if (!set_name_.empty()) sets().at(set_name_).members.push_back({{}, id});
  }

  void read_element(const std::vector<std::string_view>& fields) {
    if (kind_.nodes == 0) {
      // The lines of an element of another kind: counted by those that do not go on.
      model_.other_elements += !lines_.line().ends_with(',');
      return;
    }
    for (const std::string_view field : fields) pending_.push_back(lines_.integer(field, "a number of an element"));
    if (pending_.size() <= kind_.nodes) return;
    if (pending_.size() > kind_.nodes + std::size_t{1})
      lines_.fail(fmt::format("element {} has more than {} nodes", pending_[0], kind_.nodes));
    DeckBlock& to = block();
    to.elements.push_back({pending_[0], to.nodes_of.size(), kind_});
    to.nodes_of.insert(to.nodes_of.end(), pending_.begin() + 1, pending_.end());
    if (!set_name_.empty()) sets().at(set_name_).members.push_back({{}, pending_[0]});
    pending_.clear();
  }

  /// A few words can ask for millions of members: all sets together have no more than a multiple of the file's bytes.
  void spend(std::uint64_t members) {
    constexpr std::uint64_t kMembersPerByte = 16, kAlways = 1 << 16;
    const std::uint64_t most = kMembersPerByte * lines_.bytes() + kAlways;
    if (members > most || (spent_ += members) > most)
      lines_.fail("the sets up to here have more members than such a file can need; write them out, without GENERATE");
  }

  /// "5", "NAME", "INSTANCE.5", "INSTANCE.NAME", of the instance of the keyword.
  DeckMember member(std::string_view field) const {
    DeckMember made{upper(parameter("INSTANCE"))};
    if (const std::size_t dot = field.find('.'); dot != std::string_view::npos && is_instance(field.substr(0, dot))) {
      made.instance = upper(field.substr(0, dot));
      field.remove_prefix(dot + 1);
    }
    if (const auto id = lines_.whole(field)) {
      made.id = *id;
    } else {
      if (field.size() >= 2 && field.front() == '"' && field.back() == '"') field = field.substr(1, field.size() - 2);
      made.name = field;
    }
    return made;
  }
  bool is_instance(std::string_view name) const {
    const std::string wanted = upper(name);
    return std::any_of(model_.instances.begin(), model_.instances.end(),
                       [&](const DeckInstance& instance) { return upper(instance.name) == wanted; });
  }

  void read_set(const std::vector<std::string_view>& fields) {
    DeckSet& set = sets().at(set_name_);
    if (!generate_) {
      for (const std::string_view field : fields)
        if (!field.empty()) set.members.push_back(member(field));
      return;
    }
    if (fields.size() < 2) lines_.fail("expected the first and the last number, and the step");
    const std::int64_t first = lines_.integer(fields[0], "a number"), last = lines_.integer(fields[1], "a number"),
                       step = fields.size() > 2 ? lines_.integer(fields[2], "a step") : 1;
    const std::uint64_t range = static_cast<std::uint64_t>(last) - static_cast<std::uint64_t>(first);
    if (step < 1 || last < first) lines_.fail(fmt::format("the numbers {} to {} in steps of {}", first, last, step));
    spend(range / static_cast<std::uint64_t>(step));
    const std::string instance = upper(parameter("INSTANCE"));
    for (std::uint64_t i = 0; i <= range; i += static_cast<std::uint64_t>(step))
      set.members.push_back({instance, first + static_cast<std::int64_t>(i)});
  }

  void read_side(const std::vector<std::string_view>& fields) {
    if (fields.empty()) return;
    DeckSurface& surface = block().surfaces.back();
    const std::string side = fields.size() > 1 ? upper(fields[1]) : std::string();
    const bool is_number = side.size() == 2 && side[0] == 'S' && side[1] >= '1' && side[1] <= '6';
    const int number = is_number ? side[1] - '1' : side.empty() ? DeckSide::kFree : DeckSide::kShell;
    surface.sides.push_back({member(fields[0]), number});
  }

  /// A shift, then two points of a line and an angle.
  void read_place(const std::vector<std::string_view>& fields) {
    std::array<double, 7> v{};
    for (std::size_t i = 0; i < std::min(v.size(), fields.size()); ++i)
      if (!fields[i].empty()) v[i] = lines_.real(fields[i]);
    DeckPlace& place = model_.instances.back().place;
    if (data_lines_ == 1) {
      place.shift = {v[0], v[1], v[2]};
    } else if (data_lines_ == 2) {
      const Vec3 from{v[0], v[1], v[2]}, to{v[3], v[4], v[5]};
      if (from == to) lines_.fail("the two points of the axis of an instance are one");
      place.origin = from;
      place.rotation = rotation_about(to - from, v[6]);
    }
  }

  /// Points: the origin and one on the X axis, then one near the Y axis.
  void read_system(const std::vector<std::string_view>& fields) {
    std::array<double, 6> v{};
    for (std::size_t i = 0; i < std::min(v.size(), fields.size()); ++i)
      if (!fields[i].empty()) v[i] = lines_.real(fields[i]);
    if (data_lines_ == 1) {
      system_.origin = {v[0], v[1], v[2]};
      if (fields.size() > 3) turn_about_z(Vec3{v[3], v[4], v[5]} - system_.origin);
    } else if (data_lines_ == 2) {
      require(set_axes_by_xy(system_, system_.axes[0], Vec3{v[0], v[1], v[2]} - system_.origin));
    }
  }
  /// Without a third point Z stays, if X is across it.
  void turn_about_z(Vec3 x) {
    const Vec3 y = cross({0, 0, 1}, x);
    require(set_axes_by_xy(system_, x, squared_length(y) > 0 ? y : Vec3{0, 1, 0}));
  }
  void require(bool has_axes) const {
    if (!has_axes) lines_.fail("the points of *SYSTEM lie on one line");
  }

  void finish_keyword() {
    if (section_ == Section::kElements && !pending_.empty())
      lines_.fail("an element has too few nodes; the file is truncated: copy or export it again");
    section_ = Section::kNone;
  }

  void note_generated() {
    std::string names;
    for (const std::string& keyword : generated_) names += (names.empty() ? "" : ", ") + keyword;
    model_.notes.push_back(names + ": nodes and elements that are made from others are not read: they are missing");
  }

  DeckLines lines_;
  DeckModel model_;
  Section section_ = Section::kNone;
  std::map<std::string, std::string> parameters_;  ///< of the keyword
  std::string set_name_;
  DeckKind kind_;  ///< of the elements that are read
  NodeSystem system_;
  bool is_in_part_ = false, is_in_instance_ = false, generate_ = false;
  std::uint64_t data_lines_ = 0, spent_ = 0;
  std::vector<std::int64_t> pending_;  ///< numbers of the element so far
  std::set<std::string> generated_;    ///< keywords that make nodes and elements
};

}  // namespace

std::string upper(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return out;
}

DeckLines::DeckLines(const Input& input) : bytes_(input.bytes.size()) {
  sources_.push_back(std::make_unique<Source>(Source{{}, &input, Scanner(input)}));
}

bool DeckLines::next_of_any() {
  while (true) {
    Scanner& scan = sources_.back()->scan;
    if (!scan.at_end()) {
      at_ = scan.position();
      at_input_ = sources_.back()->input;
      line_ = scan.rest_of_line();
      return true;
    }
    if (sources_.size() == 1) return false;
    read_.push_back(std::move(sources_.back()));
    sources_.pop_back();
  }
}

/// Whether the next line is more parameters of a keyword whose line ends with a comma, and no data.
bool DeckLines::goes_on() {
  Scanner& scan = sources_.back()->scan;
  if (scan.at_end()) return false;
  const char* const begin = scan.position();
  const std::string_view next = scan.rest_of_line();
  scan.set_position(begin);
  const std::string first = upper(trimmed(next.substr(0, next.find(','))));
  constexpr std::array<std::string_view, 3> kFlags{"GENERATE", "INTERNAL", "UNSORTED"};
  return !next.starts_with('*') &&
         (next.find('=') != std::string_view::npos || std::find(kFlags.begin(), kFlags.end(), first) != kFlags.end());
}

void DeckLines::join_keyword_lines() {
  if (!line_.ends_with(',')) return;
  joined_ = line_;
  const char* const begin = at_;
  while (joined_.ends_with(',') && goes_on() && next_of_any()) joined_ += line_;
  at_ = begin;
  line_ = joined_;
}

bool DeckLines::include(const std::string& name) {
  constexpr std::size_t kMostNested = 8, kMostFiles = 1000;
  const Input& deck = *sources_.front()->input;
  std::optional<LoadedFile> file = included_file(deck, name);
  if (!file) return false;
  if (sources_.size() > kMostNested || ++files_ > kMostFiles) fail("includes too many files, or itself");
  auto source = std::make_unique<Source>(Source{std::move(file), nullptr, Scanner(deck)});
  source->input = &source->file->input();
  source->scan = Scanner(*source->input);
  bytes_ += source->input->bytes.size();
  sources_.push_back(std::move(source));
  return true;
}

const std::vector<std::string_view>& DeckLines::fields() {
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

std::optional<std::int64_t> DeckLines::whole(std::string_view field) const {
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || stop != field.data() + field.size() || field.empty()) return std::nullopt;
  return value;
}

std::int64_t DeckLines::integer(std::string_view field, std::string_view what) const {
  const auto value = whole(field);
  if (!value) fail(fmt::format("expected {}, found {}", what, in_quotes(field)));
  return *value;
}

double DeckLines::real(std::string_view field) const {
  double value = 0;
  if (!parse_number(field, value) || !std::isfinite(value))
    fail(fmt::format("expected a coordinate, found {}", in_quotes(field)));
  return value;
}

DeckSet& DeckSets::at(std::string_view name) {
  const auto [entry, is_new] = place_.try_emplace(upper(name), sets_.size());
  if (is_new) sets_.push_back({std::string(name)});
  return sets_[entry->second];
}

const DeckSet* DeckSets::find(std::string_view name) const {
  const auto found = place_.find(upper(name));
  return found == place_.end() ? nullptr : &sets_[found->second];
}

DeckKind deck_kind_of(std::string_view type) {
  if (const std::uint8_t solid = nodes_of_solid(type); solid > 0) return {solid, true};
  return {nodes_of_shell(type), false};
}

Vec3 DeckPlace::of(Vec3 p) const {
  const Vec3 q = p + shift - origin;
  return origin + Vec3{dot(rotation[0], q), dot(rotation[1], q), dot(rotation[2], q)};
}

DeckModel read_deck(const Input& input) {
  return DeckReader(input).read();
}

}  // namespace octafront::io
