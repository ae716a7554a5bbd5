#pragma once

#include "formats/containers/atomic_file.h"

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace octafront::io {

/// A netCDF file in the classic format with 64-bit offsets (CDF-2), or with 64-bit counts too where it needs them
/// (CDF-5). Declared first, then streamed: values are asked for one by one, in order.
/// See "The NetCDF Classic Format Specification", Unidata.
class NetcdfWriter {
 public:
  enum Type : std::uint32_t { kChar = 2, kInt = 4, kFloat = 5, kDouble = 6 };
  using Value = std::variant<std::int32_t, double>;
  using ValueAt = std::function<Value(std::uint64_t)>;
  /// A name and a text, an integer or a float.
  using Attribute = std::pair<std::string, std::variant<std::string, std::int32_t, float>>;

  explicit NetcdfWriter(AtomicFile& file) : file_(file) {}

  /// `length` 0: the unlimited dimension, of which nothing is written, or one record.
  std::uint32_t dimension(std::string name, std::uint64_t length);
  void attribute(Attribute a) { attributes_.push_back(std::move(a)); }
  /// Characters are given as integers.
  void variable(std::string name, Type type, std::vector<std::uint32_t> dimensions, ValueAt value,
                std::vector<Attribute> attributes = {});
  /// Variables of records must have been declared behind all others.
  void write(bool one_record = false);

 private:
  struct Variable {
    std::string name;
    Type type;
    std::vector<std::uint32_t> dimensions;
    ValueAt value;
    std::vector<Attribute> attributes;
    std::uint64_t count = 1;  ///< of values, also of a record
    bool of_records = false;
  };

  template <class T>
  void put(T value);
  void count(std::uint64_t n);
  void text(const std::string& name);
  void list_head(std::uint32_t tag, std::size_t size);
  void put_attributes(const std::vector<Attribute>& all);
  void put_header(const std::vector<std::uint64_t>& begins);
  void put_values(const Variable& v);
  static std::uint64_t bytes_of(const Variable& v);
  bool is_written(const Variable& v) const { return !v.of_records || has_record_; }

  AtomicFile& file_;
  bool long_counts_ = false, has_record_ = false;
  std::vector<std::pair<std::string, std::uint64_t>> dimensions_;
  std::vector<Attribute> attributes_;
  std::vector<Variable> variables_;
};

}  // namespace octafront::io
