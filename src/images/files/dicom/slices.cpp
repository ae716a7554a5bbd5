#include "images/files/dicom/slices.h"

#include "formats/containers/scanner.h"
#include "images/files/dicom/unpack.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include <fmt/core.h>

namespace octafront::image {
namespace {

constexpr Tag kSegments = tag(0x0062, 0x0002);
constexpr Tag kShared = tag(0x5200, 0x9229), kPerFrame = tag(0x5200, 0x9230);

std::string_view trimmed(std::string_view text) {
  const auto is_padding = [](char c) { return c == ' ' || c == '\0'; };
  while (!text.empty() && is_padding(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_padding(text.back())) text.remove_suffix(1);
  return text;
}

/// "1\2\3" as numbers; nothing if one is none.
std::vector<double> numbers_of(std::string_view text) {
  std::vector<double> all;
  for (;;) {
    const std::size_t end = text.find('\\');
    double value = 0;
    if (!io::parse_number(trimmed(text.substr(0, end)), value) || !std::isfinite(value)) return {};
    all.push_back(value);
    if (end == std::string_view::npos) return all;
    text.remove_prefix(end + 1);
  }
}

std::int64_t whole_of(std::string_view text) {
  const std::vector<double> all = numbers_of(text);
  return all.empty() || !(std::abs(all[0]) < 1e15) ? 0 : static_cast<std::int64_t>(all[0]);
}

/// What frames may have by themselves or in common.
using Values = std::map<Tag, std::string_view>;

/// Two bytes as a number in the byte order of the file.
std::uint32_t short_of(std::string_view value, bool big_endian) {
  if (value.size() < 2) return 0;
  const auto byte = [&](std::size_t i) { return std::uint32_t{static_cast<unsigned char>(value[i])}; };
  return big_endian ? byte(0) << 8 | byte(1) : byte(1) << 8 | byte(0);
}

class SliceParser {
 public:
  explicit SliceParser(const io::Input& input) : input_(input) {}

  SliceFile parse() {
    file_.syntax = for_each_element(input_, [this](const std::vector<Level>& levels, const Element& element) {
      if (levels.empty()) {
        visit_top(element);
      } else if (levels[0].sequence == kShared) {
        common_[element.id] = element.value;
      } else if (levels[0].sequence == kPerFrame && levels.size() > 1) {
        const std::uint32_t frame = levels[0].item;
        if (frames_.size() <= frame) frames_.resize(frame + 1);
        frames_[frame][element.id] = element.value;
      } else if (levels[0].sequence == kSegments && levels.size() == 1) {
        add_to_segment(levels[0].item, element);
      }
    });
    describe();
    make_slices();
    return std::move(file_);
  }

 private:
  void add_to_segment(std::uint32_t item, const Element& element) {
    if (file_.segments.size() <= item) file_.segments.resize(item + 1);
    Segment& segment = file_.segments[item];
    // The syntax is known when all is read; segments' numbers are small, and little endian everywhere.
    if (element.id == tag(0x0062, 0x0004)) segment.number = short_of(element.value, false);
    if (element.id == tag(0x0062, 0x0005)) segment.name = trimmed(element.value);
  }

  void visit_top(const Element& element) {
    if (element.id != tag(0x7fe0, 0x0010)) {
      top_[element.id] = element.value;
      return;
    }
    file_.has_pixels = true;
    file_.pixels = element.value;
    file_.fragments = element.fragments;
  }

  std::string_view text(Tag id) const {
    const auto found = top_.find(id);
    return found == top_.end() ? std::string_view() : trimmed(found->second);
  }
  std::uint32_t number(Tag id) const {
    const auto found = top_.find(id);
    return found == top_.end() ? 0 : short_of(found->second, file_.syntax.big_endian);
  }

  void describe() {
    file_.series = text(tag(0x0020, 0x000e));
    file_.series_number = whole_of(text(tag(0x0020, 0x0011)));
    file_.description = text(tag(0x0008, 0x103e));
    file_.modality = text(tag(0x0008, 0x0060));
    file_.sop_class = text(tag(0x0008, 0x0016));
    file_.samples = top_.contains(tag(0x0028, 0x0002)) ? number(tag(0x0028, 0x0002)) : 1;
    file_.format.bits_allocated = number(tag(0x0028, 0x0100));
    file_.format.bits_stored = number(tag(0x0028, 0x0101));
    if (file_.format.bits_stored == 0) file_.format.bits_stored = file_.format.bits_allocated;
    file_.format.high_bit =
        top_.contains(tag(0x0028, 0x0102)) ? number(tag(0x0028, 0x0102)) : file_.format.bits_stored - 1;
    if (const std::uint32_t most = number(tag(0x0062, 0x000e)); most > 0) file_.most = most;
    file_.format.is_signed = number(tag(0x0028, 0x0103)) == 1;
  }

  void make_slices() {
    std::int64_t count = 1;
    if (const std::string_view frames = text(tag(0x0028, 0x0008)); !frames.empty()) count = whole_of(frames);
    // Each has a pixel at least.
    if (count < 1 || static_cast<std::uint64_t>(count) > input_.bytes.size())
      input_.fail(fmt::format("claims {} frames; the DICOM file is damaged", count));
    for (std::int64_t f = 0; f < count; ++f) {
      const auto n = static_cast<std::uint32_t>(f);
      file_.slices.push_back(slice(n));
      // Frames without places of their own follow one another by the distance that the file has for all.
      if (n > 0 && !has_own_place(n)) shift(file_.slices.back(), n);
    }
  }

  bool has_own_place(std::uint32_t frame) const {
    return frame < frames_.size() && frames_[frame].contains(tag(0x0020, 0x0032));
  }

  static void shift(Slice& s, std::uint32_t frame) {
    s.has_place = s.has_place && s.thickness > 0;
    s.at += cross(s.directions[0], s.directions[1]) * (s.thickness * frame);
  }

  /// A frame's own value, or what all have in common, or the file.
  std::string_view value(std::uint32_t frame, Tag id) const {
    if (frame < frames_.size())
      if (const auto own = frames_[frame].find(id); own != frames_[frame].end()) return trimmed(own->second);
    if (const auto all = common_.find(id); all != common_.end()) return trimmed(all->second);
    return text(id);
  }

  /// As they are: of numbers in binary.
  std::string_view own_bytes(std::uint32_t frame, Tag id) const {
    if (frame < frames_.size())
      if (const auto own = frames_[frame].find(id); own != frames_[frame].end()) return own->second;
    const auto all = common_.find(id);
    return all == common_.end() ? std::string_view() : all->second;
  }

  Slice slice(std::uint32_t frame) const {
    Slice s;
    s.frame = frame;
    s.size = {number(tag(0x0028, 0x0011)), number(tag(0x0028, 0x0010))};
    s.acquisition = whole_of(text(tag(0x0020, 0x0012)));
    s.instance = whole_of(text(tag(0x0020, 0x0013))) + frame;
    place(frame, s);
    const std::vector<double> between = numbers_of(value(frame, tag(0x0018, 0x0088)));
    const std::vector<double> thick = numbers_of(value(frame, tag(0x0018, 0x0050)));
    s.thickness = !between.empty() ? std::abs(between[0]) : !thick.empty() ? thick[0] : 0;
    const std::vector<double> slope = numbers_of(value(frame, tag(0x0028, 0x1053)));
    const std::vector<double> intercept = numbers_of(value(frame, tag(0x0028, 0x1052)));
    if (!slope.empty() && slope[0] != 0) s.slope = slope[0];
    if (!intercept.empty()) s.intercept = intercept[0];
    s.segment = short_of(own_bytes(frame, tag(0x0062, 0x000b)), file_.syntax.big_endian);
    return s;
  }

  void place(std::uint32_t frame, Slice& s) const {
    const std::vector<double> at = numbers_of(value(frame, tag(0x0020, 0x0032)));
    const std::vector<double> d = numbers_of(value(frame, tag(0x0020, 0x0037)));
    const std::vector<double> spacing = numbers_of(value(frame, tag(0x0028, 0x0030)));
    s.has_place = at.size() == 3 && d.size() == 6 && spacing.size() == 2 && spacing[0] > 0 && spacing[1] > 0;
    if (!s.has_place) return;
    s.at = {at[0], at[1], at[2]};
    s.directions = {normalized({d[0], d[1], d[2]}), normalized({d[3], d[4], d[5]})};
    s.spacing = {spacing[1], spacing[0]};  // the file has that between rows first
  }

  const io::Input& input_;
  SliceFile file_;
  Values top_, common_;
  std::vector<Values> frames_;
};

/// One frame of RLE Lossless (PS3.5, annex G): planes of bytes, the highest first, each packed by itself.
class RleFrame {
 public:
  RleFrame(const io::Input& input, std::string_view bytes) : input_(input), bytes_(bytes) {}

  /// Bytes of `count` pixels of `size` bytes, little endian.
  std::vector<char> unpacked(std::uint64_t count, std::uint32_t size) const {
    constexpr std::size_t kHeader = 64;
    // Packing gains a factor of 64 at most.
    if (bytes_.size() < kHeader || count > 64 * std::uint64_t{bytes_.size()}) fail();
    if (word(0) != size)
      input_.fail(
          fmt::format("has {} planes of bytes for pixels of {} bytes; the DICOM file is damaged", word(0), size));
    std::vector<char> out(count * size);
    for (std::uint32_t plane = 0; plane < size; ++plane)
      unpack(word(1 + plane), out.data() + (size - 1 - plane), count, size);
    return out;
  }

 private:
  [[noreturn]] void fail() const {
    input_.fail("has a frame of RLE that is cut off; copy or export the DICOM file again");
  }

  std::uint32_t word(std::size_t n) const {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes_.data() + 4 * n, 4);
    return value;
  }

  void unpack(std::size_t at, char* to, std::uint64_t count, std::uint32_t stride) const {
    std::uint64_t done = 0;
    const auto put = [&](char c) {
      if (done < count) to[stride * done++] = c;
    };
    while (done < count) {
      if (at >= bytes_.size()) fail();
      const int n = static_cast<signed char>(bytes_[at++]);
      if (n == -128) continue;
      const std::size_t length = n >= 0 ? static_cast<std::size_t>(n) + 1 : static_cast<std::size_t>(1 - n);
      if (at + (n >= 0 ? length : 1) > bytes_.size()) fail();
      for (std::size_t i = 0; i < length; ++i) put(bytes_[n >= 0 ? at + i : at]);
      at += n >= 0 ? length : 1;
    }
  }

  const io::Input& input_;
  std::string_view bytes_;
};

std::int32_t value_of(std::uint32_t raw, const PixelFormat& f) {
  const std::uint32_t mask = f.bits_stored >= 32 ? 0xffffffffu : (1u << f.bits_stored) - 1;
  std::uint32_t v = raw >> (f.high_bit + 1 - f.bits_stored) & mask;
  if (f.is_signed && (v >> (f.bits_stored - 1) & 1) != 0) v |= ~mask;
  return static_cast<std::int32_t>(v);
}

}  // namespace

SliceFile parse_slices(const io::Input& input) {
  return SliceParser(input).parse();
}

void refuse_pixels(const io::Input& input, const SliceFile& file) {
  if (file.is_segmentation()) input.fail("is a DICOM segmentation, not a slice of an image; give it alone");
  if (!file.syntax.is_readable && !(file.syntax.is_jpeg && has_gdcm()))
    input.fail(
        fmt::format("its pixels are written as {}, which {}; convert it to an uncompressed syntax (dcmdjpeg, "
                    "gdcmconv --raw){}",
                    file.syntax.name, "is not read here",
                    file.syntax.is_jpeg ? ", or build octafront with libgdcm-dev installed" : ""));
  if (!file.has_pixels)
    input.fail(fmt::format("holds no pixels (modality {}): it is no image", io::in_quotes(file.modality)));
  if (file.samples != 1)
    input.fail(fmt::format("has {} values per pixel (colours); a scalar image is needed", file.samples));
  const PixelFormat& f = file.format;
  if ((f.bits_allocated != 8 && f.bits_allocated != 16 && f.bits_allocated != 32) || f.bits_stored == 0 ||
      f.bits_stored > f.bits_allocated || f.high_bit + 1 < f.bits_stored || f.high_bit >= f.bits_allocated)
    input.fail(fmt::format("has pixels of {} bits in {}, the highest {}; whole bytes are read here", f.bits_stored,
                           f.bits_allocated, f.high_bit));
  if (f.bits_stored == 32 && !f.is_signed) input.fail("has pixels of 32 bits without sign, which are not read here");
}

void read_pixels(const io::Input& input, const SliceFile& file, const Slice& slice, std::int32_t* out) {
  const std::uint32_t size = file.format.bits_allocated / 8;
  const std::uint64_t count = std::uint64_t{slice.size[0]} * slice.size[1];
  std::vector<char> unpacked;
  std::string_view bytes;
  bool big_endian = file.syntax.big_endian;
  if (file.syntax.is_rle) {
    if (slice.frame >= file.fragments.size()) input.fail(fmt::format("has no pixels for frame {}", slice.frame + 1));
    unpacked = RleFrame(input, file.fragments[slice.frame]).unpacked(count, size);
    bytes = {unpacked.data(), unpacked.size()};
    big_endian = false;
  } else {
    if (file.pixels.size() / (count * size) <= slice.frame)
      input.fail(fmt::format(
          "has {} bytes of pixels, but {} x {} pixels in {} take {}; it is truncated: copy or export it again",
          file.pixels.size(), slice.size[0], slice.size[1],
          slice.frame == 0 ? std::string("one frame") : fmt::format("{} frames", slice.frame + 1),
          count * size * (slice.frame + 1)));
    bytes = file.pixels.substr(count * size * slice.frame, count * size);
  }
  for (std::uint64_t i = 0; i < count; ++i) {
    std::uint32_t raw = 0;
    for (std::uint32_t b = 0; b < size; ++b)
      raw |= std::uint32_t{static_cast<unsigned char>(bytes[i * size + (big_endian ? size - 1 - b : b)])} << 8 * b;
    out[i] = value_of(raw, file.format);
  }
}

}  // namespace octafront::image
