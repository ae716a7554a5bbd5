// NIfTI-1 and NIfTI-2, one file or .hdr with .img, compressed or not, either byte order; and Analyze 7.5, which NIfTI-1
// grew from. https://nifti.nimh.nih.gov/nifti-1, https://nifti.nimh.nih.gov/nifti-2

#include "formats/containers/scanner.h"
#include "images/files/byte_source.h"
#include "images/files/image_readers.h"
#include "images/files/voxels.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>

#include <fmt/core.h>

namespace octafront::image {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t kHeader1 = 348, kHeader2 = 540;

/// Fields of a header by their offsets, in the byte order of the file.
class Fields {
 public:
  Fields(std::string_view bytes, bool big_endian) : bytes_(bytes), big_endian_(big_endian) {}

  template <class T>
  T get(std::size_t offset) const {
    char raw[sizeof(T)];
    std::memcpy(raw, bytes_.data() + offset, sizeof(T));
    if (big_endian_) std::reverse(raw, raw + sizeof(T));
    return std::bit_cast<T>(raw);
  }
  std::string_view text(std::size_t offset, std::size_t size) const { return bytes_.substr(offset, size); }

 private:
  std::string_view bytes_;
  bool big_endian_;
};

/// Indices to the world.
struct Affine {
  std::array<Vec3, 3> axes;
  Vec3 origin;
  Vec3 operator()(Vec3 p) const { return origin + axes[0] * p.x + axes[1] * p.y + axes[2] * p.z; }
};

/// What both versions say, in wide types.
struct Header {
  std::string format;
  bool big_endian = false, is_analyze = false, is_pair = false;
  std::array<std::int64_t, 8> dim{};
  int datatype = 0;
  std::array<double, 8> pixdim{};
  double vox_offset = 0, slope = 0, intercept = 0;
  int xyzt_units = 0, qform_code = 0, sform_code = 0;
  std::array<double, 3> quaternion{}, offset{};
  std::array<std::array<double, 4>, 3> srow{};
};

template <class Dim, class Real>
void read_dimensions(const Fields& f, std::size_t dim, std::size_t pixdim, Header& h) {
  for (std::size_t i = 0; i < 8; ++i) {
    h.dim[i] = f.get<Dim>(dim + i * sizeof(Dim));
    h.pixdim[i] = f.get<Real>(pixdim + i * sizeof(Real));
  }
}

template <class Real>
void read_placement(const Fields& f, std::size_t quaternion, std::size_t srow, Header& h) {
  for (std::size_t i = 0; i < 3; ++i) {
    h.quaternion[i] = f.get<Real>(quaternion + i * sizeof(Real));
    h.offset[i] = f.get<Real>(quaternion + (3 + i) * sizeof(Real));
    for (std::size_t k = 0; k < 4; ++k) h.srow[i][k] = f.get<Real>(srow + (4 * i + k) * sizeof(Real));
  }
}

Header header_1(const Fields& f) {
  Header h;
  const std::string_view magic = f.text(344, 4);
  h.is_pair = magic != "n+1\0"sv;
  h.is_analyze = h.is_pair && magic != "ni1\0"sv;
  h.format = h.is_analyze ? "Analyze 7.5" : "NIfTI-1";
  read_dimensions<std::int16_t, float>(f, 40, 76, h);
  h.datatype = f.get<std::int16_t>(70);
  h.vox_offset = f.get<float>(108);
  if (h.is_analyze) return h;
  h.slope = f.get<float>(112);
  h.intercept = f.get<float>(116);
  h.xyzt_units = f.get<std::uint8_t>(123);
  h.qform_code = f.get<std::int16_t>(252);
  h.sform_code = f.get<std::int16_t>(254);
  read_placement<float>(f, 256, 280, h);
  return h;
}

Header header_2(const Fields& f) {
  Header h;
  h.format = "NIfTI-2";
  h.is_pair = f.text(4, 4) != "n+2\0"sv;
  h.datatype = f.get<std::int16_t>(12);
  read_dimensions<std::int64_t, double>(f, 16, 104, h);
  h.vox_offset = static_cast<double>(f.get<std::int64_t>(168));
  h.slope = f.get<double>(176);
  h.intercept = f.get<double>(184);
  h.qform_code = f.get<std::int32_t>(344);
  h.sform_code = f.get<std::int32_t>(348);
  read_placement<double>(f, 352, 400, h);
  h.xyzt_units = f.get<std::int32_t>(500);
  return h;
}

std::optional<VoxelType> type_of_nifti(int datatype) {
  static const std::map<int, VoxelType> kTypes{
      {2, VoxelType::kUInt8},    {4, VoxelType::kInt16},    {8, VoxelType::kInt32},    {16, VoxelType::kFloat32},
      {64, VoxelType::kFloat64}, {256, VoxelType::kInt8},   {512, VoxelType::kUInt16}, {768, VoxelType::kUInt32},
      {1024, VoxelType::kInt64}, {1280, VoxelType::kUInt64}};
  const auto found = kTypes.find(datatype);
  return found == kTypes.end() ? std::nullopt : std::optional(found->second);
}

std::string name_of_other_type(int datatype) {
  switch (datatype) {
    case 1:
      return "single bits";
    case 32:
    case 1792:
    case 2048:
      return "complex numbers";
    case 128:
    case 2304:
      return "colours";
    case 1536:
      return "numbers of 128 bits";
    default:
      return fmt::format("the unknown type {}", datatype);
  }
}

/// Which byte order and version, by the size that the header says it has.
std::optional<Header> header_of(std::string_view bytes) {
  for (const bool big : {false, true}) {
    const Fields f(bytes, big);
    const auto size = f.get<std::int32_t>(0);
    std::optional<Header> h;
    if (size == static_cast<std::int32_t>(kHeader1) && bytes.size() >= kHeader1) h = header_1(f);
    if (size == static_cast<std::int32_t>(kHeader2) && bytes.size() >= kHeader2) h = header_2(f);
    if (!h) continue;
    h->big_endian = big;
    return h;
  }
  return std::nullopt;
}

Affine by_spacing(const Header& h) {
  Affine a;
  for (std::size_t i = 0; i < 3; ++i) {
    a.axes[i] = {};
    a.axes[i][static_cast<int>(i)] = std::abs(h.pixdim[i + 1]);
  }
  return a;
}

/// Rotation by a unit quaternion, of which the header has three parts, and spacing; pixdim[0] = -1 turns the last axis.
Affine by_quaternion(const Header& h) {
  auto [b, c, d] = h.quaternion;
  double a = 1 - (b * b + c * c + d * d);
  if (a < 1e-7) {  // as the reference implementation does: half a turn, where rounding may leave a above 1
    const double scale = 1 / std::sqrt(b * b + c * c + d * d);
    b *= scale, c *= scale, d *= scale;
    a = 0;
  } else {
    a = std::sqrt(a);
  }
  const double turn = h.pixdim[0] < 0 ? -1 : 1;
  Affine out = by_spacing(h);
  const double x = out.axes[0].x, y = out.axes[1].y, z = turn * out.axes[2].z;
  out.axes[0] = Vec3{a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)} * x;
  out.axes[1] = Vec3{2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)} * y;
  out.axes[2] = Vec3{2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - c * c - b * b} * z;
  out.origin = {h.offset[0], h.offset[1], h.offset[2]};
  return out;
}

