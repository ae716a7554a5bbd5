#include "base/core/disjoint_sets.h"
#include "base/core/elementary.h"
#include "images/labels/label_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace octafront::image {
namespace {

constexpr std::uint16_t kBeyond = 0xfffe;  ///< what lies around the image: it neither gives nor takes voxels
constexpr std::uint32_t kNone = 0xffffffff;

/// The voxels of an image with one layer around them, the faces between different ones, and the lines where these meet.
class Faces {
 public:
  using Index = std::uint64_t;
  struct Face {
    Index voxel;
    int axis;
    friend bool operator==(const Face&, const Face&) = default;
  };

  explicit Faces(const LabelImage& image) : image_(image) {
    for (std::size_t a = 0; a < 3; ++a) n_[a] = image.grid.size[a] + 2;
    step_ = {1, n_[0], n_[0] * n_[1]};
    label_.assign(n_[0] * n_[1] * n_[2], kBeyond);
    for_each_row([&](Index here, std::size_t there) {
      std::copy_n(image.regions.begin() + static_cast<std::ptrdiff_t>(there), image.grid.size[0],
                  label_.begin() + static_cast<std::ptrdiff_t>(here));
    });
  }

  std::uint16_t label(Index v) const { return label_[v]; }
  void set(Index v, std::uint16_t to) { label_[v] = to; }
  Index step(int axis) const { return step_[static_cast<std::size_t>(axis)]; }
  Index size() const { return label_.size(); }

  void write_to(std::vector<std::uint16_t>& regions) const {
    for_each_row([&](Index here, std::size_t there) {
      std::copy_n(label_.begin() + static_cast<std::ptrdiff_t>(here), image_.grid.size[0],
                  regions.begin() + static_cast<std::ptrdiff_t>(there));
    });
  }

  /// The four voxels around the edge along `axis` at the lower corner of v, in a ring.
  std::array<Index, 4> around(Index v, int axis) const {
    const Index b = step((axis + 1) % 3), c = step((axis + 2) % 3);
    return {v, v - b, v - b - c, v - c};
  }
  /// How many different labels lie around an edge.
  int labels_around(Index v, int axis) const {
    const auto [a, b, c, d] = around(v, axis);
    const std::uint16_t p = label_[a], q = label_[b], r = label_[c], s = label_[d];
    return 1 + (q != p) + (r != p && r != q) + (s != p && s != q && s != r);
  }
  /// Two labels that lie across from each other around an edge.
  bool is_diagonal(Index v, int axis) const {
    const auto [a, b, c, d] = around(v, axis);
    return label_[a] == label_[c] && label_[b] == label_[d] && label_[a] != label_[b];
  }

  /// The edges of the face between v and the voxel before it along its axis.
  std::array<std::pair<Index, int>, 4> edges_of(const Face& f) const {
    const int b = (f.axis + 1) % 3, c = (f.axis + 2) % 3;
    return {{{f.voxel, b}, {f.voxel + step(c), b}, {f.voxel, c}, {f.voxel + step(b), c}}};
  }
  /// The other face of the same two labels at an edge with no others.
  std::optional<Face> beyond(const Face& f, std::pair<Index, int> edge) const {
    if (labels_around(edge.first, edge.second) != 2 || is_diagonal(edge.first, edge.second)) return {};
    const int b = (edge.second + 1) % 3, c = (edge.second + 2) % 3;
    const Index v = edge.first;
    for (const Face g : {Face{v, b}, Face{v - step(c), b}, Face{v, c}, Face{v - step(b), c}})
      if (!(g == f) && label_[g.voxel] != label_[g.voxel - step(g.axis)]) return g;
    return {};
  }

 private:
  template <class Visit>
  void for_each_row(const Visit& visit) const {
    std::size_t there = 0;
    for (Index k = 1; k + 1 < n_[2]; ++k)
      for (Index j = 1; j + 1 < n_[1]; ++j, there += n_[0] - 2) visit(1 + n_[0] * j + n_[0] * n_[1] * k, there);
  }

  const LabelImage& image_;
  std::array<Index, 3> n_{}, step_{};
  std::vector<std::uint16_t> label_;
};

using Face = Faces::Face;
using Index = Faces::Index;

/// Faces of two labels that hang together.
struct Spot {
  std::vector<Face> faces;
  bool is_strip = true;  ///< all of its faces lie beside a line
};

/// The parts of the surfaces between labels that lines come nearer to each other at than so many faces.
class NarrowParts {
 public:
  NarrowParts(const Faces& faces, std::uint32_t reach) : faces_(faces), reach_(reach) {
    find_faces();
    if (face_.empty()) return;
    from_lines();
    from_wide();
  }

