#include "small_images.h"

#include <octafront/error.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

namespace octafront::testing {

namespace {

class Bytes {
 public:
  Bytes(std::size_t size, bool big_endian) : bytes_(size, '\0'), big_endian_(big_endian) {}
  template <class T>
  void set(std::size_t at, double value) {
    const std::string one = raw(std::vector<T>{static_cast<T>(value)}, big_endian_);
    bytes_.replace(at, one.size(), one);
  }
  void set(std::size_t at, const std::string& text) { bytes_.replace(at, text.size(), text); }
  const std::string& get() const { return bytes_; }

 private:
  std::string bytes_;
  bool big_endian_;
};

std::string deflated(const std::string& bytes, int window) {
  z_stream z{};
  deflateInit2(&z, 6, Z_DEFLATED, window, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&z, bytes.size()) + 32, '\0');
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  z.avail_in = static_cast<uInt>(bytes.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = static_cast<uInt>(out.size());
  deflate(&z, Z_FINISH);
  out.resize(z.total_out);
  deflateEnd(&z);
  return out;
}

ImageGrid sheared_grid() {
  ImageGrid g;
  g.size = {5, 4, 3};
  g.axes = {{{-0.5, 0, 0}, {0, 0.75, 0.25}, {0, 0.5, 2}}};
  g.origin = {10, -20, 30};
  return g;
}

std::string nrrd_head(const std::string& encoding) {
  return "NRRD0004\n# a comment\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: 5 4 3\n"
         "space directions: (-0.5,0,0) (0,0.75,0.25) (0,0.5,2)\nspace origin: (10,-20,30)\nspace units: \"mm\" \"mm\" "
         "\"mm\"\nkinds: domain domain domain\nencoding: " +
         encoding + "\n";
}

std::string meta_head(const std::string& more, const std::string& file) {
  // Directions of length one, and their lengths apart.
  const ImageGrid g = sheared_grid();
  std::string matrix, spacing;
  for (const Vec3& a : g.axes) {
    const double l = length(a);
    matrix += fmt::format(" {:.17g} {:.17g} {:.17g}", a.x / l, a.y / l, a.z / l);
    spacing += fmt::format(" {:.17g}", l);
  }
  return "ObjectType = Image\nNDims = 3\n" + more + "TransformMatrix =" + matrix +
         "\nOffset = 10 -20 30\nElementSpacing =" + spacing +
         "\nDimSize = 5 4 3\nElementType = MET_SHORT\nElementDataFile = " + file + "\n";
}

std::string text_of_values() {
  std::string text;
  for (const std::int16_t v : sample_values()) text += fmt::format("{}\n", v);
  return text;
}

}  // namespace

std::vector<std::int16_t> sample_values() {
  std::vector<std::int16_t> values;
  for (int n = 0; n < 60; ++n) values.push_back(static_cast<std::int16_t>(n * 7 - 20));
  return values;
}

Image sample_image() {
  Image image;
  image.grid = sheared_grid();
  image.values = sample_values();
  return image;
}

std::string gzip(const std::string& bytes) {
  return deflated(bytes, 15 + 16);
}
std::string zlib(const std::string& bytes) {
  return deflated(bytes, 15);
}

std::string Nifti::header() const {
  const std::size_t size = version == 1 ? 348 : 540;
  Bytes b(size + (is_pair ? 0 : 4), big_endian);
  b.set<std::int32_t>(0, static_cast<double>(size));
  const double first = offset > 0 ? offset : is_pair ? 0.0 : static_cast<double>(size) + 4;
  const auto common = [&]<class Dim, class Real>(Dim, Real, std::size_t dims, std::size_t pix, std::size_t vox,
                                                 std::size_t scale, std::size_t quat, std::size_t srow) {
    for (std::size_t i = 0; i < 8; ++i) {
      b.set<Dim>(dims + i * sizeof(Dim), static_cast<double>(dim[i]));
      b.set<Real>(pix + i * sizeof(Real), pixdim[i]);
    }
    b.set<std::conditional_t<std::is_same_v<Real, double>, std::int64_t, float>>(vox, first);
    b.set<Real>(scale, slope);
    b.set<Real>(scale + sizeof(Real), intercept);
    for (std::size_t i = 0; i < 6; ++i) b.set<Real>(quat + i * sizeof(Real), quaternion[i]);
    for (std::size_t i = 0; i < 12; ++i) b.set<Real>(srow + i * sizeof(Real), rows[i / 4][i % 4]);
  };
  if (version == 1) {
    common(std::int16_t{}, float{}, 40, 76, 108, 112, 256, 280);
    b.set<std::int16_t>(70, datatype);
    b.set<std::uint8_t>(123, units);
    b.set<std::int16_t>(252, qform_code);
    b.set<std::int16_t>(254, sform_code);
    b.set(344, is_pair ? std::string("ni1\0", 4) : std::string("n+1\0", 4));
  } else {
    b.set(4, is_pair ? std::string("ni2\0\r\n\x1a\n", 8) : std::string("n+2\0\r\n\x1a\n", 8));
    common(std::int64_t{}, double{}, 16, 104, 168, 176, 352, 400);
    b.set<std::int16_t>(12, datatype);
    b.set<std::int32_t>(344, qform_code);
    b.set<std::int32_t>(348, sform_code);
    b.set<std::int32_t>(500, units);
  }
  return b.get();
}

namespace {

Nifti sheared_nifti(int version, bool big_endian) {
  Nifti n;
  n.version = version;
  n.big_endian = big_endian;
  n.sform_code = 1;
  const ImageGrid g = sheared_grid();
  for (int r = 0; r < 3; ++r) {
    for (int a = 0; a < 3; ++a)
      n.rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(a)] = g.axes[static_cast<std::size_t>(a)][r];
    n.rows[static_cast<std::size_t>(r)][3] = g.origin[r];
  }
  n.voxels = raw(sample_values(), big_endian);
  return n;
}

std::string slice_bytes(std::size_t k) {
  const std::vector<std::int16_t> all = sample_values();
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(20 * k);
  return raw(std::vector<std::int16_t>(begin, begin + 20));
}

}  // namespace

