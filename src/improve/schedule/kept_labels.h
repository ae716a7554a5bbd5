#pragma once

#include <octafront/tet_mesh.h>

#include "base/mesh/labels.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace octafront::improve {

/// Elements that MEDIT's files require.
std::size_t count_required(const TetMesh& mesh);
/// Whether there are some, or wedges or pyramids: with them the boundary stays.
bool has_staying_elements(const TetMesh& mesh);

/// What hangs on a mesh while it is edited. Edits know of regions, of faces that stay, boundary and interfaces, and of
/// vertices; so what elements are called become their regions, an edge of a curve inside and a node that is to keep its
/// place are held by a face at them, and what must not change at all (wedges, pyramids, required elements) is put
/// aside.
class KeptLabels {
 public:
  /// Leaves of the mesh what edits may change. Where elements are put aside its boundary stays, with the faces between
  /// them and it, whose vertices come first.
  explicit KeptLabels(TetMesh& mesh);

  /// Whether put_back() must be told the numbers of vertices.
  bool needs_numbers() const { return aside_.has_value(); }
  /// The mesh again. `number`: where the vertices of the one that was left went; kNone: they are gone.
  void put_back(TetMesh& mesh, const std::vector<VertexIndex>& number) const;

 private:
  /// Elements that stay, in the whole mesh.
  struct Aside {
    TetMesh whole;
    std::vector<std::uint8_t> stays;     ///< per tet
    std::vector<VertexIndex> fixed;      ///< vertices of the walls of what is edited, ascending
    std::vector<VertexIndex> in_edited;  ///< per vertex; kNone: not there
  };

  void put_aside(TetMesh& mesh, std::vector<std::uint8_t> stays);
  void label_elements(TetMesh& mesh);
  void put_back_aside(TetMesh& mesh, const std::vector<VertexIndex>& number) const;

  std::size_t interfaces_ = 0;  ///< of the mesh itself
  std::optional<Labels> elements_;
  TetMesh before_;  ///< what its elements have, where nothing is put aside
  std::optional<Aside> aside_;
};

}  // namespace octafront::improve
