// Exodus II in netCDF classic: a block of elements per region and kind of element, side sets for patches, node sets for
// sets of nodes and for the nodes of curves, element sets. Elements stand block by block; the map tells their numbers
// in the mesh. Fields are variables of nodes and elements, each number by itself, in one time step. Blocks of pyramids
// and wedges behind others of their region have names of their own, "layers_wedges", and numbers behind all.

#include "formats/containers/netcdf_writer.h"
#include "formats/parts/field_columns.h"
#include "formats/parts/mixed_cells.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <string>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;
using Value = NetcdfWriter::Value;

/// Sides 1 = 124, 2 = 234, 3 = 134, 4 = 123, by the corner that they lack.
constexpr std::array<std::int32_t, 4> kSide{2, 3, 1, 4};
/// The same of the sides of kWedgeFaces, 1 = 1254, 2 = 2365, 3 = 1463, 4 = 132, 5 = 456; and of kPyramidFaces, 1 = 125,
/// 2 = 235, 3 = 345, 4 = 154, 5 = 1432.
constexpr std::array<std::int32_t, 5> kSideOfWedge{4, 5, 1, 2, 3}, kSideOfPyramid{5, 1, 2, 3, 4};

class ExodusWriter {
 public:
  ExodusWriter(MeshOutput& out, const MeshParts& mesh) : file_(out.file()), mesh_(mesh), cells_(mesh) {
    constexpr NameRules kRules{.longest = 255, .also = " _-.:#+*/()[]{}%$&!?=<>~^@|;'\"", .letter_first = false};
    constexpr std::size_t kUsual = 32;
    std::size_t longest = kUsual;
    LegalNames unique(kRules);
    for (const Part& part : mesh.parts()) {
      names_.push_back(unique.legal(part.name));
      longest = std::max(longest, names_.back().size());
    }
    out.note(unique.note());
    of_nodes_ = field_columns(out, false, kRules, ComponentNames::kUnderscored);
    of_elements_ = field_columns(out, true, kRules, ComponentNames::kUnderscored);
    for (const auto* columns : {&of_nodes_, &of_elements_})
      for (const FieldColumn& column : *columns) longest = std::max(longest, column.name.size());
    length_of_name_ = longest + 1;
  }

  void write() {
    file_.attribute({"api_version", 8.03F});
    file_.attribute({"version", 8.03F});
    file_.attribute({"floating_point_word_size", std::int32_t{8}});
    file_.attribute({"file_size", std::int32_t{1}});
    file_.attribute({"maximum_name_length", static_cast<std::int32_t>(length_of_name_ - 1)});
    file_.attribute({"title", std::string("mesh by octafront")});
    file_.dimension("len_string", 33);
    file_.dimension("len_line", 81);
    name_ = file_.dimension("len_name", length_of_name_);
    file_.dimension("four", 4);
    time_ = file_.dimension("time_step", 0);
    declare_nodes();
    const std::vector<Block> blocks = make_blocks();
    declare_blocks(blocks);
    const auto parts_of = [this](auto wanted) {
      std::vector<std::size_t> all;
      for (std::size_t p = 0; p < names_.size(); ++p)
        if (mesh_.parts()[p].origin != Part::Origin::kRegion && !mesh_.parts()[p].members.empty() &&
            wanted(mesh_.parts()[p].kind))
          all.push_back(p);
      return all;
    };
    declare_node_sets(parts_of([](Kind k) { return k == Kind::kNodes || k == Kind::kEdges; }));
    declare_side_sets(parts_of([](Kind k) { return k == Kind::kFaces; }));
    declare_element_sets(parts_of([](Kind k) { return k == Kind::kElements; }));
    declare_names_of_fields(blocks.size());
    file_.variable("time_whole", NetcdfWriter::kDouble, {time_}, [](std::uint64_t) { return Value(0.0); });
    declare_fields(blocks);
    file_.write(!of_nodes_.empty() || !of_elements_.empty());
  }

 private:
  using Type = NetcdfWriter::Type;

  void declare_nodes() {
    const std::uint32_t axes = file_.dimension("num_dim", 3);
    nodes_ = file_.dimension("num_nodes", mesh_.points());
    for (int axis = 0; axis < 3; ++axis)
      file_.variable(
          std::string("coord") + "xyz" [axis], Type::kDouble, { nodes_ },
          [this, axis](std::uint64_t v) { return Value(mesh_.mesh().points[v][axis]); });
    declare_texts("coor_names", axes, {"x", "y", "z"});
  }

  void declare_texts(const std::string& name, std::uint32_t dimension, std::vector<std::string> texts) {
    file_.variable(name, Type::kChar, {dimension, name_}, [this, texts = std::move(texts)](std::uint64_t i) {
      const std::string& text = texts[i / length_of_name_];
      const std::size_t at = i % length_of_name_;
      return Value(std::int32_t{at < text.size() ? text[at] : '\0'});
    });
  }