std::vector<SmallImage> sheared_images() {
  const std::string little = raw(sample_values()), big = raw(sample_values(), true);
  const std::map<std::string, std::string> slices{
      {"s1.raw", slice_bytes(0)}, {"s2.raw", slice_bytes(1)}, {"s3.raw", slice_bytes(2)}};
  std::vector<SmallImage> all;
  for (const int version : {1, 2})
    for (const bool is_big : {false, true}) {
      Nifti n = sheared_nifti(version, is_big);
      const std::string name = fmt::format("v{}{}", version, is_big ? "big" : "");
      all.push_back({name + ".nii", n.bytes()});
      n.is_pair = true;
      all.push_back({name + ".hdr", n.header(), {{name + ".img", n.voxels}}});
    }
  all.push_back({"a.nii.gz", gzip(sheared_nifti(1, false).bytes())});
  Nifti pair = sheared_nifti(1, false);
  pair.is_pair = true;
  all.push_back({"p.hdr.gz", gzip(pair.header()), {{"p.img.gz", gzip(pair.voxels)}}});

  all.push_back({"a.nrrd", nrrd_head("raw") + "endian: little\n\n" + little});
  all.push_back({"b.nrrd", nrrd_head("raw") + "endian: big\n\n" + big});
  all.push_back({"c.nrrd", nrrd_head("gzip") + "endian: little\nkey:=value\n\n" + gzip(little)});
  all.push_back({"d.nrrd", nrrd_head("ascii") + "\n" + text_of_values()});
  all.push_back(
      {"e.nhdr", nrrd_head("raw") + "endian: little\nbyte skip: 3\ndata file: e.raw\n", {{"e.raw", "abc" + little}}});
  all.push_back(
      {"f.nhdr", nrrd_head("raw") + "endian: little\nbyte skip: -1\ndata file: f.raw\n", {{"f.raw", "abc" + little}}});
  all.push_back({"g.nhdr", nrrd_head("raw") + "endian: little\ndata file: s%d.raw 1 3 1\n", slices});
  all.push_back({"h.nhdr", nrrd_head("raw") + "endian: little\ndata file: LIST\ns1.raw\ns2.raw\ns3.raw\n", slices});

  all.push_back({"a.mha", meta_head("", "LOCAL") + little});
  all.push_back({"b.mha", meta_head("BinaryData = True\nBinaryDataByteOrderMSB = True\n", "LOCAL") + big});
  all.push_back({"c.mha", meta_head("CompressedData = True\n", "LOCAL") + zlib(little)});
  all.push_back({"d.mha", meta_head("BinaryData = False\n", "LOCAL") + text_of_values()});
  all.push_back({"e.mhd", meta_head("HeaderSize = 3\n", "e.raw"), {{"e.raw", "abc" + little}}});
  all.push_back({"f.mhd", meta_head("HeaderSize = -1\n", "f.raw"), {{"f.raw", "abc" + little}}});
  all.push_back({"g.mhd", meta_head("", "s%d.raw 1 3 1"), slices});
  all.push_back({"h.mhd", meta_head("", "LIST") + "s1.raw\ns2.raw\ns3.raw\n", slices});

  all.push_back(
      {"r.json",
       "{\"size\": [5, 4, 3], \"type\": \"int16\", \"origin\": [10, -20, 30], \"frame\": \"LPS\", \"unit\": \"mm\",\n"
       " \"directions\": [[-0.5, 0, 0], [0, 0.75, 0.25], [0, 0.5, 2]], \"endian\": \"big\", \"offset\": 3}",
       {{"r.raw", "abc" + big}}});
  return all;
}

