#include "fill/front/front_state.h"

#include "fill/front/open_edge.h"

#include <algorithm>

namespace octafront {

std::optional<std::string> FrontState::first_inconsistency() const {
  if (sizes.size() != points.size()) return "the front has not one size for each point";
  std::size_t made = 0;
  bool is_whole = true;
  for (const FilledPiece& piece : filled) {
    made += piece.tets.size();
    is_whole = is_whole && piece.rank == FilledPiece::kEveryRank;
  }
  if (is_whole ? made != work.tets : made > work.tets) return "the front has not as many tetrahedra as it says";
  std::vector<Triangle> all;
  all.reserve(faces());
  for (std::size_t i = 0; i < faces(); ++i) {
    const auto& [a, b, c] = all.emplace_back(face(i).corners);
    if (std::max({a, b, c}) >= points.size()) return "a face of the front has a corner that is no vertex";
    if (a == b || b == c || c == a) return "a face of the front has a corner twice";
  }
  return why_not_closed(all, "the faces of the front");
}

}  // namespace octafront