  /// Status, numbers and names of blocks or sets.
  void declare_list(const std::string& prefix, std::uint32_t dimension, std::vector<std::string> names,
                    std::vector<std::int32_t> numbers) {
    file_.variable(prefix + "_status", Type::kInt, {dimension}, [](std::uint64_t) { return Value(1); });
    file_.variable(prefix + "_prop1", Type::kInt, {dimension},
                   [numbers = std::move(numbers)](std::uint64_t i) { return Value(numbers[i]); },
                   {{"name", std::string("ID")}});
    declare_texts(prefix + "_names", dimension, std::move(names));
  }
  /// Of sets, numbered from 1; then declare(number, part) of each.
  template <class Declare>
  void declare_sets(const std::string& prefix, const char* dimension, const std::vector<std::size_t>& parts,
                    const Declare& declare) {
    if (parts.empty()) return;
    std::vector<std::string> names;
    for (const std::size_t p : parts) names.push_back(names_[p]);
    std::vector<std::int32_t> numbers(parts.size());
    std::iota(numbers.begin(), numbers.end(), 1);
    declare_list(prefix, file_.dimension(dimension, parts.size()), std::move(names), std::move(numbers));
    for (std::size_t s = 0; s < parts.size(); ++s) declare(std::to_string(s + 1), mesh_.parts()[parts[s]]);
  }

  /// Elements of one region and kind: a run of order_.
  struct Block {
    std::string name;
    std::int32_t number;
    MixedCells::Kind kind;
    std::size_t begin, end;
  };

  std::vector<Block> make_blocks() {
    constexpr std::array<const char*, MixedCells::kKinds> kSuffixes{"", "_pyramids", "_wedges"};
    std::vector<Block> blocks;
    const auto regions = mesh_.parts(Part::Origin::kRegion);
    auto next = static_cast<std::int32_t>(regions.empty() ? 1 : regions.back().tag + 1);
    for (const Part& region : regions) next = std::max(next, static_cast<std::int32_t>(region.tag + 1));
    for (std::size_t r = 0; r < regions.size(); ++r) {
      const std::size_t first = order_.size();
      for (const std::uint32_t cell : cells_.members(regions[r])) {
        const MixedCells::Kind kind = cells_.kind(cell);
        if (order_.size() == first)
          blocks.push_back({names_[r], static_cast<std::int32_t>(regions[r].tag), kind, first, first});
        else if (blocks.back().kind != kind)
          blocks.push_back({names_[r] + kSuffixes[kind], next++, kind, order_.size(), order_.size()});
        order_.push_back(cell);
        blocks.back().end = order_.size();
      }
    }
    return blocks;
  }

  void declare_blocks(const std::vector<Block>& blocks) {
    const std::uint32_t elements = file_.dimension("num_elem", cells_.cells());
    block_count_ = file_.dimension("num_el_blk", blocks.size());
    place_.resize(order_.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) place_[order_[i]] = i;
    std::vector<std::string> names;
    std::vector<std::int32_t> numbers;
    for (const Block& block : blocks) names.push_back(block.name), numbers.push_back(block.number);
    declare_list("eb", block_count_, std::move(names), std::move(numbers));
    for (std::size_t b = 0; b < blocks.size(); ++b) declare_block(std::to_string(b + 1), blocks[b]);
    file_.variable("elem_num_map", Type::kInt, {elements},
                   [this](std::uint64_t i) { return Value(static_cast<std::int32_t>(order_[i] + 1)); });
  }

  void declare_block(const std::string& n, const Block& block) {
    constexpr std::array<std::array<const char*, 2>, MixedCells::kKinds> kTypes{
        {{"TETRA", "TETRA10"}, {"PYRAMID", "PYRAMID13"}, {"WEDGE", "WEDGE15"}}};
    const std::uint64_t each = cells_.nodes_per(block.kind);
    const std::uint32_t count = file_.dimension("num_el_in_blk" + n, block.end - block.begin),
                        nodes = file_.dimension("num_nod_per_el" + n, each);
    sizes_.push_back(count);
    file_.variable(
        "connect" + n, Type::kInt, {count, nodes},
        [this, first = block.begin, each](std::uint64_t i) {
          return Value(static_cast<std::int32_t>(cells_.node(order_[first + i / each], i % each, kCgnsWide) + 1));
        },
        {{"elem_type", std::string(kTypes[block.kind][mesh_.second_order()])}});
  }