  std::vector<Spot> spots() {
    DisjointSets sets(face_.size());
    for (std::uint32_t f = 0; f < face_.size(); ++f) {
      if (!is_narrow(f)) continue;
      for (const std::uint32_t g : neighbours(f))
        if (g != kNone && is_narrow(g)) sets.join(f, g);
    }
    std::vector<std::uint32_t> number(face_.size(), kNone);
    std::vector<Spot> all;
    for (std::uint32_t f = 0; f < face_.size(); ++f) {
      if (!is_narrow(f)) continue;
      std::uint32_t& n = number[sets.find(f)];
      if (n == kNone) {
        n = static_cast<std::uint32_t>(all.size());
        all.emplace_back();
      }
      all[n].faces.push_back(face_[f]);
      all[n].is_strip = all[n].is_strip && from_line_[f] == 1;
    }
    return all;
  }

 private:
  void find_faces() {
    for (Index v = 0; v < faces_.size(); ++v)
      for (int a = 0; a < 3; ++a)
        if (v >= faces_.step(a) && faces_.label(v) != faces_.label(v - faces_.step(a))) {
          first_.resize(v / kRow + 1, static_cast<std::uint32_t>(face_.size()));
          face_.push_back({v, a});
        }
  }
  std::uint32_t number(const Face& f) const {
    const std::size_t row = f.voxel / kRow;
    const auto begin = face_.begin() + first_[row];
    const auto end = row + 1 < first_.size() ? face_.begin() + first_[row + 1] : face_.end();
    return static_cast<std::uint32_t>(std::lower_bound(begin, end, f,
                                                       [](const Face& x, const Face& y) {
                                                         return std::pair(x.voxel, x.axis) < std::pair(y.voxel, y.axis);
                                                       }) -
                                      face_.begin());
  }
  std::array<std::uint32_t, 4> neighbours(std::uint32_t f) const {
    std::array<std::uint32_t, 4> all{kNone, kNone, kNone, kNone};
    const auto edges = faces_.edges_of(face_[f]);
    for (std::size_t e = 0; e < 4; ++e)
      if (const auto g = faces_.beyond(face_[f], edges[e])) all[e] = number(*g);
    return all;
  }
  bool is_narrow(std::uint32_t f) const { return from_line_[f] != 0 && from_wide_[f] == 0; }

  /// from[f]: how many faces f is from the first ones, itself counted, up to `most`; 0: more.
  void spread(std::vector<std::uint32_t> ring, std::uint32_t most, std::vector<std::uint8_t>& from) const {
    for (std::uint32_t n = 2; n <= most && !ring.empty(); ++n) {
      std::vector<std::uint32_t> next;
      for (const std::uint32_t f : ring)
        for (const std::uint32_t g : neighbours(f))
          if (g != kNone && from[g] == 0) {
            from[g] = static_cast<std::uint8_t>(n);
            next.push_back(g);
          }
      ring = std::move(next);
    }
  }
  void from_lines() {
    from_line_.assign(face_.size(), 0);
    std::vector<std::uint32_t> ring;
    for (std::uint32_t f = 0; f < face_.size(); ++f)
      for (const auto& [v, axis] : faces_.edges_of(face_[f]))
        if (from_line_[f] == 0 && faces_.labels_around(v, axis) > 2) {
          from_line_[f] = 1;
          ring.push_back(f);
        }
    spread(std::move(ring), reach_, from_line_);
  }
  void from_wide() {
    from_wide_.assign(face_.size(), 0);
    std::vector<std::uint32_t> ring;
    for (std::uint32_t f = 0; f < face_.size(); ++f)
      if (from_line_[f] == 0) {
        from_wide_[f] = 1;
        ring.push_back(f);
      }
    spread(std::move(ring), 1 + 2 * reach_, from_wide_);
  }

  static constexpr Index kRow = 64;
  const Faces& faces_;
  std::uint32_t reach_;
  std::vector<Face> face_;            ///< ascending
  std::vector<std::uint32_t> first_;  ///< the first face of every kRow voxels
  std::vector<std::uint8_t> from_line_, from_wide_;
};

/// One way to clear a spot.
struct Move {
  std::vector<Index> voxels;
  std::uint16_t from = 0, to = 0;
};

class Clearing {
 public:
  Clearing(Faces& faces, const LabelImage& image)
      : faces_(faces), changed_(faces.size(), false), size_of_(image.labels.size()) {
    for (const std::uint16_t r : image.regions)
      if (r != LabelImage::kNoRegion) ++size_of_[r].first;
    for (Size& size : size_of_) size.now = size.first;
  }

