#pragma once

#include "formats/containers/hdf5_file.h"
#include "formats/parts/field_columns.h"
#include "formats/parts/legal_names.h"
#include "formats/parts/mesh_output.h"
#include "formats/parts/mesh_parts.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace octafront::io {

/// A CGNS file by the mapping of the SIDS to HDF5 (every node is a group with the attributes name, label, type and
/// flags, and its values in " data"): one base, one unstructured zone, and what all kinds of cells have in common.
/// Names have 32 characters.
class CgnsFile {
 public:
  static constexpr std::size_t kName = 33;
  static constexpr NameRules kRules{.longest = 32, .also = " _-.+#()[]{}<>=&%$!?*'\"", .letter_first = false};

  /// `version`: of CGNS.
  CgnsFile(MeshOutput& out, const MeshParts& mesh, float version);

  /// Legal ones, of MeshParts::parts().
  const std::vector<std::string>& names() const { return names_; }
  void begin_zone(std::size_t points, std::size_t cells, const std::function<Vec3(std::uint64_t)>& place_of);
  /// Returns its path; names too long for one stay different. Elements are counted from 1.
  std::string section(const std::string& name, std::int32_t type, std::int32_t first, std::int32_t last);
  /// The boundary conditions of all patches: faces by their first and last number.
  void conditions(std::span<const std::array<std::int32_t, 2>> faces_of_parts);
  /// Of fields at points, or in cells as `order` has them; number k of the value of item i of a field.
  using ValueOf = std::function<double(const MeshField&, std::uint64_t i, std::size_t k)>;
  void solution(const std::vector<FieldColumn>& columns, bool in_cells, std::uint64_t items, const ValueOf& value_of);
  void close() { file_.close(); }

  void node(const std::string& path, const char* label, const char* type);
  template <class T, class ValueAt>
  void data(const std::string& path, const std::vector<std::uint64_t>& shape, const ValueAt& value_at) {
    file_.values<T>(path + "/ data", shape, value_at);
  }
  /// A node that is an array.
  template <class T, class ValueAt>
  void array(const std::string& path, const char* label, std::uint64_t size, const ValueAt& value_at) {
    node(path, label, sizeof(T) == 8 ? "R8" : "I4");
    data<T>(path, {size}, value_at);
  }

 private:
  void attributes(const std::string& path, const std::string& name, const char* label, const char* type);
  void text(const std::string& path, const char* label, const std::string& words);
  void write_root(float version);
  void write_base();

  Hdf5Writer file_;
  const MeshParts& mesh_;
  std::vector<std::string> names_;
  LegalNames sections_{kRules};
};

}  // namespace octafront::io
