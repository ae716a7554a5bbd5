// Gmsh MSH 4.1, binary. A patch is a surface entity and a physical surface, a region a volume entity and a physical
// volume, with tags that count from 1. A node belongs to the surface of the smallest patch at it, inner nodes to the
// volume of their region. Node and element tags are indices plus 1, elements counting the triangles first.

#include "io/boundary.h"
#include "io/text_writer.h"
#include "io/writers.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <utility>

namespace octafront::io {
namespace {

/// Things sorted into groups: those of group g are items[begin[g]] ... items[begin[g + 1] - 1], in increasing order.
struct Groups {
  std::vector<std::uint32_t> ids;  ///< sorted: patches or regions that occur
  std::vector<std::uint64_t> begin;
  std::vector<std::uint32_t> items;

  std::size_t size() const { return ids.size(); }
  std::uint32_t slot(std::uint32_t id) const {
    return static_cast<std::uint32_t>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
  }
};

/// `slot_of(i)` is below `slots`, or kNone for what belongs to no group.
template <class SlotOf>
void distribute(Groups& groups, std::size_t slots, std::size_t count, const SlotOf& slot_of) {
  groups.begin.assign(slots + 1, 0);
  for (std::uint32_t i = 0; i < count; ++i)
    if (slot_of(i) != kNone) ++groups.begin[slot_of(i) + 1];
  for (std::size_t s = 0; s < slots; ++s) groups.begin[s + 1] += groups.begin[s];
  groups.items.resize(groups.begin[slots]);
  std::vector<std::uint64_t> next(groups.begin.begin(), groups.begin.end() - 1);
  for (std::uint32_t i = 0; i < count; ++i)
    if (slot_of(i) != kNone) groups.items[next[slot_of(i)]++] = i;
}

Groups grouped(const std::vector<std::uint32_t>& id_of, std::size_t count) {
  Groups groups;
  const auto id = [&](std::size_t i) { return id_of.empty() ? 0 : id_of[i]; };
  for (std::size_t i = 0; i < count; ++i)
    if (groups.ids.empty() || id(i) != groups.ids.back()) groups.ids.push_back(id(i));
  std::sort(groups.ids.begin(), groups.ids.end());
  groups.ids.erase(std::unique(groups.ids.begin(), groups.ids.end()), groups.ids.end());
  std::vector<std::uint32_t> slot(count);
  for (std::size_t i = 0; i < count; ++i) slot[i] = i > 0 && id(i) == id(i - 1) ? slot[i - 1] : groups.slot(id(i));
  distribute(groups, groups.ids.size(), count, [&](std::uint32_t i) { return slot[i]; });
  return groups;
}

/// Names stand in quotes, which Gmsh does not escape.
std::string unquoted(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '"' || static_cast<unsigned char>(c) < 0x20; }, '_');
  return name;
}

class MshWriter {
 public:
  MshWriter(AtomicFile& file, const TetMesh& mesh)
      : file_(file),
        text_(file),
        mesh_(mesh),
        patches_(grouped(mesh.patch, mesh.boundary.size())),
        regions_(grouped(mesh.region, mesh.tets.size())) {
    assign_nodes();
  }

  void write() {
    text_ << "$MeshFormat\n4.1 1 8\n";
    put<std::int32_t>(1);
    text_ << "\n$EndMeshFormat\n";
    write_names();
    write_entities();
    write_nodes();
    write_elements();
  }

 private:
  using Slot = std::uint32_t;  ///< of an entity: the patches, then the regions

  template <class T>
  void put(T value) {
    file_.write(&value, sizeof value);
  }

  std::size_t entities() const { return patches_.size() + regions_.size(); }
  int dimension(Slot s) const { return s < patches_.size() ? 2 : 3; }
  std::int32_t tag(Slot s) const {
    return static_cast<std::int32_t>(s < patches_.size() ? patches_.ids[s] : regions_.ids[s - patches_.size()]) + 1;
  }

  void assign_nodes() {
    std::vector<Slot> slot(mesh_.points.size(), kNone);
    for (Slot p = 0; p < patches_.size(); ++p)
      for (std::uint64_t k = patches_.begin[p]; k < patches_.begin[p + 1]; ++k)
        for (const VertexIndex v : mesh_.boundary[patches_.items[k]]) slot[v] = std::min(slot[v], p);
    boxes_.resize(entities());
    for (Slot r = 0; r < regions_.size(); ++r) {
      const auto s = static_cast<Slot>(patches_.size() + r);
      for (std::uint64_t k = regions_.begin[r]; k < regions_.begin[r + 1]; ++k)
        for (const VertexIndex v : mesh_.tets[regions_.items[k]]) {
          slot[v] = std::min(slot[v], s);
          boxes_[s].add(mesh_.points[v]);
        }
    }
    for (Slot p = 0; p < patches_.size(); ++p)
      for (std::uint64_t k = patches_.begin[p]; k < patches_.begin[p + 1]; ++k)
        for (const VertexIndex v : mesh_.boundary[patches_.items[k]]) boxes_[p].add(mesh_.points[v]);
    distribute(nodes_, entities(), slot.size(), [&](std::uint32_t v) { return slot[v]; });
  }