  /// Clears the spot by the move that shortens lines most; how many voxels it took, 0 if none does.
  std::size_t clear(const Spot& spot) {
    std::optional<Move> best;
    int gain = 0;
    for (Move& move : moves_of(spot)) {
      const int shorter = shortens(move);
      if (shorter <= gain || !is_allowed(move)) continue;
      gain = shorter;
      best = std::move(move);
    }
    if (!best) return 0;
    for (const Index v : best->voxels) {
      faces_.set(v, best->to);
      changed_[v] = true;
    }
    count(*best);
    return best->voxels.size();
  }

 private:
  std::vector<Move> moves_of(const Spot& spot) const {
    const Face& f = spot.faces.front();
    const std::uint16_t p = faces_.label(f.voxel), q = faces_.label(f.voxel - faces_.step(f.axis));
    if (p == q) return {};
    std::vector<std::uint16_t> beside;
    std::vector<Index> of_p, of_q;
    for (const Face& g : spot.faces) {
      const Index v = g.voxel, w = g.voxel - faces_.step(g.axis);
      const std::uint16_t l = faces_.label(v), m = faces_.label(w);
      if ((l != p || m != q) && (l != q || m != p)) return {};  // another spot changed it
      of_p.push_back(l == p ? v : w);
      of_q.push_back(l == p ? w : v);
      for (const auto& [at, axis] : faces_.edges_of(g))
        for (const Index u : faces_.around(at, axis)) {
          const std::uint16_t c = faces_.label(u);
          if (c != p && c != q && c != kBeyond) beside.push_back(c);
        }
    }
    std::sort(beside.begin(), beside.end());
    beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
    std::vector<Move> all;
    for (auto [voxels, from] : {std::pair{&of_p, p}, std::pair{&of_q, q}}) {
      if (from == kBeyond) continue;
      std::sort(voxels->begin(), voxels->end());
      voxels->erase(std::unique(voxels->begin(), voxels->end()), voxels->end());
      if (std::any_of(voxels->begin(), voxels->end(), [&](Index v) { return changed_[v]; })) continue;
      for (const std::uint16_t c : beside) all.push_back({*voxels, from, c});
    }
    return all;
  }

  /// By how many edges of voxels the lines get shorter.
  int shortens(const Move& move) {
    std::vector<std::pair<Index, int>> edges;
    for (const Index v : move.voxels)
      for (int a = 0; a < 3; ++a) {
        const Index b = faces_.step((a + 1) % 3), c = faces_.step((a + 2) % 3);
        for (const Index at : {v, v + b, v + c, v + b + c}) edges.emplace_back(at, a);
      }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    const auto length = [&] {
      int n = 0;
      for (const auto& [v, a] : edges) n += (faces_.labels_around(v, a) > 2) + (faces_.is_diagonal(v, a));
      return n;
    };
    const int before = length();
    put(move, move.to);
    const int after = length();
    put(move, move.from);
    return before - after;
  }
  void put(const Move& move, std::uint16_t label) {
    for (const Index v : move.voxels) faces_.set(v, label);
  }

  /// Whether what gives voxels stays, and stays in one piece in the box around them where it was.
  bool is_allowed(const Move& move) {
    const auto voxels = static_cast<double>(move.voxels.size());
    if (changes_much(move.from, -voxels) || changes_much(move.to, voxels) || !joins(move)) return false;
    if (move.from == LabelImage::kNoRegion) return true;
    return !cuts(move);
  }
  /// Whether a region has so many voxels more that its volume is another one.
  bool changes_much(std::uint16_t region, double more) const {
    if (region == LabelImage::kNoRegion) return false;
    const Size& size = size_of_[region];
    return std::abs(size.now + more - size.first) > std::max(1.0, kMostChanged * size.first);
  }
  /// Whether all that is given hangs together with what gets it.
  bool joins(const Move& move) const;
  bool cuts(const Move& move) const;
  void count(const Move& move) {
    const auto voxels = static_cast<double>(move.voxels.size());
    if (move.from != LabelImage::kNoRegion) size_of_[move.from].now -= voxels;
    if (move.to != LabelImage::kNoRegion) size_of_[move.to].now += voxels;
  }

