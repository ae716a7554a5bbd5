#include "adapt/schedule/section.h"

#include "base/core/flat_map.h"
#include "base/core/parallel.h"
#include "base/core/renumber.h"
#include "base/mesh/adjacency.h"

#include <algorithm>
#include <numeric>
#include <type_traits>

namespace octafront::adapt {
namespace {

/// Layers of elements around those that may change whose walls are needed: fits of the smooth surface go by three rings
/// of vertices around each, and what bends beside them by one more.
constexpr int kLayersOfGround = 4;

/// The numbers of the faces or edges of a list that lie between vertices which have numbers, counted from `first` on;
/// of faces those that are some of `faces`.
template <class Item>
void take_items(const std::vector<Item>& all, std::uint32_t first, const std::vector<VertexIndex>& number,
                const FlatSet<Triangle>* faces, std::vector<std::uint32_t>& ids) {
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    const Item& item = all[i];
    if (std::any_of(item.begin(), item.end(), [&](VertexIndex v) { return number[v] == kNone; })) continue;
    if constexpr (std::is_same_v<Item, Triangle>)
      if (!faces->contains(face_key(item))) continue;
    ids.push_back(first + i);
  }
}

/// Numbers for items of which some stay, some were taken out, and some come back.
class Slots {
 public:
  /// `out`: the numbers of those taken out, ascending. `back`: of each that comes back the number that it had, or
  /// kNone.
  Slots(std::size_t count, std::span<const std::uint32_t> out, std::span<const std::uint32_t> back)
      : old_count_(static_cast<std::uint32_t>(count)),
        count_(static_cast<std::uint32_t>(count - out.size() + back.size())),
        had_(back.begin(), back.end()),
        id_(had_) {
    std::vector<std::uint32_t> kept(back.begin(), back.end()), holes;
    std::sort(kept.begin(), kept.end());
    std::set_difference(out.begin(), out.end(), kept.begin(), kept.end(), std::back_inserter(holes));
    auto hole = holes.begin();
    std::uint32_t behind = old_count_;
    for (std::uint32_t& id : id_)
      if (id == kNone) id = hole != holes.end() && *hole < count_ ? *hole++ : behind++;
    // What is left of holes is for the last of those that stay.
    moved_.assign(old_count_ > count_ ? old_count_ - count_ : 0, kNone);
    const std::vector<std::uint32_t> gone(std::lower_bound(holes.begin(), holes.end(), count_), holes.end());
    for (std::uint32_t k = 0; k < moved_.size(); ++k)
      if (!std::binary_search(gone.begin(), gone.end(), count_ + k)) moved_[k] = *hole++;
    for (std::uint32_t& id : id_) id = now(id);
  }

  std::uint32_t old_count() const { return old_count_; }
  /// Of the i-th one that comes back.
  std::uint32_t of(std::size_t i) const { return id_[i]; }
  /// The number that it had; kNone: it is new.
  std::uint32_t had(std::size_t i) const { return had_[i]; }
  /// Of one that stays, by the number that it had.
  std::uint32_t now(std::uint32_t old) const { return old < count_ || old >= old_count_ ? old : moved_[old - count_]; }
  bool any_moved() const {
    return std::any_of(moved_.begin(), moved_.end(), [](std::uint32_t to) { return to != kNone; });
  }
  std::uint64_t moved() const {
    return static_cast<std::uint64_t>(
        std::count_if(moved_.begin(), moved_.end(), [](std::uint32_t to) { return to != kNone; }));
  }

  /// The items in their new places; `made` are those that come back.
  template <class Item, class Made>
  void place(std::vector<Item>& items, const Made& made) const {
    if (count_ > old_count_) items.resize(count_);
    for (std::uint32_t k = 0; k < moved_.size(); ++k)
      if (moved_[k] != kNone) items[moved_[k]] = items[count_ + k];
    for (std::size_t i = 0; i < id_.size(); ++i) made(i, items[id_[i]]);
    items.resize(count_);
  }

