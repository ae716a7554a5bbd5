// Gmsh MSH 4.1, binary. A patch is a surface entity and a physical surface, a region a volume entity and a physical
// volume, with tags that count from 1. A node belongs to the surface of the smallest patch at it, inner nodes to the
// volume of their region. Node and element tags are indices plus 1, elements counting the triangles first.

#include "core/groups.h"
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

/// Elements by patch or by region, ascending.
struct ByEntity {
  std::vector<std::uint32_t> ids;  ///< sorted: patches or regions that occur
  Groups<> elements;               ///< of each

  std::size_t size() const { return ids.size(); }
  std::uint32_t slot(std::uint32_t id) const {
    return static_cast<std::uint32_t>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
  }
};

ByEntity grouped(const std::vector<std::uint32_t>& id_of, std::uint32_t count) {
  ByEntity groups;
  const auto id = [&](std::size_t i) { return id_of.empty() ? 0 : id_of[i]; };
  for (std::size_t i = 0; i < count; ++i)
    if (groups.ids.empty() || id(i) != groups.ids.back()) groups.ids.push_back(id(i));
  std::sort(groups.ids.begin(), groups.ids.end());
  groups.ids.erase(std::unique(groups.ids.begin(), groups.ids.end()), groups.ids.end());
  std::vector<std::uint32_t> slot(count);
  for (std::size_t i = 0; i < count; ++i) slot[i] = i > 0 && id(i) == id(i - 1) ? slot[i - 1] : groups.slot(id(i));
  groups.elements = group_by_owner(groups.ids.size(), count, [&](std::uint32_t i) { return slot[i]; });
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
        patches_(grouped(mesh.patch, static_cast<std::uint32_t>(mesh.boundary.size()))),
        regions_(grouped(mesh.region, static_cast<std::uint32_t>(mesh.tets.size()))) {
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
      for (const std::uint32_t f : patches_.elements[p])
        for (const VertexIndex v : mesh_.boundary[f]) slot[v] = std::min(slot[v], p);
    boxes_.resize(entities());
    for (Slot r = 0; r < regions_.size(); ++r) {
      const auto s = static_cast<Slot>(patches_.size() + r);
      for (const TetIndex t : regions_.elements[r])
        for (const VertexIndex v : mesh_.tets[t]) {
          slot[v] = std::min(slot[v], s);
          boxes_[s].add(mesh_.points[v]);
        }
    }
    for (Slot p = 0; p < patches_.size(); ++p)
      for (const std::uint32_t f : patches_.elements[p])
        for (const VertexIndex v : mesh_.boundary[f]) boxes_[p].add(mesh_.points[v]);
    nodes_ = {entities(), [&](const auto& add) {
                for (VertexIndex v = 0; v < slot.size(); ++v)
                  if (slot[v] != kNone) add(slot[v], v);
              }};
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
      for (const std::uint32_t f : patches_.elements[p]) {
        const TetIndex t = tet_of[f];
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
    for (Slot s = 0; s < entities(); ++s) blocks += !nodes_[s].empty();
    const std::uint64_t count = nodes_.items().size();
    for (const std::uint64_t n : {blocks, count, std::uint64_t{1}, std::uint64_t{mesh_.points.size()}}) put(n);
    for (Slot s = 0; s < entities(); ++s) {
      if (nodes_[s].empty()) continue;
      put<std::int32_t>(dimension(s));
      put(tag(s));
      put<std::int32_t>(0);  // no parameters on the surface
      put(std::uint64_t{nodes_[s].size()});
      for (const VertexIndex v : nodes_[s]) put(std::uint64_t{v} + 1);
      for (const VertexIndex v : nodes_[s])
        for (int axis = 0; axis < 3; ++axis) put(mesh_.points[v][axis]);
    }
    text_ << "\n$EndNodes\n";
  }

  template <std::size_t N>
  void write_group(const ByEntity& groups, Slot s, std::int32_t type,
                   const std::vector<std::array<VertexIndex, N>>& corners, std::uint64_t first_tag) {
    put<std::int32_t>(N == 3 ? 2 : 3);
    put(static_cast<std::int32_t>(groups.ids[s]) + 1);
    put(type);
    put(std::uint64_t{groups.elements[s].size()});
    for (const std::uint32_t e : groups.elements[s]) {
      std::array<std::uint64_t, N + 1> record;
      record[0] = first_tag + e;
      for (std::size_t i = 0; i < N; ++i) record[i + 1] = std::uint64_t{corners[e][i]} + 1;
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
  ByEntity patches_, regions_;
  Groups<> nodes_;  ///< of each entity
  std::vector<Box3> boxes_;
};

}  // namespace

void write_msh(AtomicFile& file, const TetMesh& mesh) {
  MshWriter(file, mesh).write();
}

}  // namespace octafront::io
