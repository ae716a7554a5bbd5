#pragma once

// The same mesh, kept otherwise: what improvement makes of it must not hang on where it keeps its elements.

#include "base/core/random.h"
#include "improve/shape/edit_mesh.h"

namespace octafront::improve {

/// Changes what an EditMesh may choose freely: in which slots the tets lie, in which order free slots and numbers of
/// new vertices are taken, which tet is named at a vertex.
class EditMeshShuffle {
 public:
  explicit EditMeshShuffle(std::uint64_t seed) : random_(seed) {}
  void operator()(EditMesh& mesh);

 private:
  template <class Item>
  void shuffle(std::vector<Item>& items);

  Random random_;
};

}  // namespace octafront::improve
