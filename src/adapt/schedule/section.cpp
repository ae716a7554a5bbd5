#include "adapt/schedule/section.h"

#include "base/core/flat_map.h"
#include "base/mesh/adjacency.h"

#include <algorithm>
#include <array>

namespace octafront::adapt {
namespace {

/// Layers of elements around those that may change whose walls are needed: fits of the smooth surface go by three rings
/// of vertices around each, and what bends beside them by one more.
constexpr int kLayersOfGround = 4;

/// Marks the tets with a marked vertex, then their vertices.
void grow_layer(const TetMesh& mesh, std::vector<std::uint8_t>& tets, std::vector<std::uint8_t>& vertices) {
  for (TetIndex t = 0; t < mesh.tets.size(); ++t)
    for (const VertexIndex v : mesh.tets[t]) tets[t] |= vertices[v];
  for (TetIndex t = 0; t < mesh.tets.size(); ++t)
    if (tets[t])
      for (const VertexIndex v : mesh.tets[t]) vertices[v] = 1;
}

std::vector<std::uint8_t> vertices_of(const TetMesh& mesh, std::span<const std::uint8_t> tets) {
  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  for (TetIndex t = 0; t < mesh.tets.size(); ++t)
    if (tets[t])
      for (const VertexIndex v : mesh.tets[t]) marked[v] = 1;
  return marked;
}

/// Those of a list that lie in the section: `number` has the new numbers of vertices.
template <class Item>
void take_items(const std::vector<Item>& all, const std::vector<std::uint32_t>& parts,
                const std::vector<VertexIndex>& number, const FlatSet<Triangle>* faces, std::vector<Item>& items,
                std::vector<std::uint32_t>& item_parts, std::vector<std::uint32_t>& ids) {
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    Item item = all[i];
    if (std::any_of(item.begin(), item.end(), [&](VertexIndex v) { return number[v] == kNone; })) continue;
    for (VertexIndex& v : item) v = number[v];
    if constexpr (std::is_same_v<Item, Triangle>)
      if (!faces->contains(face_key(item))) continue;
    items.push_back(item);
    if (!parts.empty()) item_parts.push_back(parts[i]);
    ids.push_back(i);
  }
}

FlatSet<Triangle> faces_of(std::span<const Tet> tets) {
  FlatSet<Triangle> faces(2 * tets.size());
  for (const Tet& t : tets)
    for (int i = 0; i < 4; ++i) faces.insert(face_key(face_of(t, i)));
  return faces;
}

/// The members of a set in the section: `ids` are the numbers, ascending, of items that it has.
void take_members(const std::vector<std::uint32_t>& members, std::span<const std::uint32_t> ids, std::uint32_t from,
                  std::uint32_t to, std::vector<std::uint32_t>& taken) {
  for (const std::uint32_t m : members) {
    if (m < from) continue;
    const auto at = std::lower_bound(ids.begin(), ids.end(), m - from);
    if (at != ids.end() && *at == m - from) taken.push_back(to + static_cast<std::uint32_t>(at - ids.begin()));
  }
}

void take_sets(const TetMesh& whole, Section& section) {
  section.mesh.sets = whole.sets;
  const auto outer = static_cast<std::uint32_t>(whole.boundary.size());
  for (NamedSet& set : section.mesh.sets) {
    const std::vector<std::uint32_t> members = std::move(set.members);
    set.members.clear();
    switch (set.kind) {
      case NamedSet::Kind::kNodes:
        take_members(members, section.vertex, 0, 0, set.members);
        break;
      case NamedSet::Kind::kElements:
        take_members(members, section.tet, 0, 0, set.members);
        break;
      case NamedSet::Kind::kEdges:
        take_members(members, section.line, 0, 0, set.members);
        break;
      case NamedSet::Kind::kFaces: {
        const auto split = std::lower_bound(members.begin(), members.end(), outer);
        take_members({members.begin(), split}, section.outer, 0, 0, set.members);
        take_members({split, members.end()}, section.inner, outer, static_cast<std::uint32_t>(section.outer.size()),
                     set.members);
      }
    }
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
        out_(out.begin(), out.end()),
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

  std::uint32_t count() const { return count_; }
  /// Of the i-th one that comes back.
  std::uint32_t of(std::size_t i) const { return id_[i]; }
  /// The number that it had; kNone: it is new.
  std::uint32_t had(std::size_t i) const { return had_[i]; }
  /// Whether the item of this number was taken out, by its number before.
  bool was_out(std::uint32_t old) const { return std::binary_search(out_.begin(), out_.end(), old); }
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
  std::vector<std::uint32_t> out_, had_;
  std::vector<std::uint32_t> id_;     ///< of those that come back
  std::vector<std::uint32_t> moved_;  ///< of those from count_ on; kNone: gone
};

class Splicer {
 public:
  Splicer(TetMesh& whole, const Section& section, const TetMesh& made, std::span<const VertexIndex> made_old)
      : whole_(whole), section_(section), made_(made), made_old_(made_old), stays_(made.points.size(), 0) {
    for (VertexIndex v = 0; v < stays_.size(); ++v)
      stays_[v] = made_old_[v] != kNone && made_.points[v] == section_.mesh.points[made_old_[v]];
    out_vertex_.assign(section_.vertex.size(), 0);
    for (TetIndex t = 0; t < section_.tet.size(); ++t)
      if (section_.loose[t])
        for (const VertexIndex v : section_.mesh.tets[t]) out_vertex_[v] = 1;
  }

  SplicedIds run() {
    const Slots vertices = slots_of_vertices();
    const Slots tets = slots_of_tets();
    FlatSet<Triangle> faces(2 * section_.tet.size());
    for (TetIndex t = 0; t < section_.tet.size(); ++t)
      if (section_.loose[t])
        for (int i = 0; i < 4; ++i) faces.insert(face_key(face_of(section_.mesh.tets[t], i)));
    const auto is_out = [&](const auto& item) {
      if constexpr (std::tuple_size_v<std::decay_t<decltype(item)>> == 3) return faces.contains(face_key(item));
      return std::all_of(item.begin(), item.end(), [&](VertexIndex v) { return out_vertex_[v] != 0; });
    };
    const Slots outer = slots_of_items(whole_.boundary, section_.mesh.boundary, section_.outer, made_.boundary, is_out);
    const Slots inner =
        slots_of_items(whole_.interfaces, section_.mesh.interfaces, section_.inner, made_.interfaces, is_out);
    const Slots lines =
        slots_of_items(whole_.curve_edges, section_.mesh.curve_edges, section_.line, made_.curve_edges, is_out);
    place_sets(vertices, tets, outer, inner, lines);
    SplicedIds ids = ids_of(vertices, tets);
    vertices.place(whole_.points, [&](std::size_t i, Vec3& p) { p = made_.points[i]; });
    place_items(whole_.tets, whole_.region, made_.tets, made_.region, tets, vertices);
    place_items(whole_.boundary, whole_.patch, made_.boundary, made_.patch, outer, vertices);
    place_items(whole_.interfaces, whole_.interface_patch, made_.interfaces, made_.interface_patch, inner, vertices);
    place_items(whole_.curve_edges, whole_.curve, made_.curve_edges, made_.curve, lines, vertices);
    whole_.source.clear(), whole_.face_layers.clear();
    return ids;
  }

 private:
  /// The corners as the section numbers them; of an item with a corner that is new or moved kNone.
  template <class Item>
  Item as_before(Item item) const {
    for (VertexIndex& v : item) v = stays_[v] ? made_old_[v] : kNone;
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
      if (out_vertex_[v]) out.push_back(section_.vertex[v]);
    for (const VertexIndex v : made_old_) back.push_back(v == kNone ? kNone : section_.vertex[v]);
    return {whole_.points.size(), out, back};
  }

  Slots slots_of_tets() {
    std::vector<std::uint32_t> out, back;
    for (TetIndex t = 0; t < section_.tet.size(); ++t)
      if (section_.loose[t]) out.push_back(section_.tet[t]);
    for (const TetIndex t : same_tets(section_.mesh, made_, made_old_))
      back.push_back(t == kNone ? kNone : section_.tet[t]);
    return {whole_.tets.size(), out, back};
  }

  /// Of faces or edges.
  template <class Item, class IsOut>
  Slots slots_of_items(const std::vector<Item>& whole, const std::vector<Item>& before,
                       std::span<const std::uint32_t> ids, const std::vector<Item>& now, const IsOut& is_out) const {
    FlatMap<Item, std::uint32_t> known(before.size());
    std::vector<std::uint32_t> out, back;
    for (std::size_t i = 0; i < before.size(); ++i) {
      if (!is_out(before[i])) continue;
      known.find_or_add(key_of(before[i])) = ids[i];
      out.push_back(ids[i]);
    }
    for (const Item& item : now) {
      const Item key = key_of(as_before(item));
      const std::uint32_t* id = key.back() == kNone ? nullptr : known.find(key);
      back.push_back(id ? *id : kNone);
    }
    return {whole.size(), out, back};
  }

  template <class Item>
  void place_items(std::vector<Item>& items, std::vector<std::uint32_t>& parts, const std::vector<Item>& made,
                   const std::vector<std::uint32_t>& made_parts, const Slots& slots, const Slots& vertices) const {
    const auto old_count = items.size();
    slots.place(items, [&](std::size_t i, Item& item) {
      // What is as it was keeps the order of its corners, too.
      if (slots.of(i) < old_count && key_of(item) == key_in_whole(made[i])) return;
      item = made[i];
      for (VertexIndex& v : item) v = kNew + v;
    });
    if (!parts.empty()) slots.place(parts, [&](std::size_t i, std::uint32_t& part) { part = made_parts[i]; });
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
      if (v != kNone) v = section_.vertex[v];
    return key_of(item);
  }

  void place_sets(const Slots& vertices, const Slots& tets, const Slots& outer, const Slots& inner,
                  const Slots& lines) {
    for (std::size_t s = 0; s < whole_.sets.size(); ++s) {
      NamedSet& set = whole_.sets[s];
      const NamedSet& has = made_.sets[s];
      switch (set.kind) {
        case NamedSet::Kind::kNodes:
          replace_members(set, has, vertices);
          break;
        case NamedSet::Kind::kElements:
          replace_members(set, has, tets);
          break;
        case NamedSet::Kind::kEdges:
          replace_members(set, has, lines);
          break;
        case NamedSet::Kind::kFaces:
          replace_faces(set, has, outer, inner);
      }
      std::sort(set.members.begin(), set.members.end());
    }
  }
  static void replace_members(NamedSet& set, const NamedSet& has, const Slots& slots) {
    std::vector<std::uint32_t> members;
    for (const std::uint32_t m : set.members)
      if (!slots.was_out(m)) members.push_back(slots.now(m));
    for (const std::uint32_t m : has.members) members.push_back(slots.of(m));
    set.members = std::move(members);
  }
  /// Faces of interfaces count on behind those of the boundary.
  void replace_faces(NamedSet& set, const NamedSet& has, const Slots& outer, const Slots& inner) const {
    const auto old_outer = static_cast<std::uint32_t>(whole_.boundary.size());
    const auto made_outer = static_cast<std::uint32_t>(made_.boundary.size());
    std::vector<std::uint32_t> members;
    for (const std::uint32_t m : set.members) {
      const bool is_outer = m < old_outer;
      const std::uint32_t id = is_outer ? m : m - old_outer;
      if (!(is_outer ? outer : inner).was_out(id))
        members.push_back(is_outer ? outer.now(id) : outer.count() + inner.now(id));
    }
    for (const std::uint32_t m : has.members)
      members.push_back(m < made_outer ? outer.of(m) : outer.count() + inner.of(m - made_outer));
    set.members = std::move(members);
  }

  SplicedIds ids_of(const Slots& vertices, const Slots& tets) const {
    SplicedIds ids;
    ids.old_of_new.resize(whole_.points.size());
    ids.old_tet_of_new.resize(whole_.tets.size());
    for (VertexIndex v = 0; v < ids.old_of_new.size(); ++v) ids.old_of_new[v] = v;
    for (TetIndex t = 0; t < ids.old_tet_of_new.size(); ++t) ids.old_tet_of_new[t] = t;
    vertices.place(ids.old_of_new, [&](std::size_t i, VertexIndex& v) { v = vertices.had(i); });
    tets.place(ids.old_tet_of_new, [&](std::size_t i, TetIndex& t) { t = tets.had(i); });
    ids.moved_vertices = vertices.moved(), ids.moved_tets = tets.moved();
    return ids;
  }

  static constexpr VertexIndex kNew = 0x80000000u;

  TetMesh& whole_;
  const Section& section_;
  const TetMesh& made_;
  std::span<const VertexIndex> made_old_;
  std::vector<std::uint8_t> stays_;       ///< per vertex of `made`: it was there, at the same place
  std::vector<std::uint8_t> out_vertex_;  ///< per vertex of the section: it is one of a loose tet
};

}  // namespace

Section section_of(const TetMesh& whole, std::vector<std::uint8_t>& chosen, int layers) {
  std::vector<std::uint8_t> near = vertices_of(whole, chosen);
  for (int k = 0; k < layers; ++k) grow_layer(whole, chosen, near);
  std::vector<std::uint8_t> frozen(whole.points.size(), 0);
  for (TetIndex t = 0; t < whole.tets.size(); ++t)
    if (!chosen[t])
      for (const VertexIndex v : whole.tets[t]) frozen[v] = 1;
  std::vector<std::uint8_t> taken = chosen;
  for (int k = 0; k < kLayersOfGround; ++k) grow_layer(whole, taken, near);
  Section section;
  std::vector<VertexIndex> number(whole.points.size(), kNone);
  for (VertexIndex v = 0; v < near.size(); ++v) {
    if (!near[v]) continue;
    number[v] = static_cast<VertexIndex>(section.vertex.size());
    section.vertex.push_back(v);
    section.mesh.points.push_back(whole.points[v]);
    section.frozen.push_back(frozen[v]);
  }
  for (TetIndex t = 0; t < whole.tets.size(); ++t) {
    if (!taken[t]) continue;
    Tet c = whole.tets[t];
    const bool loose = std::any_of(c.begin(), c.end(), [&](VertexIndex v) { return !frozen[v]; });
    for (VertexIndex& v : c) v = number[v];
    section.mesh.tets.push_back(c);
    if (!whole.region.empty()) section.mesh.region.push_back(whole.region[t]);
    section.tet.push_back(t);
    section.loose.push_back(loose);
  }
  const FlatSet<Triangle> faces = faces_of(section.mesh.tets);
  TetMesh& part = section.mesh;
  take_items(whole.boundary, whole.patch, number, &faces, part.boundary, part.patch, section.outer);
  take_items(whole.interfaces, whole.interface_patch, number, &faces, part.interfaces, part.interface_patch,
             section.inner);
  take_items(whole.curve_edges, whole.curve, number, nullptr, part.curve_edges, part.curve, section.line);
  part.region_names = whole.region_names, part.region_labels = whole.region_labels;
  part.patch_names = whole.patch_names, part.curve_names = whole.curve_names;
  part.patch_labels = whole.patch_labels, part.curve_labels = whole.curve_labels;
  take_sets(whole, section);
  return section;
}

TetMesh closed_part(const TetMesh& mesh, std::span<const std::uint8_t> loose) {
  TetMesh part;
  std::vector<VertexIndex> number(mesh.points.size(), kNone);
  for (TetIndex t = 0; t < mesh.tets.size(); ++t) {
    if (!loose.empty() && !loose[t]) continue;
    Tet c = mesh.tets[t];
    for (VertexIndex& v : c) {
      if (number[v] == kNone) {
        number[v] = static_cast<VertexIndex>(part.points.size());
        part.points.push_back(mesh.points[v]);
      }
      v = number[v];
    }
    part.tets.push_back(c);
  }
  part.boundary = boundary_triangles(part.tets, half_face_neighbors(part.tets, part.points.size()));
  return part;
}

SplicedIds splice(TetMesh& whole, const Section& section, const TetMesh& made, std::span<const VertexIndex> made_old) {
  return Splicer(whole, section, made, made_old).run();
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
