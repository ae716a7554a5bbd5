#include "base/mesh/tet_complex.h"

#include "base/core/buckets.h"
#include "base/core/validate.h"
#include "base/core/vector_units.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace octafront {
namespace {

/// Faces by their least corner, which is one of a range: whoever comes second to a pair of other corners finds the
/// first. Half the time of a FaceTable, which would sort them.
class FaceMatcher {
 public:
  /// Room for as many faces of vertex first + k as faces_of_least_corner[k] says.
  FaceMatcher(VertexIndex first, std::vector<std::uint32_t>&& faces_of_least_corner)
      : first_(first), next_(std::move(faces_of_least_corner)) {
    std::uint32_t at = 0;
    for (std::uint32_t& n : next_) at += std::exchange(n, at);
    begin_ = next_;
    entries_.resize(at);
  }

  /// The waiting partner of the face, by its corners in ascending order, taken out; or kNone after putting this one in.
  std::uint32_t match(const Triangle& key, std::uint32_t id) {
    const VertexIndex v = key[0] - first_;
    Entry* first = entries_.data() + begin_[v];
    Entry* last = entries_.data() + next_[v];
    const std::uint64_t others = std::uint64_t{key[1]} << 32 | key[2];
    for (Entry* e = first; e != last; ++e)
      if (e->others == others) {
        const std::uint32_t found = e->id;
        *e = *(last - 1);
        --next_[v];
        return found;
      }
    *last = {others, id};
    ++next_[v];
    return kNone;
  }

 private:
  struct Entry {
    std::uint64_t others;
    std::uint32_t id;
  };
  VertexIndex first_;
  std::vector<std::uint32_t> begin_, next_;
  std::vector<Entry> entries_;
};

/// The corners of a tet in ascending order, and which of its corners each is.
struct SortedTet {
  std::array<VertexIndex, 4> vertex;
  std::array<HalfFace, 4> corner;

  explicit SortedTet(const Tet& t) {
    std::array<std::uint64_t, 4> key;
    for (std::uint32_t i = 0; i < 4; ++i) key[i] = std::uint64_t{t[i]} << 2 | i;
    const auto order = [&](int i, int j) {
      const std::uint64_t low = std::min(key[i], key[j]), high = std::max(key[i], key[j]);
      key[i] = low, key[j] = high;
    };
    order(0, 1), order(2, 3), order(0, 2), order(1, 3), order(1, 2);
    for (int i = 0; i < 4; ++i) {
      vertex[i] = static_cast<VertexIndex>(key[i] >> 2);
      corner[i] = static_cast<HalfFace>(key[i] & 3);
    }
  }
  /// The key of the face without the i-th least corner.
  Triangle face_opposite(int i) const { return {vertex[i == 0], vertex[1 + (i <= 1)], vertex[2 + (i <= 2)]}; }
};

std::array<VertexIndex, 2> least_two(const Tet& t) {
  const VertexIndex low = std::min(t[0], t[1]), high = std::max(t[0], t[1]);
  const VertexIndex other_low = std::min(t[2], t[3]), other_high = std::max(t[2], t[3]);
  return {std::min(low, other_low), std::min(std::max(low, other_low), std::min(high, other_high))};
}

std::string name_of_half_face(HalfFace h) {
  return "face " + std::to_string(h % 4) + " of tetrahedron " + std::to_string(h / 4);
}

std::optional<std::string> wrong_at_face(const TetComplex& c, HalfFace h) {
  const HalfFace o = c.across[h];
  if (is_outside(o)) return std::nullopt;
  if (o / 4 >= c.slots() || !c.alive(o / 4))
    return "across " + name_of_half_face(h) + " lies a tetrahedron that is gone";
  if (c.across[o] != h) return name_of_half_face(o) + " does not know its neighbour across, " + name_of_half_face(h);
  if (face_key(c.face(o)) != face_key(c.face(h)) || is_even(c.face(o)) == is_even(c.face(h)))
    return name_of_half_face(h) + " and " + name_of_half_face(o) +
           " are neighbours, but not one face seen from both sides";
  return std::nullopt;
}

std::optional<std::string> wrong_at_vertex(const TetComplex& c, VertexIndex v) {
  const TetIndex t = c.tet_at[v];
  if (t < c.slots() && c.alive(t) && c.has(t, v)) return std::nullopt;
  return "vertex " + std::to_string(v) + " is not in the tetrahedron that is given as one of its own";
}

std::optional<std::string> wrong_at_tet(const TetComplex& c, TetIndex t) {
  if (!c.alive(t)) return std::nullopt;
  for (HalfFace h = 4 * t; h < 4 * t + 4; ++h)
    if (auto wrong = wrong_at_face(c, h)) return wrong;
  for (const VertexIndex v : c.tets[t])
    if (auto wrong = wrong_at_vertex(c, v)) return wrong;
  return std::nullopt;
}

}  // namespace