 private:
  std::uint32_t old_count_, count_;
  std::vector<std::uint32_t> had_;
  std::vector<std::uint32_t> id_;     ///< of those that come back
  std::vector<std::uint32_t> moved_;  ///< of those from count_ on; kNone: gone
};

class Splicer {
 public:
  Splicer(TetMesh& whole, const Section& section, const TetMesh& made, const Origins& from)
      : whole_(whole), section_(section), made_(made), from_(from), stays_(made.points.size(), 0) {
    for (VertexIndex v = 0; v < stays_.size(); ++v)
      stays_[v] = from.nodes[v] != kNone && made_.points[v] == section_.mesh.points[from.nodes[v]];
    out_vertex_.assign(section_.of.nodes.size(), 0);
    for (TetIndex t = 0; t < section_.of.tets.size(); ++t) {
      if (!section_.loose[t]) continue;
      const Tet& c = section_.mesh.tets[t];
      for (const VertexIndex v : c) out_vertex_[v] = 1;
      for (int i = 0; i < 4; ++i) out_face_.insert(face_key(face_of(c, i)));
    }
  }

  SplicedIds run() {
    const TetMesh before = whole_;
    const auto outer = static_cast<std::uint32_t>(before.boundary.size());
    const std::span<const std::uint32_t> faces(section_.of.faces);
    const std::size_t split = section_.mesh.boundary.size(), made_split = made_.boundary.size();
    const Slots vertices = slots_of_vertices();
    const Slots tets = slots_of_tets();
    const Slots out = slots_of_items(whole_.boundary, section_.mesh.boundary, faces.first(split), 0, made_.boundary);
    const Slots in =
        slots_of_items(whole_.interfaces, section_.mesh.interfaces, faces.subspan(split), outer, made_.interfaces);
    const Slots lines =
        slots_of_items(whole_.curve_edges, section_.mesh.curve_edges, section_.of.edges, 0, made_.curve_edges);
    vertices.place(whole_.points, [&](std::size_t i, Vec3& p) { p = made_.points[i]; });
    place_items(whole_.tets, made_.tets, tets, vertices);
    place_items(whole_.boundary, made_.boundary, out, vertices);
    place_items(whole_.interfaces, made_.interfaces, in, vertices);
    place_items(whole_.curve_edges, made_.curve_edges, lines, vertices);
    Origins from{origins(vertices, 0, from_.nodes, section_.of.nodes),
                 origins(lines, 0, from_.edges, section_.of.edges),
                 origins(out, 0, std::span(from_.faces).first(made_split), section_.of.faces),
                 origins(tets, 0, from_.tets, section_.of.tets)};
    const auto inner = origins(in, outer, std::span(from_.faces).subspan(made_split), section_.of.faces);
    from.faces.insert(from.faces.end(), inner.begin(), inner.end());
    inherit(whole_, before, from);
    whole_.source.clear(), whole_.face_layers.clear();
    return ids_of(vertices, tets, std::move(from.nodes));
  }

 private:
  bool is_out(const Edge& edge) const { return out_vertex_[edge[0]] && out_vertex_[edge[1]]; }
  bool is_out(const Triangle& face) const { return out_face_.contains(face_key(face)); }

  /// The corners as the section numbers them; of an item with a corner that is new or moved kNone.
  template <class Item>
  Item as_before(Item item) const {
    for (VertexIndex& v : item) v = stays_[v] ? from_.nodes[v] : kNone;
    return item;
  }
  template <class Item>
  static Item key_of(Item item) {
    std::sort(item.begin(), item.end());
    return item;
  }

  Slots slots_of_vertices() const {
    std::vector<std::uint32_t> out, back;
    for (VertexIndex v = 0; v < out_vertex_.size(); ++v)
      if (out_vertex_[v]) out.push_back(section_.of.nodes[v]);
    for (const VertexIndex v : from_.nodes) back.push_back(v == kNone ? kNone : section_.of.nodes[v]);
    return {whole_.points.size(), out, back};
  }

  Slots slots_of_tets() const {
    std::vector<std::uint32_t> out, back;
    for (TetIndex t = 0; t < section_.of.tets.size(); ++t)
      if (section_.loose[t]) out.push_back(section_.of.tets[t]);
    for (const TetIndex t : same_tets(section_.mesh, made_, from_.nodes))
      back.push_back(t == kNone ? kNone : section_.of.tets[t]);
    return {whole_.tets.size(), out, back};
  }

