#pragma once

#include "formats/containers/text_writer.h"
#include "formats/parts/legal_names.h"
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
#include <utility>
#include <vector>

namespace octafront::io {

// OpenFOAM's files: their heads, zones, patches, and the faces between cells.

inline constexpr NameRules kFoamNames{.also = "_-."};
inline constexpr const char* kFoamLocation = "constant/polyMesh";

/// The files of a polyMesh folder.
struct FoamFiles {
  std::filesystem::path folder;
  std::string location;
  RunContext context;
  bool is_case = false;  ///< patches get types by their names
  double metres = 1;     ///< what a coordinate counts

  void file(const std::string& name, std::string_view type, const std::function<void(TextWriter&)>& write) const;
  /// A list of so many values in lines of their own.
  void list(const std::string& name, std::string_view type, std::size_t count,
            const std::function<void(TextWriter&)>& write) const;
  void points(std::size_t count, const std::function<Vec3(std::size_t)>& place_of) const;
  /// The files of faces. for_each_face(visit) calls visit(points, owner, neighbour) in order, those of the boundary
  /// with kNone behind the `inner` other ones.
  template <class ForEachFace>
  void faces(std::size_t count, std::size_t inner, const ForEachFace& for_each_face) const;
};

template <class ForEachFace>
void FoamFiles::faces(std::size_t count, std::size_t inner, const ForEachFace& for_each_face) const {
  list("faces", "faceList", count, [&](TextWriter& out) {
    for_each_face([&](const auto& points, std::uint32_t, std::uint32_t) {
      out << std::uint64_t{points.size()};
      char before = '(';
      for (const VertexIndex p : points) out << std::exchange(before, ' ') << p;
      out << ")\n";
    });
  });
  list("owner", "labelList", count, [&](TextWriter& out) {
    for_each_face([&](const auto&, std::uint32_t owner, std::uint32_t) { out << owner << '\n'; });
  });
  list("neighbour", "labelList", inner, [&](TextWriter& out) {
    for_each_face([&](const auto&, std::uint32_t, std::uint32_t neighbour) {
      if (neighbour != kNone) out << neighbour << '\n';
    });
  });
}

struct FoamZoneFace {
  std::size_t label;
  bool is_flipped;
  std::uint64_t label_in_whole;
};
void put_cell_zone(TextWriter& out, const std::string& name, std::span<const std::uint32_t> cells);
/// Zones of all regions, by their legal names.
void put_cell_zones(const FoamFiles& files, const MeshParts& mesh, std::span<const std::string> names,
                    std::map<std::uint32_t, std::vector<std::uint32_t>>& cells_of_region);
void put_face_zone(TextWriter& out, const std::string& name, std::span<const FoamZoneFace> faces);
/// Zones of the patches that have faces inside, each in the order of the whole.
void put_face_zones(const FoamFiles& files, const MeshParts& mesh, std::span<const std::string> names,
                    std::map<std::uint32_t, std::vector<FoamZoneFace>>& faces_of_patch);

/// An entry of `boundary`; `name` is the legal one.
void put_patch(TextWriter& out, const std::string& name, const MeshParts& mesh, const Part& patch, std::size_t faces,
               std::size_t first, bool is_case);

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

// What a polyMesh becomes a case by: WriteOptions::deck.

/// The type of a patch in a case, by its name.
std::string_view foam_type_of(std::string_view name);

/// Throws OptionError if no case can be written around this polyMesh, OutputError where files of another one are.
void check_foam_case(const std::filesystem::path& target, const WriteOptions& options);

/// What coordinates count where a case is written: 1 without.
double metres_of_case(const WriteOptions& options);

/// Writes the rest of a case for simpleFoam. `names`: legal ones of MeshParts::parts().
void write_foam_case(MeshOutput& out, const MeshParts& mesh, std::span<const std::string> names);

}  // namespace octafront::io
