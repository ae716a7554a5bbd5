#include "pipeline/stages/packed.h"

#include "sizing/field/packed_sizes.h"

#include <string>
#include <utility>
#include <vector>

namespace octafront {

namespace {

// One list of the members of each struct serves both ways: `each` packs what it is given, or unpacks into it.

struct PackInto {
  Packer& to;

  void operator()(const std::string& text) const { to.add_text(text); }
  void operator()(const NamedSet& set) const { (*this)(set.name), to.add(set.kind), to.add(set.members); }
  void operator()(const std::pair<std::string, double>& counter) const {
    (*this)(counter.first), to.add(counter.second);
  }
  template <class T>
  void operator()(const std::vector<T>& list) const {
    if constexpr (std::is_trivially_copyable_v<T>) {
      to.add(list);
    } else {
      to.add(static_cast<std::uint64_t>(list.size()));
      for (const T& item : list) (*this)(item);
    }
  }
};

struct UnpackFrom {
  Unpacker& from;

  void operator()(std::string& text) const { text = from.take_text(); }
  void operator()(NamedSet& set) const {
    (*this)(set.name), set.kind = from.take<NamedSet::Kind>(), from.take(set.members);
  }
  void operator()(std::pair<std::string, double>& counter) const {
    (*this)(counter.first), counter.second = from.take<double>();
  }
  template <class T>
  void operator()(std::vector<T>& list) const {
    if constexpr (std::is_trivially_copyable_v<T>) {
      from.take(list);
    } else {
      list.resize(static_cast<std::size_t>(from.take<std::uint64_t>()));
      for (T& item : list) (*this)(item);
    }
  }
};

template <class Mesh, class Each>
void members_of_mesh(Mesh& m, const Each& each) {
  each(m.points), each(m.tets), each(m.region), each(m.region_names), each(m.region_labels), each(m.boundary);
  each(m.patch_labels), each(m.curve_labels);
  each(m.patch), each(m.source), each(m.patch_names), each(m.interfaces), each(m.interface_patch), each(m.curve_edges);
  each(m.curve), each(m.curve_names), each(m.mid_nodes), each(m.sets), each(m.wide_cells), each(m.wide_faces);
  each(m.periods), each(m.period_rotations), each(m.periodic_nodes), each(m.face_layers), each(m.split_faces);
}

template <class Surface, class Each>
void members_of_surface(Surface& s, const Each& each) {
  each(s.points), each(s.triangles), each(s.patch), each(s.patch_names), each(s.source), each(s.sides);
  each(s.region_names), each(s.region_labels), each(s.patch_labels);
}

/// All but the sizes.
template <class Made, class Each>
void members_of_remeshed(Made& r, const Each& each) {
  members_of_surface(r.surface, each);
  each(r.features.edges), each(r.features.corners), each(r.source), each(r.near_limit);
}

}  // namespace

void pack(const TetMesh& mesh, Packer& to) {
  members_of_mesh(mesh, PackInto{to});
}

void pack(const Remeshed& made, Packer& to) {
  PackInto{to}(packed_sizes(made.sizes));
  members_of_remeshed(made, PackInto{to});
  to.add(made.stays);
}

void pack(const ImprovedMesh& improved, Packer& to) {
  pack(improved.mesh, to), pack(improved.boundary, to);
}

void pack(const StageReport& stage, Packer& to) {
  const PackInto each{to};
  each(stage.name), to.add(stage.wall_seconds), to.add(stage.cpu_seconds), each(stage.counters), each(stage.notes);
}

template <>
TetMesh unpacked(Unpacker& from) {
  TetMesh mesh;
  members_of_mesh(mesh, UnpackFrom{from});
  return mesh;
}

template <>
Remeshed unpacked(Unpacker& from) {
  std::string sizes;
  UnpackFrom{from}(sizes);
  Remeshed made{{}, {}, {}, unpacked_sizes(sizes)};
  members_of_remeshed(made, UnpackFrom{from});
  made.stays = from.take<bool>();
  return made;
}

template <>
ImprovedMesh unpacked(Unpacker& from) {
  TetMesh mesh = unpacked<TetMesh>(from);
  return {std::move(mesh), unpacked<Remeshed>(from)};
}

template <>
StageReport unpacked(Unpacker& from) {
  StageReport stage;
  const UnpackFrom each{from};
  each(stage.name), stage.wall_seconds = from.take<double>(), stage.cpu_seconds = from.take<double>();
  each(stage.counters), each(stage.notes);
  return stage;
}

}  // namespace octafront