void TetComplex::connect(std::size_t vertices, std::span<const Triangle> boundary) {
  across.assign(4 * tets.size(), kNone);
  const RangeBuckets ranges(vertices);
  // Tets by the ranges of the least corners of their faces, one or two: most lie in one.
  const Buckets<> tets_at(tets.size(), ranges.count(), [&](std::size_t t, const auto& add) {
    const auto [least, second] = least_two(tets[t]);
    add(ranges.of(least), static_cast<TetIndex>(t));
    if (ranges.of(second) != ranges.of(least)) add(ranges.of(second), static_cast<TetIndex>(t));
  });
  const Buckets<> outside(boundary.size(), ranges.count(), [&](std::size_t b, const auto& add) {
    add(ranges.of(face_key(boundary[b])[0]), static_cast<std::uint32_t>(b));
  });
  // Both sides of a face are in one range: what a thread writes is its own.
  parallel_for(ranges.count(), [&](std::size_t r) {
    const auto first = static_cast<VertexIndex>(ranges.begin(r));
    std::vector<std::uint32_t> count(ranges.end(r) - first, 0);
    for (const TetIndex t : tets_at[r]) {
      const auto [least, second] = least_two(tets[t]);
      if (ranges.of(least) == r) count[least - first] += 3;
      if (ranges.of(second) == r) ++count[second - first];
    }
    for (const std::uint32_t b : outside[r]) ++count[face_key(boundary[b])[0] - first];
    FaceMatcher matcher(first, std::move(count));
    for (const std::uint32_t b : outside[r]) matcher.match(face_key(boundary[b]), kFirstOutside + b);
    for (const TetIndex t : tets_at[r]) {
      const SortedTet sorted(tets[t]);
      for (int i = 0; i < 4; ++i) {
        const Triangle key = sorted.face_opposite(i);
        if (ranges.of(key[0]) != r) continue;
        const HalfFace h = 4 * t + sorted.corner[i];
        if (const HalfFace other = matcher.match(key, h); other != kNone) join(h, other);
      }
    }
  });
  tet_at.assign(vertices, kNone);
  for (TetIndex t = 0; t < slots(); ++t)
    for (const VertexIndex v : tets[t]) tet_at[v] = t;
  marks.assign(tets.size(), 0);
  last_mark = 0;
}

void TetComplex::part(std::size_t vertices, std::span<const Triangle> triangles, HalfFace outside) {
  if (triangles.empty()) return;
  const FaceTable table = face_table(vertices, triangles);
  for (HalfFace h = 0; h < across.size(); ++h)
    if (!is_outside(across[h]) && !table.group_of(face(h)).empty()) across[h] = outside;
}

void TetRim::keep_sides(const Triangle& face, HalfFace across) {
  const Triangle key = face_key(face);
  const auto other =
      std::find_if(outer_.rbegin(), outer_.rend(), [&](const OuterFace& f) { return face_key(f.corners) == key; });
  if (other != outer_.rend()) parted_.insert(parted_.end(), {*other, {face, across}});
}

HalfFace TetRim::take_side(const Triangle& face) {
  const auto is_same = [&](const OuterFace& f) {
    Triangle turned = f.corners;
    for (int i = 0; i < 3; ++i) {
      if (turned == face) return true;
      std::rotate(turned.begin(), turned.begin() + 1, turned.end());
    }
    return false;
  };
  const auto found = std::find_if(parted_.begin(), parted_.end(), is_same);
  if (found == parted_.end()) return kNone;
  const HalfFace across = found->across;
  parted_.erase(found);
  return across;
}

TetIndex TetComplex::create(const Tet& corners) {
  TetIndex t = slots();
  if (free.empty()) {
    tets.push_back(corners);
    across.resize(4 * tets.size());
    marks.push_back(0);
  } else {
    t = free.back();
    free.pop_back();
    tets[t] = corners;
  }
  std::fill_n(across.begin() + 4 * static_cast<std::ptrdiff_t>(t), 4, kNone);
  for (const VertexIndex v : corners) tet_at[v] = t;
  return t;
}

void TetComplex::replace(std::span<const TetIndex> old, std::span<const Tet> fresh, VertexIndex gone,
                         std::span<const BoundaryFace> boundary) {
  rim_.reset(4 * (old.size() + fresh.size()) + boundary.size());
  for (const TetIndex t : old)
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
      const Triangle f = face(h);
      const bool goes = is_outside(across[h]) && (f[0] == gone || f[1] == gone || f[2] == gone);
      if (!goes) rim_.toggle(f, across[h]);
    }
  for (const BoundaryFace& f : boundary) rim_.toggle(f.corners, f.across);
  for (const TetIndex t : old) destroy(t);
  created_.clear();
  for (const Tet& c : fresh) {
    created_.push_back(create(c));
    rim_.tie(*this, created_.back());
  }
  if (!rim_.closed()) throw std::logic_error("tetrahedra that replace others do not fill the same space");
  validate(*this, created_);
}

const std::vector<TetIndex>& TetComplex::star_from(VertexIndex v, TetIndex start) {
  const std::uint32_t seen = new_mark();
  star_.assign(1, start);
  marks[start] = seen;
  for (std::size_t k = 0; k < star_.size(); ++k) {
    const Tet& corners = tets[star_[k]];
    const HalfFace* beside = across.data() + 4 * std::size_t{star_[k]};
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFace o = beside[i];
      if (corners[i] == v || is_outside(o) || marks[o / 4] == seen) continue;
      marks[o / 4] = seen;
      fetch_soon(&tets[o / 4]), fetch_soon(&across[4 * (o / 4)]);
      star_.push_back(o / 4);
    }
  }
  return star_;
}

std::uint32_t TetComplex::new_mark() {
  if (++last_mark == 0) {
    std::ranges::fill(marks, 0);
    last_mark = 1;
  }
  return last_mark;
}

std::optional<std::string> TetComplex::first_inconsistency() const {
  for (TetIndex t = 0; t < slots(); ++t)
    if (auto wrong = wrong_at_tet(*this, t)) return wrong;
  for (const TetIndex t : free)
    if (alive(t)) return "tetrahedron " + std::to_string(t) + " is alive, and its slot free";
  return std::nullopt;
}

std::optional<std::string> TetComplex::first_inconsistency(std::span<const TetIndex> touched) const {
  for (const TetIndex t : touched)
    if (auto wrong = wrong_at_tet(*this, t)) return wrong;
  return std::nullopt;
}

}  // namespace octafront