Affine by_rows(const Header& h) {
  Affine a;
  for (std::size_t k = 0; k < 3; ++k) a.axes[k] = {h.srow[0][k], h.srow[1][k], h.srow[2][k]};
  a.origin = {h.srow[0][3], h.srow[1][3], h.srow[2][3]};
  return a;
}

bool is_invertible(const Affine& a) {
  const double volume = dot(cross(a.axes[0], a.axes[1]), a.axes[2]);
  return std::isfinite(volume) && volume != 0 && is_finite(a.origin);
}

/// How far apart two maps put the corners of a grid, in voxels.
double disagreement(const Affine& a, const Affine& b, const std::array<std::uint32_t, 3>& size) {
  const double voxel = std::min({length(a.axes[0]), length(a.axes[1]), length(a.axes[2])});
  double most = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const auto at = [&](unsigned axis) { return (corner >> axis & 1) != 0 ? size[axis] - 1.0 : 0.0; };
    const Vec3 p{at(0), at(1), at(2)};
    most = std::max(most, distance(a(p), b(p)) / voxel);
  }
  return most;
}

class Nifti {
 public:
  explicit Nifti(const Reading& reading)
      : reading_(reading), input_(reading.input), source_(input_, 0, Packing::kDetect) {}

  Image read() {
    read_header();
    image_.grid.size = checked_sizes(input_, {dimension(1), dimension(2), dimension(3)});
    place();
    image_.format = header_.format + (source_.is_packed() ? ", compressed" : "") + placed_by_;
    image_.unit = unit();
    check_grid(input_, image_.grid);
    read_values();
    return std::move(image_);
  }