  /// Of faces or edges, `ids` less `first`.
  template <class Item>
  Slots slots_of_items(const std::vector<Item>& whole, const std::vector<Item>& before,
                       std::span<const std::uint32_t> ids, std::uint32_t first, const std::vector<Item>& now) const {
    FlatMap<Item, std::uint32_t> known(before.size());
    std::vector<std::uint32_t> out, back;
    for (std::size_t i = 0; i < before.size(); ++i) {
      if (!is_out(before[i])) continue;
      known.find_or_add(key_of(before[i])) = ids[i] - first;
      out.push_back(ids[i] - first);
    }
    for (const Item& item : now) {
      const Item key = key_of(as_before(item));
      const std::uint32_t* id = key.back() == kNone ? nullptr : known.find(key);
      back.push_back(id ? *id : kNone);
    }
    return {whole.size(), out, back};
  }

  template <class Item>
  void place_items(std::vector<Item>& items, const std::vector<Item>& made, const Slots& slots,
                   const Slots& vertices) const {
    const auto old_count = items.size();
    slots.place(items, [&](std::size_t i, Item& item) {
      // What is as it was keeps the order of its corners, too.
      if (slots.of(i) < old_count && key_of(item) == key_in_whole(made[i])) return;
      item = made[i];
      for (VertexIndex& v : item) v = kNew + v;
    });
    const bool moved = vertices.any_moved();
    const auto renumber = [&](Item& item) {
      for (VertexIndex& v : item) v = v >= kNew ? vertices.of(v - kNew) : vertices.now(v);
    };
    if (moved)
      for (Item& item : items) renumber(item);
    else
      for (std::size_t i = 0; i < made.size(); ++i) renumber(items[slots.of(i)]);
  }
  template <class Item>
  Item key_in_whole(const Item& made) const {
    Item item = as_before(made);
    for (VertexIndex& v : item)
      if (v != kNone) v = section_.of.nodes[v];
    return key_of(item);
  }

  /// Of the items of the whole, counted from `first` on: what stays comes from itself, what was made by way of the
  /// section.
  static std::vector<std::uint32_t> origins(const Slots& slots, std::uint32_t first,
                                            std::span<const std::uint32_t> from,
                                            const std::vector<std::uint32_t>& of_section) {
    std::vector<std::uint32_t> all(slots.old_count());
    std::iota(all.begin(), all.end(), first);
    slots.place(all, [&](std::size_t i, std::uint32_t& id) { id = from[i] == kNone ? kNone : of_section[from[i]]; });
    return all;
  }

  SplicedIds ids_of(const Slots& vertices, const Slots& tets, std::vector<VertexIndex> old_of_new) const {
    SplicedIds ids;
    ids.old_of_new = std::move(old_of_new);
    ids.old_tet_of_new.resize(tets.old_count());
    std::iota(ids.old_tet_of_new.begin(), ids.old_tet_of_new.end(), 0u);
    tets.place(ids.old_tet_of_new, [&](std::size_t i, TetIndex& t) { t = tets.had(i); });
    ids.moved_vertices = vertices.moved(), ids.moved_tets = tets.moved();
    return ids;
  }

  static constexpr VertexIndex kNew = 0x80000000u;

  TetMesh& whole_;
  const Section& section_;
  const TetMesh& made_;
  const Origins& from_;
  std::vector<std::uint8_t> stays_;       ///< per vertex of `made`: it was there, at the same place
  std::vector<std::uint8_t> out_vertex_;  ///< per vertex of the section: it is one of a loose tet
  FlatSet<Triangle> out_face_;            ///< those of loose tets
};

}  // namespace

void mark_vertices(std::span<const Tet> tets, std::span<const std::uint8_t> marked, std::vector<std::uint8_t>& near) {
  for (TetIndex t = 0; t < tets.size(); ++t)
    if (marked[t])
      for (const VertexIndex v : tets[t]) near[v] = 1;
}

void grow_layer(std::span<const Tet> tets, std::vector<std::uint8_t>& marked, std::vector<std::uint8_t>& near) {
  parallel_for(tets.size(), [&](std::size_t t) {
    for (const VertexIndex v : tets[t]) marked[t] |= near[v];
  });
  mark_vertices(tets, marked, near);
}

