#pragma once

#include <octafront/run_context.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Only what is built with HDF5 includes this; the library's own header stays in hdf5_file.cpp.

namespace octafront::io {

/// A new HDF5 file. Groups are named by their paths, "/a/b", and made one by one. Datasets are streamed: values are
/// asked for block by block. Throws OutputError with the reason, Cancelled.
class Hdf5Writer {
 public:
  /// Fills `to` with the values [first, first + count).
  template <class T>
  using Fill = std::function<void(std::uint64_t first, std::span<T> to)>;
  /// Value by value; value_at must live as long.
  template <class T, class ValueAt>
  static Fill<T> each(const ValueAt& value_at) {
    return [&value_at](std::uint64_t first, std::span<T> to) {
      for (std::uint64_t k = 0; k < to.size(); ++k) to[k] = value_at(first + k);
    };
  }

  /// `target`: as the user knows it, for messages. `ordered`: groups remember the order in which their members were
  /// made.
  Hdf5Writer(const std::filesystem::path& file, std::string target, RunContext context, bool ordered = false);
  ~Hdf5Writer();
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  void group(const std::string& path);
  void attribute(const std::string& of, const std::string& name, std::int32_t value);
  void attribute(const std::string& of, const std::string& name, double value);
  /// A string of fixed length, `size` with the 0 at its end; 0: as long as the text and the 0.
  void attribute(const std::string& of, const std::string& name, std::string_view text, std::size_t size = 0);
  void attribute(const std::string& of, const std::string& name, const std::vector<std::int32_t>& values);

  template <class T>
  void dataset(const std::string& path, const std::vector<std::uint64_t>& shape, const Fill<T>& fill) {
    rows(path, shape, {0, shape[0]}, fill);
  }
  template <class T, class ValueAt>
  void values(const std::string& path, const std::vector<std::uint64_t>& shape, const ValueAt& value_at) {
    dataset(path, shape, each<T>(value_at));
  }
  /// A stretch of rows of a dataset of this shape, which is made at the first one: whoever has only a piece at a time
  /// need not know the others. `first` counts from the beginning of the stretch.
  struct Stretch {
    std::uint64_t begin, rows;
  };
  template <class T>
  void rows(const std::string& path, const std::vector<std::uint64_t>& shape, Stretch stretch, const Fill<T>& fill);
  /// Rows of texts, each an array of so many bytes filled up with 0: one value of that array type each.
  void texts(const std::string& path, const std::vector<std::string>& rows, std::size_t length);

  /// Flushes and closes; without it the file is not complete.
  void close();

 private:
  template <class T>
  void put_attribute(const std::string& of, const std::string& name, std::int64_t type, const T* values,
                     std::size_t count);
  [[noreturn]] void fail(std::string_view what) const;
  std::int64_t check(std::int64_t id, std::string_view what) const;

  std::string target_;
  RunContext context_;
  std::int64_t file_ = -1;
  bool ordered_;
};

/// An HDF5 file to read. Values are bounded by what the file can hold. Throws InputError; but the library itself, which
/// parses the file, is not made for hostile ones.
class Hdf5Reader {
 public:
  Hdf5Reader(const std::filesystem::path& file, std::string name, RunContext context);
  ~Hdf5Reader();
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  bool has(const std::string& path) const;
  /// Names of the members of a group, in alphabetical order.
  std::vector<std::string> members(const std::string& path) const;
  std::vector<std::uint64_t> shape(const std::string& path) const;
  std::vector<double> reals(const std::string& path) const;
  std::vector<std::int64_t> integers(const std::string& path) const;
  /// A dataset of bytes, or of arrays of bytes.
  std::string bytes(const std::string& path) const;
  std::int64_t integer_attribute(const std::string& of, const std::string& name) const;
  [[noreturn]] void fail(std::string_view what) const;

 private:
  template <class T>
  std::vector<T> values(const std::string& path, std::int64_t type) const;
  void check_size(std::int64_t dataset, const std::string& path, std::uint64_t count) const;

  std::string name_;
  RunContext context_;
  std::uint64_t file_bytes_ = 0;
  std::int64_t file_ = -1;
};

}  // namespace octafront::io