  /// All spots together change no region by more than this part, or a voxel.
  static constexpr double kMostChanged = 0.01;
  struct Size {
    double first = 0, now = 0;  ///< voxels
  };
  Faces& faces_;
  std::vector<bool> changed_;
  std::vector<Size> size_of_;
};

bool Clearing::joins(const Move& move) const {
  std::vector<std::uint8_t> joined(move.voxels.size(), 0);
  const auto is_joined = [&](Index v) {
    if (faces_.label(v) == move.to) return true;
    const auto it = std::lower_bound(move.voxels.begin(), move.voxels.end(), v);
    return it != move.voxels.end() && *it == v && joined[static_cast<std::size_t>(it - move.voxels.begin())] != 0;
  };
  for (bool grew = true; grew;) {
    grew = false;
    for (std::size_t n = 0; n < joined.size(); ++n)
      for (int a = 0; a < 3 && joined[n] == 0; ++a)
        if (is_joined(move.voxels[n] - faces_.step(a)) || is_joined(move.voxels[n] + faces_.step(a)))
          joined[n] = 1, grew = true;
  }
  return std::ranges::all_of(joined, [](std::uint8_t j) { return j != 0; });
}

bool Clearing::cuts(const Move& move) const {
  // The voxels of the label beside those that go, and whether these hang together without them: within one layer more.
  std::vector<Index> near;
  for (const Index v : move.voxels)
    for (std::int64_t k = -2; k <= 2; ++k)
      for (std::int64_t j = -2; j <= 2; ++j)
        for (std::int64_t i = -2; i <= 2; ++i) {
          const std::int64_t at = static_cast<std::int64_t>(v) + i + j * static_cast<std::int64_t>(faces_.step(1)) +
                                  k * static_cast<std::int64_t>(faces_.step(2));
          if (at < 0 || at >= static_cast<std::int64_t>(faces_.size())) continue;
          if (faces_.label(static_cast<Index>(at)) == move.from) near.push_back(static_cast<Index>(at));
        }
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  const auto number = [&](Index v) {
    const auto it = std::lower_bound(near.begin(), near.end(), v);
    return it != near.end() && *it == v ? static_cast<std::uint32_t>(it - near.begin()) : kNone;
  };
  const auto goes = [&](Index v) { return std::binary_search(move.voxels.begin(), move.voxels.end(), v); };
  DisjointSets before(near.size()), after(near.size());
  for (std::uint32_t n = 0; n < near.size(); ++n)
    for (int a = 0; a < 3; ++a) {
      const std::uint32_t m = number(near[n] + faces_.step(a));
      if (m == kNone) continue;
      before.join(n, m);
      if (!goes(near[n]) && !goes(near[m])) after.join(n, m);
    }
  // What hung together stays in one piece, and some of it stays.
  std::vector<std::uint32_t> piece(near.size(), kNone);
  std::vector<std::uint8_t> stays(near.size(), 0);
  for (std::uint32_t n = 0; n < near.size(); ++n) {
    if (goes(near[n])) continue;
    const std::uint32_t was = before.find(n), is = after.find(n);
    stays[was] = 1;
    if (piece[was] == kNone) piece[was] = is;
    if (piece[was] != is) return true;
  }
  for (std::uint32_t n = 0; n < near.size(); ++n)
    if (stays[before.find(n)] == 0) return true;
  return false;
}

}  // namespace

ClearedContacts clear_small_contacts(LabelImage& image, double width, const RunContext& context) {
  ClearedContacts done;
  const ImageGrid& grid = image.grid;
  const double spacing = elementary::cbrt(std::abs(dot(cross(grid.axes[0], grid.axes[1]), grid.axes[2])));
  const auto reach = static_cast<std::uint32_t>(std::clamp(width / (2 * spacing), 0.0, 100.0));
  if (reach == 0) return done;
  const double most = (width / spacing) * (width / spacing);
  Faces faces(image);
  Clearing clearing(faces, image);
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    context.check();
    std::uint64_t cleared = 0;
    for (const Spot& spot : NarrowParts(faces, reach).spots()) {
      if (!spot.is_strip && static_cast<double>(spot.faces.size()) > most) continue;
      const Face& f = spot.faces.front();
      const std::uint16_t p = faces.label(f.voxel), q = faces.label(f.voxel - faces.step(f.axis));
      const std::size_t voxels = clearing.clear(spot);
      if (voxels == 0) continue;
      ++cleared;
      ++done.spots[std::minmax(p, q)];
      done.voxels += voxels;
    }
    if (cleared == 0) break;
  }
  faces.write_to(image.regions);
  return done;
}

}  // namespace octafront::image
