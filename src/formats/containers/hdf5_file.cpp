#include "formats/containers/hdf5_file.h"

#include <octafront/error.h>
#include <octafront/limits.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <system_error>
#include <type_traits>
#include <utility>

#include <fmt/core.h>
#include <hdf5.h>

namespace octafront::io {
namespace {

static_assert(std::is_same_v<hid_t, std::int64_t>);

/// An identifier of the library, released at the end.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  hid_t get() const { return id_; }
  bool valid() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// How datasets are made: without the time, so that the same mesh gives the same bytes.
Handle timeless_dataset() {
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_obj_track_times(creation, 0);
  return {creation, H5Pclose};
}

template <class T>
hid_t native_type() {
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, float>) return H5T_NATIVE_FLOAT;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5T_NATIVE_INT32;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5T_NATIVE_INT64;
  if constexpr (std::is_same_v<T, std::int8_t>) return H5T_NATIVE_INT8;
  if constexpr (std::is_same_v<T, std::uint8_t>) return H5T_NATIVE_UINT8;
}

/// Our own messages say what is wrong. And the library must not clean up when the program ends: it would try once more
/// to flush a file that did not fit on the disk, and crash. Whoever closes his files, as we do, needs no such help.
void prepare_library() {
  static const bool kOnce = [] { return H5dont_atexit() >= 0; }();
  static_cast<void>(kOnce);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

/// The innermost reason that the library gives.
std::string hdf5_reason() {
  std::string text;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_DOWNWARD,
      [](unsigned, const H5E_error2_t* error, void* to) -> herr_t {
        if (error->desc != nullptr && *error->desc != '\0') *static_cast<std::string*>(to) = error->desc;
        return 0;
      },
      &text);
  // What the system said stands in the middle of it.
  constexpr std::string_view kErrno = "errno = ";
  if (const std::size_t at = text.find(kErrno); at != std::string::npos)
    return std::generic_category().message(std::atoi(text.c_str() + at + kErrno.size()));
  return text.empty() ? "HDF5 does not say why" : text;
}

}  // namespace