 private:
  void read_header() {
    constexpr std::string_view kHeader = "the NIfTI header";
    std::string bytes(source_.require(kHeader1, kHeader));
    const auto size = Fields(bytes, false).get<std::int32_t>(0);
    constexpr std::int32_t kTurned2 = 0x1c020000;  // 540 in the other byte order
    if (size == static_cast<std::int32_t>(kHeader2) || size == kTurned2)
      bytes += source_.require(kHeader2 - kHeader1, kHeader);
    header_bytes_ = bytes.size();
    const std::optional<Header> found = header_of(bytes);
    if (!found) input_.fail("does not begin with the size of a NIfTI header (348 or 540); the file is damaged");
    header_ = *found;
    if (header_.dim[0] < 1 || header_.dim[0] > 7)
      input_.fail(fmt::format("claims {} dimensions; the file is damaged: export it again", header_.dim[0]));
    if (header_.dim[0] < 3) fail_flat(input_);
  }

  std::int64_t dimension(std::size_t i) const {
    return static_cast<std::int64_t>(i) <= header_.dim[0] ? header_.dim[i] : 1;
  }

  void take(const Affine& a, const char* by) {
    image_.grid.axes = a.axes;
    image_.grid.origin = a.origin;
    image_.frame = "RAS";
    placed_by_ = by;
  }

  // sform where there is one, else qform, else spacing alone: as the standard's authors advise.
  void place() {
    for (std::size_t i = 1; i <= 3; ++i) {
      if (header_.pixdim[i] != 0 || header_.dim[0] < static_cast<std::int64_t>(i)) continue;
      note(fmt::format("the header has no spacing along axis {}; 1 is taken", i - 1));
      header_.pixdim[i] = 1;
    }
    for (std::size_t i = 1; i <= 3; ++i)
      if (header_.pixdim[i] == 0) header_.pixdim[i] = 1;
    const Affine rows = by_rows(header_), quaternion = by_quaternion(header_);
    const bool has_rows = header_.sform_code > 0 && is_invertible(rows);
    const bool has_quaternion = header_.qform_code > 0 && is_invertible(quaternion);
    if (header_.sform_code > 0 && !has_rows) note("its sform is no invertible map and is passed over");
    if (!has_rows) note_negative_spacing();
    if (has_rows) {
      take(rows, ", placed by its sform");
      if (has_quaternion) compare(rows, quaternion);
    } else if (has_quaternion) {
      take(quaternion, ", placed by its qform");
    } else {
      take(by_spacing(header_), "");
      image_.frame = "";
      note("the header does not say where the voxels lie: they begin at 0, by their spacing alone");
    }
  }

  /// What counts where there are no rows: the lengths of the steps; only a map of the header may turn them.
  void note_negative_spacing() {
    for (std::size_t i = 1; i <= 3; ++i)
      if (header_.pixdim[i] < 0)
        note(fmt::format("the header's spacing along axis {} is {:.6g}, below 0; its amount is taken", i - 1,
                         header_.pixdim[i]));
  }

  void compare(const Affine& rows, const Affine& quaternion) {
    // A quality bound: what both say with single precision agrees to less.
    constexpr double kSame = 1e-3;
    const double most = disagreement(rows, quaternion, image_.grid.size);
    if (most <= kSame) return;
    note(
        fmt::format("sform (code {}) and qform (code {}) of the header disagree by up to {:.4g} voxels; the sform is "
                    "taken",
                    header_.sform_code, header_.qform_code, most));
  }

  std::string unit() const {
    constexpr int kUnitsOfSpace = 7;
    const int code = header_.xyzt_units & kUnitsOfSpace;
    return code == 1 ? "m" : code == 2 ? "mm" : code == 3 ? "um" : "";
  }

  StoredVoxels stored() const {
    const std::optional<VoxelType> type = type_of_nifti(header_.datatype);
    if (!type)
      input_.fail(fmt::format("holds {}, not one number per voxel; convert it to a scalar image first",
                              name_of_other_type(header_.datatype)));
    StoredVoxels s{*type, header_.big_endian, 1, 0};
    // A slope of 0 says that values are not scaled.
    if (header_.slope != 0 && std::isfinite(header_.slope) && std::isfinite(header_.intercept)) {
      s.slope = header_.slope;
      s.intercept = header_.intercept;
    }
    return s;
  }

