#include "fill/recovery/labelled_complex.h"

#include <utility>

namespace octafront::recovery {

LabelledComplex::LabelledComplex(TetComplex&& complex) : TetComplex(std::move(complex)), label_(across.size(), kNone) {}

void LabelledComplex::set_label(HalfFace h, std::uint32_t facet) {
  label_[h] = facet;
  if (!is_outside(across[h])) label_[across[h]] = facet;
}

void LabelledComplex::replace(std::span<const TetIndex> old, std::span<const Tet> fresh) {
  TetComplex::replace(old, fresh);
  label_.resize(across.size());
  for (const TetIndex t : created())
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) label_[h] = kNone;
  // What lies on the rim is known from the other side.
  for (const TetIndex t : created())
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h)
      if (!is_outside(across[h])) label_[h] = label_[across[h]];
}

std::optional<std::string> LabelledComplex::first_inconsistency() const {
  if (auto wrong = TetComplex::first_inconsistency()) return wrong;
  for (HalfFace h = 0; h < across.size(); ++h) {
    if (alive(h / 4) && !is_outside(across[h]) && label_[across[h]] != label_[h])
      return "face " + std::to_string(h % 4) + " of tetrahedron " + std::to_string(h / 4) +
             " has another label on its other side";
  }
  return std::nullopt;
}

}  // namespace octafront::recovery
