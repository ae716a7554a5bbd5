#pragma once

// OpenFOAM's files: their heads, zones, patches, and the faces between cells.

#include "formats/containers/text_writer.h"
#include "formats/parts/mesh_output.h"
#include "formats/parts/mesh_parts.h"
#include "formats/parts/mixed_cells.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace octafront::io {

/// The files of a polyMesh folder.
struct FoamFiles {
  std::filesystem::path folder;
  std::string location;
  RunContext context;

  void file(const std::string& name, std::string_view type, const std::function<void(TextWriter&)>& write) const;
  /// A list of so many values in lines of their own.
  void list(const std::string& name, std::string_view type, std::size_t count,
            const std::function<void(TextWriter&)>& write) const;
};

struct FoamZoneFace {
  std::size_t label;
  bool is_flipped;
  std::uint64_t label_in_whole;
};
void put_cell_zone(TextWriter& out, const std::string& name, std::span<const std::uint32_t> cells);
void put_face_zone(TextWriter& out, const std::string& name, std::span<const FoamZoneFace> faces);

/// An entry of `boundary`; `name` is the legal one.
void put_patch(TextWriter& out, const std::string& name, const MeshParts& mesh, const Part& patch, std::size_t faces,
               std::size_t first);

/// A face between two cells.
struct FoamFace {
  std::array<VertexIndex, 4> nodes;  ///< outward of the owner; of a triangle the last one is repeated
  std::uint32_t owner, neighbour;    ///< the cell of the lower number, and the other one

  bool is_triangle() const { return nodes[2] == nodes[3]; }
  std::span<const VertexIndex> corners() const { return std::span(nodes).first(is_triangle() ? 3 : 4); }
};

/// Those of a mesh with wedges and pyramids, ascending by the numbers of owner and neighbour. Cells are numbered by
/// `number`, per cell; empty: as they are.
std::vector<FoamFace> faces_between(const MixedCells& cells, std::span<const std::uint64_t> number = {});

/// The patches of interfaces, by corners of faces.
class InterfacePatches {
 public:
  explicit InterfacePatches(const MeshParts& mesh);

  bool empty() const { return patch_at_.empty(); }
  /// Of a triangle or quadrilateral, half of which may be asked for; kNone if it is in none.
  std::uint32_t of(std::span<const VertexIndex> corners) const;

 private:
  std::map<Triangle, std::uint32_t> patch_at_;  ///< by sorted corners
  std::vector<bool> is_listed_;                 ///< per point: most faces are of none
};

}  // namespace octafront::io
