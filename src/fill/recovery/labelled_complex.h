#pragma once

#include "base/mesh/tet_complex.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace octafront::recovery {

/// A complex whose faces may lie on facets of a surface.
class LabelledComplex : public TetComplex {
 public:
  /// No face has a label yet.
  explicit LabelledComplex(TetComplex&& complex);

  /// The facet that lies on a face, or kNone; the same from both sides.
  std::uint32_t label(HalfFace h) const { return label_[h]; }
  void set_label(HalfFace h, std::uint32_t facet);
  /// As without labels; the faces on the rim keep theirs.
  void replace(std::span<const TetIndex> old, std::span<const Tet> fresh);

  /// As of the complex, and labels that differ from side to side.
  std::optional<std::string> first_inconsistency() const;

 private:
  std::vector<std::uint32_t> label_;  ///< per half-face
};

}  // namespace octafront::recovery
