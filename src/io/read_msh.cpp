// Gmsh MSH 4.1 and 2.2, text and binary. Linear tetrahedra and triangles are kept; their references are the first
// physical group of their entity, or the entity's own tag where it has none.

#include "io/msh_stream.h"
#include "io/raw_mesh.h"
#include "io/readers.h"

#include <algorithm>
#include <array>
#include <map>
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

constexpr std::int64_t kTriangleType = 2, kTetType = 4;

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

 private:
  std::vector<std::uint64_t> tags_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted_;
  bool consecutive_ = true;
};

class Msh {
 public:
  explicit Msh(const Input& input) : input_(input), in_(input) {}

  TetMesh read() {
    for (std::string_view name = in_.next_section(); !name.empty(); name = in_.next_section()) {
      if (name == "MeshFormat") {
        read_format();
      } else if (name == "PhysicalNames") {
        read_names();
      } else if (name == "Entities" && version_ == 4) {
        read_entities();
      } else if (name == "Nodes") {
        require_format();
        version_ == 4 ? read_nodes_4() : read_nodes_2();
        if (const auto [twice, tag] = tags_.finish(); twice)
          in_.fail(fmt::format("two nodes have the tag {}; the file is damaged: export it again", tag));
      } else if (name == "Elements") {
        require_format();
        has_elements_ = true;
        version_ == 4 ? read_elements_4() : read_elements_2();
      } else {
        in_.skip_section(name);
        continue;
      }
      in_.end_section(name);
    }
    if (!has_elements_)
      input_.fail("has no section $Elements; it is truncated or holds no mesh: copy or export it again");
    return ordered_mesh(std::move(raw_), input_);
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
    in_.text().skip_line();
    in_.text().set_position(in_.position() + std::min<std::size_t>(1, in_.text().bytes_left()));
    in_.set_binary();
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
      if (name.size() < 2 || name.front() != '"' || name.back() != '"') text.fail_expected("a name in quotes");
      name = name.substr(1, name.size() - 2);
      if (dimension == 2) raw_.surface_names[tag] = name;
    }
  }

  void read_entities() {
    std::array<std::uint64_t, 4> counts;
    for (std::uint64_t& n : counts) n = in_.size("a number of entities");
    for (int dimension = 0; dimension < 4; ++dimension) {
      const std::uint64_t reals = dimension == 0 ? 3 : 6;
      in_.check_count(counts[static_cast<std::size_t>(dimension)], reals, dimension == 0 ? 1 : 2, 1, "entities");
      for (std::uint64_t i = 0; i < counts[static_cast<std::size_t>(dimension)]; ++i) {
        const std::int64_t tag = in_.int32("the tag of an entity");
        in_.skip_real(reals);
        const std::uint64_t groups = in_.size("the number of physical groups");
        if (groups > 0) {
          // The sign tells the orientation of the entity in its group.
          physical_[{dimension, tag}] = std::abs(in_.int32("a physical group"));
          in_.skip_int32(groups - 1);
        }
        if (dimension > 0) in_.skip_int32(in_.size("the number of bounding entities"));
      }
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
    skip_line_end();
    in_.check_count(count, 3, 0, 1, "nodes");
    for (std::uint64_t i = 0; i < count; ++i) {
      add_node(static_cast<std::uint64_t>(in_.int32("the tag of a node")));
      raw_.points.push_back(point());
    }
  }

  /// Counts stand in a line of text also in binary files of version 2.
  void skip_line_end() {
    if (!in_.is_binary()) return;
    in_.text().skip_line();
    in_.text().set_position(in_.position() + std::min<std::size_t>(1, in_.text().bytes_left()));
  }

  template <std::size_t N, class Tag>
  std::array<VertexIndex, N> corners(const Tag& next_tag) {
    std::array<VertexIndex, N> all;
    for (VertexIndex& v : all) {
      const std::uint64_t tag = next_tag();
      v = tags_.index_of(tag);
      if (v == kNone)
        in_.fail(tags_.empty() ? "the elements come before the nodes, which is not read here; export it again"
                               : fmt::format("an element has the node {}, which the file lacks; the file is damaged: "
                                             "export it again",
                                             tag));
    }
    return all;
  }

  template <class Tag>
  void add_element(std::int64_t type, std::int64_t ref, const Tag& next_tag) {
    if (type == kTetType) {
      raw_.tets.push_back(corners<4>(next_tag));
      raw_.tet_ref.push_back(ref);
    } else {
      raw_.triangles.push_back(corners<3>(next_tag));
      raw_.triangle_ref.push_back(ref);
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
      const auto physical = physical_.find({static_cast<int>(dimension), entity});
      const std::int64_t ref = physical == physical_.end() ? entity : physical->second;
      if (type != kTetType && type != kTriangleType) {
        raw_.other_elements += count;
        in_.skip_size(count * (nodes + 1));
        continue;
      }
      for (std::uint64_t i = 0; i < count; ++i) {
        in_.skip_size(1);
        add_element(type, ref, [this] { return in_.size("a node of an element"); });
      }
    }
  }

  /// One element of version 2 behind its type: tags, the first two of which are the physical group and the entity.
  void read_element_2(std::int64_t type, std::int64_t tag_count) {
    std::array<std::int64_t, 2> tags{};
    for (std::int64_t k = 0; k < tag_count; ++k) {
      const std::int64_t tag = in_.int32("a tag of an element");
      if (k < 2) tags[static_cast<std::size_t>(k)] = tag;
    }
    if (type != kTetType && type != kTriangleType) {
      ++raw_.other_elements;
      in_.skip_int32(known_nodes_of_type(type));
      return;
    }
    add_element(type, tags[0] != 0 ? tags[0] : tags[1],
                [this] { return static_cast<std::uint64_t>(in_.int32("a node of an element")); });
  }

  void read_elements_2() {
    const std::int64_t count = in_.text().integer("the number of elements");
    skip_line_end();
    in_.check_count(static_cast<std::uint64_t>(count), 0, 0, 2, "elements");
    for (std::int64_t i = 0; i < count;) {
      if (!in_.is_binary()) in_.skip_int32(1);
      const std::int64_t type = in_.int32("the type of an element");
      const std::int64_t together = in_.is_binary() ? in_.int32("the number of elements") : 1;
      const std::int64_t tag_count = in_.int32("the number of tags of an element");
      if (together < 1 || together > count - i || tag_count < 0 || tag_count > 1000)
        in_.fail(
            fmt::format("{} elements with {} tags each; the file is damaged: export it again", together, tag_count));
      for (std::int64_t k = 0; k < together; ++k) {
        if (in_.is_binary()) in_.skip_int32(1);
        read_element_2(type, tag_count);
      }
      i += together;
    }
  }

  const Input& input_;
  MshStream in_;
  int version_ = 0;
  bool has_elements_ = false;
  NodeTags tags_;
  std::map<std::pair<int, std::int64_t>, std::int64_t> physical_;
  RawMesh raw_;
};

}  // namespace

TetMesh read_msh(const Input& input) {
  return Msh(input).read();
}

}  // namespace octafront::io