Image read_small(const SmallImage& file, ImageChoice choice) {
  const io::Input input{file.name, file.bytes};
  const auto beside = [&](const std::string& name) {
    const auto found = file.beside.find(name);
    if (found == file.beside.end()) throw InputError(name + ": there is no such file");
    return image::KeptFile{{name, found->second}, nullptr};
  };
  return image::read_image_bytes({input, choice, beside});
}

namespace {

/// Elements of DICOM one after another.
class DicomBytes {
 public:
  DicomBytes(bool is_explicit, bool big_endian) : explicit_(is_explicit), big_(big_endian) {}

  void add(std::uint16_t group, std::uint16_t element, const std::string& vr, std::string value) {
    if (value.size() % 2 != 0) value += vr == "UI" ? '\0' : ' ';
    head(group, element, vr, static_cast<std::uint32_t>(value.size()));
    bytes += value;
  }
  void add(std::uint16_t group, std::uint16_t element, std::uint16_t value) {
    add(group, element, "US", number<std::uint16_t>(value));
  }
  void head(std::uint16_t group, std::uint16_t element, const std::string& vr, std::uint32_t length) {
    bytes += number<std::uint16_t>(group) + number<std::uint16_t>(element);
    const bool is_long = vr == "OW" || vr == "OB" || vr == "SQ" || vr == "UN";
    if (explicit_) bytes += vr + (is_long ? std::string(2, '\0') : "");
    bytes += explicit_ && !is_long ? number<std::uint16_t>(length) : number<std::uint32_t>(length);
  }
  template <class T>
  std::string number(std::uint32_t value) const {
    return raw(std::vector<T>{static_cast<T>(value)}, big_);
  }
  std::string bytes;

 private:
  bool explicit_, big_;
};

/// PackBits of one plane: runs and literals, both of which readers must know.
std::string packed_plane(const std::string& plane) {
  std::string out;
  for (std::size_t i = 0; i < plane.size();) {
    std::size_t run = 1;
    while (i + run < plane.size() && run < 128 && plane[i + run] == plane[i]) ++run;
    if (run > 1) {
      out += static_cast<char>(1 - static_cast<int>(run));
      out += plane[i];
      i += run;
      continue;
    }
    std::size_t literal = 1;
    while (i + literal < plane.size() && literal < 128 && plane[i + literal] != plane[i + literal - 1]) ++literal;
    out += static_cast<char>(literal - 1);
    out += plane.substr(i, literal);
    i += literal;
  }
  return out;
}

std::string rle_frame(const std::vector<std::int16_t>& pixels) {
  std::string high, low;
  for (const std::int16_t p : pixels) {
    high += static_cast<char>(static_cast<std::uint16_t>(p) >> 8);
    low += static_cast<char>(p & 0xff);
  }
  const std::string a = packed_plane(high), b = packed_plane(low);
  std::vector<std::uint32_t> head(16);
  head[0] = 2;
  head[1] = 64;
  head[2] = 64 + static_cast<std::uint32_t>(a.size());
  std::string frame = raw(head) + a + b;
  if (frame.size() % 2 != 0) frame += '\0';
  return frame;
}

template <class Numbers>
std::string joined(const Numbers& numbers) {
  std::string text;
  for (const double v : numbers) text += fmt::format("{}{:.10g}", text.empty() ? "" : "\\", v);
  return text;
}

}  // namespace