Section section_of(const TetMesh& whole, std::vector<std::uint8_t>& chosen, int layers) {
  std::vector<std::uint8_t> near(whole.points.size(), 0);
  mark_vertices(whole.tets, chosen, near);
  for (int k = 0; k < layers; ++k) grow_layer(whole.tets, chosen, near);
  std::vector<std::uint8_t> frozen(whole.points.size(), 0);
  for (TetIndex t = 0; t < whole.tets.size(); ++t)
    if (!chosen[t])
      for (const VertexIndex v : whole.tets[t]) frozen[v] = 1;
  std::vector<std::uint8_t> taken = chosen;
  for (int k = 0; k < kLayersOfGround; ++k) grow_layer(whole.tets, taken, near);
  Section section;
  Origins& of = section.of;
  std::vector<VertexIndex> number(whole.points.size(), kNone);
  for (VertexIndex v = 0; v < near.size(); ++v) {
    if (!near[v]) continue;
    number[v] = static_cast<VertexIndex>(of.nodes.size());
    of.nodes.push_back(v);
    section.frozen.push_back(frozen[v]);
  }
  FlatSet<Triangle> faces;
  for (TetIndex t = 0; t < whole.tets.size(); ++t) {
    if (!taken[t]) continue;
    const Tet& c = whole.tets[t];
    of.tets.push_back(t);
    section.loose.push_back(std::any_of(c.begin(), c.end(), [&](VertexIndex v) { return !frozen[v]; }));
    for (int i = 0; i < 4; ++i) faces.insert(face_key(face_of(c, i)));
  }
  take_items(whole.boundary, 0, number, &faces, of.faces);
  take_items(whole.interfaces, static_cast<std::uint32_t>(whole.boundary.size()), number, &faces, of.faces);
  take_items(whole.curve_edges, 0, number, nullptr, of.edges);
  number.assign(number.size(), kNone);
  section.mesh = part_of(whole, of, number);
  return section;
}

TetMesh closed_part(const TetMesh& mesh, std::span<const std::uint8_t> loose) {
  TetMesh part;
  PointsTaken taken(mesh.points);
  for (TetIndex t = 0; t < mesh.tets.size(); ++t)
    if (loose.empty() || loose[t]) part.tets.push_back(taken.take(mesh.tets[t], part.points));
  part.boundary = boundary_triangles(part.tets, half_face_neighbors(part.tets, part.points.size()));
  return part;
}

SplicedIds splice(TetMesh& whole, const Section& section, const TetMesh& made, const Origins& from) {
  return Splicer(whole, section, made, from).run();
}

std::vector<TetIndex> same_tets(const TetMesh& before, const TetMesh& now, std::span<const VertexIndex> old_of_new) {
  // A tet is known by three of its corners, the least ones, and the other.
  struct Known {
    VertexIndex last;
    TetIndex tet;
    std::uint32_t next;
  };
  const auto sorted = [](Tet t) {
    std::sort(t.begin(), t.end());
    return t;
  };
  FlatMap<Triangle, std::uint32_t> first(before.tets.size());
  std::vector<Known> known;
  for (TetIndex t = 0; t < before.tets.size(); ++t) {
    const Tet key = sorted(before.tets[t]);
    std::uint32_t& head = first.find_or_add({key[0], key[1], key[2]}, kNone);
    known.push_back({key[3], t, head});
    head = t;
  }
  std::vector<TetIndex> same(now.tets.size(), kNone);
  for (TetIndex t = 0; t < now.tets.size(); ++t) {
    Tet key = now.tets[t];
    for (VertexIndex& v : key) {
      const VertexIndex old = old_of_new[v];
      v = old != kNone && before.points[old] == now.points[v] ? old : kNone;
    }
    key = sorted(key);
    if (key[3] == kNone) continue;
    const std::uint32_t* head = first.find({key[0], key[1], key[2]});
    for (std::uint32_t k = head ? *head : kNone; k != kNone; k = known[k].next)
      if (known[k].last == key[3]) same[t] = known[k].tet;
  }
  return same;
}

}  // namespace octafront::adapt