Hdf5Writer::Hdf5Writer(const std::filesystem::path& file, std::string target, RunContext context, bool ordered)
    : target_(std::move(target)), context_(std::move(context)), ordered_(ordered) {
  prepare_library();
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  if (ordered) H5Pset_link_creation_order(creation.get(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  // Through stdio: the library's default driver asks for the real path of links, and a nameless file has none.
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_stdio(access.get());
  file_ = check(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), "cannot be created");
}

Hdf5Writer::~Hdf5Writer() {
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5Writer::fail(std::string_view what) const {
  throw OutputError(fmt::format("{}: {}: {}; an older file of this name is unchanged", target_, what, hdf5_reason()));
}

std::int64_t Hdf5Writer::check(std::int64_t id, std::string_view what) const {
  if (id < 0) fail(what);
  return id;
}

void Hdf5Writer::group(const std::string& path) {
  const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  if (ordered_) H5Pset_link_creation_order(creation.get(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  const Handle made(H5Gcreate2(file_, path.c_str(), H5P_DEFAULT, creation.get(), H5P_DEFAULT), H5Gclose);
  check(made.get(), "cannot be written");
}

template <class T>
void Hdf5Writer::put_attribute(const std::string& of, const std::string& name, std::int64_t type, const T* values,
                               std::size_t count) {
  const hsize_t size = count;
  const Handle object(check(H5Oopen(file_, of.c_str(), H5P_DEFAULT), "cannot be written"), H5Oclose);
  const Handle space(count == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Handle attribute(H5Acreate2(object.get(), name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  check(attribute.get(), "cannot be written");
  if (H5Awrite(attribute.get(), type, values) < 0) fail("cannot be written");
}

void Hdf5Writer::attribute(const std::string& of, const std::string& name, std::int32_t value) {
  put_attribute(of, name, H5T_NATIVE_INT32, &value, 0);
}
void Hdf5Writer::attribute(const std::string& of, const std::string& name, double value) {
  put_attribute(of, name, H5T_NATIVE_DOUBLE, &value, 0);
}
void Hdf5Writer::attribute(const std::string& of, const std::string& name, const std::vector<std::int32_t>& values) {
  put_attribute(of, name, H5T_NATIVE_INT32, values.data(), values.size());
}
void Hdf5Writer::attribute(const std::string& of, const std::string& name, std::string_view text, std::size_t size) {
  std::string padded(text);
  padded.resize(size == 0 ? text.size() + 1 : size, '\0');
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), padded.size());
  put_attribute(of, name, type.get(), padded.data(), 0);
}

template <class T>
void Hdf5Writer::rows(const std::string& path, const std::vector<std::uint64_t>& shape, Stretch stretch,
                      const Fill<T>& fill) {
  const std::vector<hsize_t> dimensions(shape.begin(), shape.end());
  const Handle space(H5Screate_simple(static_cast<int>(dimensions.size()), dimensions.data(), nullptr), H5Sclose);
  const Handle timeless = timeless_dataset();
  const bool is_there = H5Lexists(file_, path.c_str(), H5P_DEFAULT) > 0;
  const Handle set(is_there ? H5Dopen2(file_, path.c_str(), H5P_DEFAULT)
                            : H5Dcreate2(file_, path.c_str(), native_type<T>(), space.get(), H5P_DEFAULT,
                                         timeless.get(), H5P_DEFAULT),
                   H5Dclose);
  check(set.get(), "cannot be written");
  // Whole rows at a time.
  std::uint64_t per_row = 1;
  for (std::size_t d = 1; d < shape.size(); ++d) per_row *= shape[d];
  constexpr std::uint64_t kBlock = std::uint64_t{1} << 17;
  const std::uint64_t at_once = std::max<std::uint64_t>(1, kBlock / std::max<std::uint64_t>(1, per_row));
  std::vector<T> block;
  std::vector<hsize_t> start(shape.size(), 0), count(dimensions);
  for (std::uint64_t row = 0; row < stretch.rows && per_row > 0; row += at_once) {
    context_.check();
    start[0] = stretch.begin + row;
    count[0] = std::min(at_once, stretch.rows - row);
    block.resize(count[0] * per_row);
    fill(row * per_row, block);
    const Handle memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose);
    if (H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) < 0 ||
        H5Dwrite(set.get(), native_type<T>(), memory.get(), space.get(), H5P_DEFAULT, block.data()) < 0)
      fail("cannot be written");
  }
}

template void Hdf5Writer::rows(const std::string&, const std::vector<std::uint64_t>&, Stretch, const Fill<double>&);
template void Hdf5Writer::rows(const std::string&, const std::vector<std::uint64_t>&, Stretch, const Fill<float>&);
template void Hdf5Writer::rows(const std::string&, const std::vector<std::uint64_t>&, Stretch,
                               const Fill<std::int32_t>&);
template void Hdf5Writer::rows(const std::string&, const std::vector<std::uint64_t>&, Stretch,
                               const Fill<std::int64_t>&);
template void Hdf5Writer::rows(const std::string&, const std::vector<std::uint64_t>&, Stretch,
                               const Fill<std::int8_t>&);
template void Hdf5Writer::rows(const std::string&, const std::vector<std::uint64_t>&, Stretch,
                               const Fill<std::uint8_t>&);

void Hdf5Writer::texts(const std::string& path, const std::vector<std::string>& rows, std::size_t length) {
  std::string all;
  for (std::string row : rows) {
    row.resize(length, '\0');
    all += row;
  }
  const hsize_t size = length, count = rows.size();
  const Handle type(H5Tarray_create2(H5T_NATIVE_INT8, 1, &size), H5Tclose);
  const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Handle timeless = timeless_dataset();
  const Handle set(H5Dcreate2(file_, path.c_str(), type.get(), space.get(), H5P_DEFAULT, timeless.get(), H5P_DEFAULT),
                   H5Dclose);
  check(set.get(), "cannot be written");
  if (H5Dwrite(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()) < 0) fail("cannot be written");
}

void Hdf5Writer::close() {
  context_.check();
  const std::int64_t closing = std::exchange(file_, -1);
  const bool flushed = H5Fflush(closing, H5F_SCOPE_GLOBAL) >= 0;
  const std::string why = flushed ? std::string() : hdf5_reason();
  if (H5Fclose(closing) < 0 || !flushed)
    throw OutputError(fmt::format("{}: cannot be written: {}; an older file of this name is unchanged", target_, why));
}

Hdf5Reader::Hdf5Reader(const std::filesystem::path& file, std::string name, RunContext context)
    : name_(std::move(name)), context_(std::move(context)) {
  prepare_library();
  require_in_folders(file.string());
  std::error_code error;
  file_bytes_ = std::filesystem::file_size(file, error);
  if (error) fail(fmt::format("{} cannot be opened: {}", file.string(), error.message()));
  file_ = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file_ < 0) fail(fmt::format("{} cannot be opened as HDF5: {}", file.string(), hdf5_reason()));
}

Hdf5Reader::~Hdf5Reader() {
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5Reader::fail(std::string_view what) const {
  throw InputError(fmt::format("{}: {}", name_, what));
}

namespace {

/// How links are followed: not to other files, for a link could lead to any.
class OwnLinks : public Handle {
 public:
  explicit OwnLinks(hid_t of_class) : Handle(H5Pcreate(of_class), H5Pclose) {
    H5Pset_elink_cb(
        get(), [](const char*, const char*, const char*, const char*, unsigned*, hid_t, void*) -> herr_t { return -1; },
        nullptr);
  }
};

/// Values that lie in other files could be anybody's.
void require_own_values(const Hdf5Reader& reader, std::int64_t dataset, const std::string& path) {
  const Handle how(H5Dget_create_plist(dataset), H5Pclose);
  if (H5Pget_external_count(how.get()) > 0 || H5Pget_layout(how.get()) == H5D_VIRTUAL)
    reader.fail(fmt::format("the values of {} lie in other files; copy them into this one (h5repack)", path));
}

}  // namespace

bool Hdf5Reader::has(const std::string& path) const {
  const OwnLinks links(H5P_LINK_ACCESS);
  // Each part of the path must be there before the next one can be asked for.
  for (std::size_t at = path.find('/', 1);; at = path.find('/', at + 1)) {
    const std::string part = path.substr(0, at);
    if (part != "/" && H5Lexists(file_, part.c_str(), links.get()) <= 0) return false;
    if (at == std::string::npos) return true;
  }
}

std::vector<std::string> Hdf5Reader::members(const std::string& path) const {
  std::vector<std::string> names;
  if (!has(path)) return names;
  const Handle group(H5Gopen2(file_, path.c_str(), OwnLinks(H5P_GROUP_ACCESS).get()), H5Gclose);
  if (!group.valid()) return names;
  H5Literate(
      group.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t, const char* name, const H5L_info_t*, void* to) -> herr_t {
        static_cast<std::vector<std::string>*>(to)->emplace_back(name);
        return 0;
      },
      &names);
  return names;
}

std::vector<std::uint64_t> Hdf5Reader::shape(const std::string& path) const {
  if (!has(path)) fail(fmt::format("has no {}; the file is damaged: export it again", path));
  const Handle set(H5Dopen2(file_, path.c_str(), OwnLinks(H5P_DATASET_ACCESS).get()), H5Dclose);
  if (!set.valid()) fail(fmt::format("{} holds no values (links to other files are not followed)", path));
  const Handle space(H5Dget_space(set.get()), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space.get());
  constexpr int kMostRank = 32;
  if (rank < 0 || rank > kMostRank) fail(fmt::format("{} has no shape", path));
  std::array<hsize_t, kMostRank> dimensions{};
  H5Sget_simple_extent_dims(space.get(), dimensions.data(), nullptr);
  return {dimensions.begin(), dimensions.begin() + rank};
}

/// A few kilobytes may claim, or unpack to, gigabytes.
void Hdf5Reader::check_size(std::int64_t dataset, const std::string& path, std::uint64_t count) const {
  constexpr std::uint64_t kBestRatio = 1032, kAlways = 4096;  // of deflate
  require_own_values(*this, dataset, path);
  const std::uint64_t stored = H5Dget_storage_size(dataset);
  if (stored > file_bytes_) fail(fmt::format("{} claims {} bytes, more than the file has", path, stored));
  if (count > kBestRatio * stored + kAlways)
    fail(fmt::format("{} claims {} values in {} bytes; the file is damaged", path, count, stored));
}

template <class T>
std::vector<T> Hdf5Reader::values(const std::string& path, std::int64_t type) const {
  std::uint64_t count = 1;
  for (const std::uint64_t n : shape(path)) {
    if (n != 0 && count > std::numeric_limits<std::uint64_t>::max() / 64 / n)
      fail(fmt::format("{} is too large", path));
    count *= n;
  }
  context_.check();
  const Handle set(H5Dopen2(file_, path.c_str(), OwnLinks(H5P_DATASET_ACCESS).get()), H5Dclose);
  check_size(set.get(), path, count);
  std::vector<T> all(count);
  if (count > 0 && H5Dread(set.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()) < 0)
    fail(fmt::format("{} cannot be read: {}", path, hdf5_reason()));
  return all;
}

std::vector<double> Hdf5Reader::reals(const std::string& path) const {
  return values<double>(path, H5T_NATIVE_DOUBLE);
}
std::vector<std::int64_t> Hdf5Reader::integers(const std::string& path) const {
  return values<std::int64_t>(path, H5T_NATIVE_INT64);
}

std::string Hdf5Reader::bytes(const std::string& path) const {
  const std::vector<std::uint64_t> extent = shape(path);
  std::uint64_t count = 1;
  for (const std::uint64_t n : extent) count *= std::min<std::uint64_t>(n, std::uint64_t{1} << 20);
  const Handle set(H5Dopen2(file_, path.c_str(), OwnLinks(H5P_DATASET_ACCESS).get()), H5Dclose);
  const Handle type(H5Dget_type(set.get()), H5Tclose);
  const std::size_t each = H5Tget_size(type.get());
  constexpr std::uint64_t kMost = std::uint64_t{1} << 26;  // names
  if (count * each > kMost) fail(fmt::format("{} is too large for names", path));
  check_size(set.get(), path, count);
  std::string all(count * each, '\0');
  if (!all.empty() && H5Dread(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()) < 0)
    fail(fmt::format("{} cannot be read: {}", path, hdf5_reason()));
  return all;
}

std::int64_t Hdf5Reader::integer_attribute(const std::string& of, const std::string& name) const {
  const Handle object(H5Oopen(file_, of.c_str(), OwnLinks(H5P_LINK_ACCESS).get()), H5Oclose);
  const Handle attribute(H5Aopen(object.get(), name.c_str(), H5P_DEFAULT), H5Aclose);
  std::int64_t value = 0;
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  if (!attribute.valid() || H5Sget_simple_extent_npoints(space.get()) != 1 ||
      H5Aread(attribute.get(), H5T_NATIVE_INT64, &value) < 0)
    fail(fmt::format("{} has no number {}; the file is damaged: export it again", of, name));
  return value;
}

}  // namespace octafront::io