std::string DicomSlice::bytes() const {
  const std::map<Syntax, std::string> uids{{Syntax::kImplicit, "1.2.840.10008.1.2"},
                                           {Syntax::kExplicit, "1.2.840.10008.1.2.1"},
                                           {Syntax::kBigEndian, "1.2.840.10008.1.2.2"},
                                           {Syntax::kRle, "1.2.840.10008.1.2.5"},
                                           {Syntax::kJpeg, "1.2.840.10008.1.2.4.70"}};
  const bool big = syntax == Syntax::kBigEndian;
  DicomBytes meta(true, false), d(syntax != Syntax::kImplicit, big);
  meta.add(2, 0x10, "UI", uids.at(syntax));
  d.add(8, 0x16, "UI", "1.2.840.10008.5.1.4.1.1.2");
  d.add(8, 0x18, "UI", uid);
  d.add(8, 0x60, "CS", "CT");
  d.add(8, 0x103e, "LO", description);
  // A sequence in between, which readers must step through.
  d.head(8, 0x1140, "SQ", 0xffffffff);
  d.bytes += d.number<std::uint16_t>(0xfffe) + d.number<std::uint16_t>(0xe000) + d.number<std::uint32_t>(0xffffffff);
  d.add(8, 0x1155, "UI", "9.9");
  d.bytes += d.number<std::uint16_t>(0xfffe) + d.number<std::uint16_t>(0xe00d) + d.number<std::uint32_t>(0);
  d.bytes += d.number<std::uint16_t>(0xfffe) + d.number<std::uint16_t>(0xe0dd) + d.number<std::uint32_t>(0);
  if (thickness > 0) d.add(0x18, 0x50, "DS", fmt::format("{:g}", thickness));
  d.add(0x20, 0xd, "UI", "1.2.3.0");
  d.add(0x20, 0xe, "UI", series);
  d.add(0x20, 0x11, "IS", std::to_string(series_number));
  d.add(0x20, 0x12, "IS", std::to_string(acquisition));
  d.add(0x20, 0x13, "IS", std::to_string(instance));
  d.add(0x20, 0x32, "DS", joined(at));
  d.add(0x20, 0x37, "DS", joined(directions));
  d.add(0x28, 2, 1);
  d.add(0x28, 4, "CS", "MONOCHROME2");
  d.add(0x28, 0x10, size[1]);
  d.add(0x28, 0x11, size[0]);
  d.add(0x28, 0x30, "DS", joined(spacing));
  d.add(0x28, 0x100, 16);
  d.add(0x28, 0x101, bits_stored);
  d.add(0x28, 0x102, static_cast<std::uint16_t>(bits_stored - 1));
  d.add(0x28, 0x103, 1);
  d.add(0x28, 0x1052, "DS", fmt::format("{:g}", intercept));
  d.add(0x28, 0x1053, "DS", fmt::format("{:g}", slope));
  if (syntax == Syntax::kRle || syntax == Syntax::kJpeg) {
    d.head(0x7fe0, 0x10, "OB", 0xffffffff);
    const std::string frame = rle_frame(pixels);
    const auto item = [&](std::uint16_t element, const std::string& value) {
      d.bytes += d.number<std::uint16_t>(0xfffe) + d.number<std::uint16_t>(element) +
                 d.number<std::uint32_t>(static_cast<std::uint32_t>(value.size())) + value;
    };
    item(0xe000, "");
    item(0xe000, frame);
    item(0xe0dd, "");
  } else {
    d.add(0x7fe0, 0x10, "OW", raw(pixels, big));
  }
  if (!with_preamble) return d.bytes;
  return std::string(128, '\0') + "DICM" + meta.bytes + d.bytes;
}

DicomSlice dicom_slice(std::size_t k) {
  ImageGrid g = sheared_grid();
  g.axes[0] = g.axes[0] * -1.0;
  DicomSlice s;
  s.instance = static_cast<int>(k) + 1;
  s.uid = fmt::format("1.2.3.4.{}", k);
  const std::vector<std::int16_t> all = sample_values();
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(20 * k);
  s.pixels.assign(begin, begin + 20);
  const Vec3 at = g.origin + g.axes[2] * static_cast<double>(k), x = normalized(g.axes[0]), y = normalized(g.axes[1]);
  s.at = {at.x, at.y, at.z};
  s.directions = {x.x, x.y, x.z, y.x, y.y, y.z};
  s.spacing = {length(g.axes[1]), length(g.axes[0])};
  return s;
}

std::string input_error(const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "another error: " << error.what();
    return {};
  }
  ADD_FAILURE() << "no error";
  return {};
}

}  // namespace octafront::testing