  void write_names() {
    std::vector<Slot> named;
    const auto name = [this](Slot s) -> std::string {
      if (s >= patches_.size()) return regions_.size() == 1 ? "body" : "body_" + std::to_string(tag(s));
      return patches_.ids[s] < mesh_.patch_names.size() ? mesh_.patch_names[patches_.ids[s]] : std::string();
    };
    for (Slot s = 0; s < entities(); ++s)
      if (!name(s).empty()) named.push_back(s);
    text_ << "$PhysicalNames\n" << std::uint64_t{named.size()} << '\n';
    for (const Slot s : named)
      text_ << static_cast<std::uint32_t>(dimension(s)) << ' ' << static_cast<std::uint32_t>(tag(s)) << " \""
            << unquoted(name(s)) << "\"\n";
    text_ << "$EndPhysicalNames\n";
  }

  /// Per region the slots of the patches that bound it, sorted.
  std::vector<std::vector<Slot>> patches_of_regions() const {
    const std::vector<TetIndex> tet_of = tets_of_faces(mesh_.tets, mesh_.boundary, mesh_.points.size());
    std::vector<std::vector<Slot>> bounding(regions_.size());
    for (Slot p = 0; p < patches_.size(); ++p) {
      for (std::uint64_t k = patches_.begin[p]; k < patches_.begin[p + 1]; ++k) {
        const TetIndex t = tet_of[patches_.items[k]];
        if (t == kNone) continue;
        std::vector<Slot>& list = bounding[regions_.slot(mesh_.region.empty() ? 0 : mesh_.region[t])];
        if (list.empty() || list.back() != p) list.push_back(p);
      }
    }
    return bounding;
  }

  void write_entities() {
    text_ << "$Entities\n";
    for (const std::uint64_t count : {std::size_t{0}, std::size_t{0}, patches_.size(), regions_.size()}) put(count);
    const std::vector<std::vector<Slot>> bounding = patches_of_regions();
    for (Slot s = 0; s < entities(); ++s) {
      put(tag(s));
      for (const Vec3& corner : {boxes_[s].lo, boxes_[s].hi})
        for (int axis = 0; axis < 3; ++axis) put(corner[axis]);
      put<std::uint64_t>(1);  // physical groups
      put(tag(s));
      const bool is_patch = s < patches_.size();
      put<std::uint64_t>(is_patch ? 0 : bounding[s - patches_.size()].size());
      if (is_patch) continue;
      for (const Slot p : bounding[s - patches_.size()]) put(tag(p));
    }
    text_ << "\n$EndEntities\n";
  }

  void write_nodes() {
    text_ << "$Nodes\n";
    std::uint64_t blocks = 0;
    for (Slot s = 0; s < entities(); ++s) blocks += nodes_.begin[s] != nodes_.begin[s + 1];
    const std::uint64_t count = nodes_.items.size();
    for (const std::uint64_t n : {blocks, count, std::uint64_t{1}, std::uint64_t{mesh_.points.size()}}) put(n);
    for (Slot s = 0; s < entities(); ++s) {
      const std::uint64_t begin = nodes_.begin[s], end = nodes_.begin[s + 1];
      if (begin == end) continue;
      put<std::int32_t>(dimension(s));
      put(tag(s));
      put<std::int32_t>(0);  // no parameters on the surface
      put(end - begin);
      for (std::uint64_t k = begin; k < end; ++k) put(std::uint64_t{nodes_.items[k]} + 1);
      for (std::uint64_t k = begin; k < end; ++k)
        for (int axis = 0; axis < 3; ++axis) put(mesh_.points[nodes_.items[k]][axis]);
    }
    text_ << "\n$EndNodes\n";
  }

  template <std::size_t N>
  void write_group(const Groups& groups, Slot s, std::int32_t type,
                   const std::vector<std::array<VertexIndex, N>>& corners, std::uint64_t first_tag) {
    const std::uint64_t begin = groups.begin[s], end = groups.begin[s + 1];
    put<std::int32_t>(N == 3 ? 2 : 3);
    put(static_cast<std::int32_t>(groups.ids[s]) + 1);
    put(type);
    put(end - begin);
    for (std::uint64_t k = begin; k < end; ++k) {
      std::array<std::uint64_t, N + 1> record;
      record[0] = first_tag + groups.items[k];
      for (std::size_t i = 0; i < N; ++i) record[i + 1] = std::uint64_t{corners[groups.items[k]][i]} + 1;
      put(record);
    }
  }

  void write_elements() {
    constexpr std::int32_t kTriangleType = 2, kTetType = 4;
    const std::uint64_t triangles = mesh_.boundary.size(), count = triangles + mesh_.tets.size();
    text_ << "$Elements\n";
    for (const std::uint64_t n : {std::uint64_t{entities()}, count, std::uint64_t{1}, count}) put(n);
    for (Slot p = 0; p < patches_.size(); ++p) write_group(patches_, p, kTriangleType, mesh_.boundary, 1);
    for (Slot r = 0; r < regions_.size(); ++r) write_group(regions_, r, kTetType, mesh_.tets, triangles + 1);
    text_ << "\n$EndElements\n";
  }

  AtomicFile& file_;
  TextWriter text_;
  const TetMesh& mesh_;
  Groups patches_, regions_, nodes_;
  std::vector<Box3> boxes_;
};

}  // namespace

void write_msh(AtomicFile& file, const TetMesh& mesh) {
  MshWriter(file, mesh).write();
}

}  // namespace octafront::io