  /// Volumes behind one another: times, directions, components.
  std::uint64_t volumes() const {
    std::uint64_t n = 1;
    for (std::size_t i = 4; i <= 7; ++i) {
      const std::int64_t d = dimension(i);
      if (d < 1 || n * static_cast<std::uint64_t>(d) > 0xffffffffu)
        input_.fail(fmt::format("claims {} along dimension {}; the file is damaged: export it again", d, i));
      n *= static_cast<std::uint64_t>(d);
    }
    return n;
  }

  void read_values() {
    const StoredVoxels how = stored();
    const std::uint32_t volume = chosen_series(reading_, volumes(), "volumes");
    const std::uint64_t before = std::uint64_t{volume} * image_.grid.voxels() * bytes_of(how.type);
    if (!header_.is_pair) {
      if (!(header_.vox_offset >= static_cast<double>(header_bytes_)) || header_.vox_offset > 1e15)
        input_.fail(fmt::format("claims that its voxels begin at byte {}; the file is damaged: export it again",
                                header_.vox_offset));
      read_extensions(static_cast<std::uint64_t>(header_.vox_offset) - header_bytes_);
      source_.skip(before, "the voxels");
      image_.values = read_voxels(source_, image_.grid.size, how, image_.notes);
      source_.check_end();
      return;
    }
    const KeptFile data = reading_.beside(name_of_voxels());
    ByteSource voxels(data.input, 0, Packing::kDetect);
    const double offset = header_.vox_offset;
    voxels.skip((offset > 0 && offset < 1e15 ? static_cast<std::uint64_t>(offset) : 0) + before, "the voxels");
    image_.values = read_voxels(voxels, image_.grid.size, how, image_.notes);
    voxels.check_end();
  }

  /// What lies between the header and the voxels: TotalSegmentator keeps the names of its labels there, as Caret does.
  void read_extensions(std::uint64_t bytes) {
    constexpr std::uint64_t kMost = 1 << 22;
    if (bytes > kMost) return source_.skip(bytes, "the voxels");
    const std::string text(source_.require(bytes, "the voxels"));
    constexpr std::string_view kKey = "Key=\"", kLabel = "<Label ", kEnd = "</Label>", kOpen = "<![CDATA[",
                               kClose = "]]>";
    for (std::size_t at = text.find(kLabel); at != std::string::npos; at = text.find(kLabel, at + 1)) {
      const std::size_t end = text.find(kEnd, at), name = text.find('>', at), key = text.find(kKey, at);
      if (end == std::string::npos || name >= end || key >= name) continue;
      std::string_view words = io::trimmed(std::string_view(text).substr(name + 1, end - name - 1));
      if (words.starts_with(kOpen) && words.ends_with(kClose))
        words = words.substr(kOpen.size(), words.size() - kOpen.size() - kClose.size());
      const std::size_t digits = key + kKey.size();
      double value = 0;
      if (io::parse_number(std::string_view(text).substr(digits, text.find('"', digits) - digits), value) &&
          value == std::floor(value) && std::abs(value) < 1e15 && !words.empty())
        image_.names.push_back({static_cast<std::int64_t>(value), std::string(words)});
    }
  }

  /// head.hdr: head.img; head.hdr.gz: head.img.gz.
  std::string name_of_voxels() const {
    std::filesystem::path name = std::filesystem::path(input_.name).filename();
    const bool is_compressed = name.extension() == ".gz";
    if (is_compressed) name.replace_extension();
    return name.replace_extension(name.extension() == ".HDR" ? ".IMG" : ".img").string() + (is_compressed ? ".gz" : "");
  }

  void note(std::string_view sentence) { image_.notes.emplace_back(sentence); }

  const Reading& reading_;
  const io::Input& input_;
  ByteSource source_;
  Header header_;
  std::size_t header_bytes_ = 0;
  std::string placed_by_;
  Image image_;
};

}  // namespace

bool is_nifti(std::string_view head) {
  if (head.size() < kHeader1) return false;
  const std::optional<Header> h = header_of(head);
  // Analyze has no magic word: its extent and a possible type must do.
  return h && h->dim[0] >= 1 && h->dim[0] <= 7 && (!h->is_analyze || type_of_nifti(h->datatype));
}

Image read_nifti(const Reading& reading) {
  return Nifti(reading).read();
}

}  // namespace octafront::image