  void declare_node_sets(const std::vector<std::size_t>& parts) {
    declare_sets("ns", "num_node_sets", parts, [this](const std::string& n, const Part& part) {
      auto nodes = mesh_.nodes_of(part);
      const std::uint32_t count = file_.dimension("num_nod_ns" + n, nodes.size());
      file_.variable("node_ns" + n, Type::kInt, {count}, [nodes = std::move(nodes)](std::uint64_t i) {
        return Value(static_cast<std::int32_t>(nodes[i]) + 1);
      });
    });
  }

  std::size_t cell_at(std::uint32_t face) const { return cells_.cell_of(mesh_.sides()[cells_.first_face(face)].tet); }
  std::int32_t side_at(std::uint32_t face) const {
    const std::size_t cell = cell_at(face);
    const MixedCells::Kind kind = cells_.kind(cell);
    if (kind == MixedCells::kTet) return kSide[static_cast<std::size_t>(mesh_.sides()[cells_.first_face(face)].face)];
    return (kind == MixedCells::kWedge ? kSideOfWedge : kSideOfPyramid)[cells_.side_of(cell, face)];
  }

  void declare_side_sets(const std::vector<std::size_t>& parts) {
    declare_sets("ss", "num_side_sets", parts, [this](const std::string& n, const Part& part) {
      const std::vector<std::uint32_t> members = cells_.members(part);
      const std::uint32_t count = file_.dimension("num_side_ss" + n, members.size());
      file_.variable("elem_ss" + n, Type::kInt, {count}, [this, members](std::uint64_t i) {
        return Value(static_cast<std::int32_t>(place_[cell_at(members[i])]) + 1);
      });
      file_.variable("side_ss" + n, Type::kInt, {count},
                     [this, members](std::uint64_t i) { return Value(side_at(members[i])); });
    });
  }

  void declare_element_sets(const std::vector<std::size_t>& parts) {
    declare_sets("els", "num_elem_sets", parts, [this](const std::string& n, const Part& part) {
      const std::vector<std::uint32_t> members = cells_.members(part);
      const std::uint32_t count = file_.dimension("num_ele_els" + n, members.size());
      file_.variable("elem_els" + n, Type::kInt, {count}, [this, members](std::uint64_t i) {
        return Value(static_cast<std::int32_t>(place_[members[i]]) + 1);
      });
    });
  }

  std::uint32_t declare_names(const std::string& prefix, const std::vector<FieldColumn>& columns) {
    const std::uint32_t count = file_.dimension("num_" + prefix + "_var", columns.size());
    std::vector<std::string> names;
    for (const FieldColumn& column : columns) names.push_back(column.name);
    declare_texts("name_" + prefix + "_var", count, std::move(names));
    return count;
  }
  void declare_names_of_fields(std::size_t blocks) {
    if (!of_nodes_.empty()) declare_names("nod", of_nodes_);
    if (of_elements_.empty() || blocks == 0) return;
    const std::uint32_t count = declare_names("elem", of_elements_);
    // Every block has every variable.
    file_.variable("elem_var_tab", Type::kInt, {block_count_, count}, [](std::uint64_t) { return Value(1); });
  }

  void declare_fields(const std::vector<Block>& blocks) {
    for (std::size_t f = 0; f < of_nodes_.size(); ++f)
      file_.variable("vals_nod_var" + std::to_string(f + 1), Type::kDouble, {time_, nodes_},
                     [this, f](std::uint64_t v) { return value_of(of_nodes_[f], v); });
    for (std::size_t f = 0; f < of_elements_.size(); ++f)
      for (std::size_t b = 0; b < blocks.size(); ++b)
        file_.variable("vals_elem_var" + std::to_string(f + 1) + "eb" + std::to_string(b + 1), Type::kDouble,
                       {time_, sizes_[b]}, [this, f, first = blocks[b].begin](std::uint64_t i) {
                         return value_of(of_elements_[f], order_[first + i]);
                       });
  }
  Value value_of(const FieldColumn& column, std::uint64_t item) const {
    return cells_.value_of(*column.field, item, column.component);
  }

  NetcdfWriter file_;
  const MeshParts& mesh_;
  MixedCells cells_;
  std::vector<std::string> names_;  ///< of the parts
  std::vector<FieldColumn> of_nodes_, of_elements_;
  std::size_t length_of_name_;
  std::uint32_t name_ = 0, time_ = 0, nodes_ = 0, block_count_ = 0;  ///< dimensions
  std::vector<std::uint32_t> sizes_;                                 ///< and those of the blocks
  std::vector<std::uint32_t> order_, place_;  ///< elements block by block, and where each one is there
};

}  // namespace

void write_exodus(MeshOutput& out, const MeshParts& mesh) {
  out.require_32_bits(std::max(mesh.points(), mesh.tets()),
                      "Exodus counts with 32 bits, too few for this mesh; write .vtu");
  ExodusWriter(out, mesh).write();
}

}  // namespace octafront::io
