#pragma once

// What an Abaqus deck says, before elements are put together: lines of the file and of those that it includes
// (DeckLines), and nodes, elements, sets and surfaces by the part, instance or assembly that they stand in (DeckModel).

#include <octafront/vec.h>

#include "formats/containers/input.h"
#include "formats/containers/scanner.h"

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace octafront::io {

/// In upper case.
std::string upper(std::string_view text);

/// Lines of a deck and of the files that it includes, split at commas. Views point into the files.
class DeckLines {
 public:
  explicit DeckLines(const Input& input);

  /// The next line that is no comment; false at the end. A line of keywords that ends with a comma goes on in the next
  /// one, and is given as one. Comments are told to `comment`.
  template <class Comment>
  bool next(const Comment& comment) {
    while (next_of_any()) {
      if (line_.starts_with("**")) {
        comment(line_);
        continue;
      }
      if (is_keyword()) join_keyword_lines();
      return true;
    }
    return false;
  }
  /// Goes on with the lines of a file beside the deck, then with those behind this one. False if there is no such file,
  /// or it is of another folder.
  bool include(const std::string& name);
  bool is_keyword() const { return line_.starts_with('*'); }
  std::string_view line() const { return line_; }
  /// The fields of this line.
  const std::vector<std::string_view>& fields();

  [[noreturn]] void fail(std::string_view message) const { at_input_->fail_at_line(at_, message); }
  std::optional<std::int64_t> whole(std::string_view field) const;
  std::int64_t integer(std::string_view field, std::string_view what) const;
  double real(std::string_view field) const;
  /// Of all files.
  std::uint64_t bytes() const { return bytes_; }

 private:
  struct Source {
    std::optional<LoadedFile> file;
    const Input* input;
    Scanner scan;
  };

  bool next_of_any();
  bool goes_on();
  void join_keyword_lines();

  std::vector<std::unique_ptr<Source>> sources_;
  std::vector<std::unique_ptr<Source>> read_;  ///< whose lines may still be referred to
  std::uint64_t bytes_, files_ = 0;
  const char* at_ = nullptr;
  const Input* at_input_ = nullptr;
  std::string_view line_;
  std::string joined_;
  std::vector<std::string_view> fields_;
};

/// A member of a set: a number, or the name of another set; of the instance named, else of where the set stands.
struct DeckMember {
  std::string instance;  ///< in upper case
  std::int64_t id = 0;
  std::string name = {};
};

/// A set; told apart by its name in upper case.
struct DeckSet {
  std::string name;
  bool is_internal = false;
  std::vector<DeckMember> members = {};
};

class DeckSets {
 public:
  DeckSet& at(std::string_view name);
  const DeckSet* find(std::string_view name) const;
  const std::vector<DeckSet>& all() const { return sets_; }

 private:
  std::map<std::string, std::size_t> place_;
  std::vector<DeckSet> sets_;
};

/// Elements, or a set of them, and which side of them: "S1" is 0; kFree: those that are no other element's; kShell: the
/// shells themselves.
struct DeckSide {
  static constexpr int kFree = -1, kShell = -2;
  DeckMember elements;
  int side;
};
struct DeckSurface {
  std::string name;
  bool of_nodes = false;
  std::vector<DeckSide> sides = {};
};

/// Nodes of an element of a type that is kept, and whether it is a solid. 0: not kept.
struct DeckKind {
  std::uint8_t nodes = 0;
  bool is_solid = false;
};
DeckKind deck_kind_of(std::string_view type);

/// What one part, instance or the assembly has of its own.
struct DeckBlock {
  struct Element {
    std::int64_t id;
    std::size_t first;  ///< of its nodes, in `nodes_of`
    DeckKind kind;
  };
  std::string name;
  std::vector<std::int64_t> node_ids;
  std::vector<Vec3> points;
  std::vector<Element> elements;
  std::vector<std::int64_t> nodes_of;
  DeckSets node_sets, element_sets;
  std::vector<DeckSurface> surfaces;
};

/// Where an instance is: turned about a line through `origin`, behind a shift.
struct DeckPlace {
  Vec3 shift{}, origin{};
  std::array<Vec3, 3> rotation{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

  Vec3 of(Vec3 p) const;
};

struct DeckInstance {
  std::string name, part;
  DeckPlace place;
  DeckBlock own;
};

struct DeckModel {
  DeckBlock assembly;  ///< also of a deck without parts
  std::vector<DeckBlock> parts;
  std::vector<DeckInstance> instances;
  std::map<std::string, std::string> originals;  ///< of names that had to be made legal, in upper case
  std::vector<std::string> notes;
  std::uint64_t other_elements = 0, bytes = 0;
};

/// Throws InputError.
DeckModel read_deck(const Input& input);

}  // namespace octafront::io
