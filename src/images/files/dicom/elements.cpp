// DICOM PS3.5 (data structures and encoding) and PS3.10 (files).

#include "images/files/dicom/elements.h"

#include <octafront/error.h>

#include <algorithm>
#include <array>
#include <cstring>

#include <fmt/core.h>

namespace octafront::image {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t kPreamble = 128;
constexpr std::uint32_t kUndefined = 0xffffffff;
constexpr Tag kItem = tag(0xfffe, 0xe000), kItemEnd = tag(0xfffe, 0xe00d), kSequenceEnd = tag(0xfffe, 0xe0dd);
constexpr Tag kPixels = tag(0x7fe0, 0x0010);

struct KnownSyntax {
  std::string_view uid, name;
};
/// Those whose pixels are not read, by their names.
constexpr std::array kUnread{KnownSyntax{"1.2.840.10008.1.2.4.50", "JPEG Baseline"},
                             KnownSyntax{"1.2.840.10008.1.2.4.51", "JPEG Extended"},
                             KnownSyntax{"1.2.840.10008.1.2.4.57", "JPEG Lossless"},
                             KnownSyntax{"1.2.840.10008.1.2.4.70", "JPEG Lossless, first-order prediction"},
                             KnownSyntax{"1.2.840.10008.1.2.4.80", "JPEG-LS Lossless"},
                             KnownSyntax{"1.2.840.10008.1.2.4.81", "JPEG-LS Near-Lossless"},
                             KnownSyntax{"1.2.840.10008.1.2.4.90", "JPEG 2000 Lossless"},
                             KnownSyntax{"1.2.840.10008.1.2.4.91", "JPEG 2000"},
                             KnownSyntax{"1.2.840.10008.1.2.4.92", "JPEG 2000 Multi-component Lossless"},
                             KnownSyntax{"1.2.840.10008.1.2.4.93", "JPEG 2000 Multi-component"},
                             KnownSyntax{"1.2.840.10008.1.2.4.201", "High-Throughput JPEG 2000 Lossless"},
                             KnownSyntax{"1.2.840.10008.1.2.4.202", "High-Throughput JPEG 2000 RPCL Lossless"},
                             KnownSyntax{"1.2.840.10008.1.2.4.203", "High-Throughput JPEG 2000"}};

Syntax syntax_of(std::string_view uid) {
  if (uid == "1.2.840.10008.1.2") return {std::string(uid), "Implicit VR Little Endian", false};
  if (uid == "1.2.840.10008.1.2.1") return {std::string(uid), "Explicit VR Little Endian"};
  if (uid == "1.2.840.10008.1.2.2") return {std::string(uid), "Explicit VR Big Endian", true, true};
  if (uid == "1.2.840.10008.1.2.5") return {std::string(uid), "RLE Lossless", true, false, true};
  Syntax other{std::string(uid), fmt::format("the unknown transfer syntax {}", io::in_quotes(uid))};
  other.is_readable = false;
  for (const KnownSyntax& known : kUnread)
    if (uid == known.uid) other.name = known.name, other.is_jpeg = !known.name.starts_with("High");
  return other;
}

bool is_letter(char c) {
  return c >= 'A' && c <= 'Z';
}

/// Value representations whose lengths have four bytes.
bool has_long_length(std::string_view vr) {
  for (const std::string_view known : {"OB", "OD", "OF", "OL", "OV", "OW", "SQ", "SV", "UC", "UN", "UR", "UT", "UV"})
    if (vr == known) return true;
  return false;
}

class DicomParser {
 public:
  using Visit = std::function<void(const std::vector<Level>&, const Element&)>;

  DicomParser(const io::Input& input, const Visit& visit) : input_(input), visit_(visit), progress_(input) {}

  Syntax parse() {
    read_head();
    syntax_ = uid_.empty() ? guessed() : syntax_of(uid_);
    read_until(input_.bytes.size(), syntax_.is_explicit, 0);
    return syntax_;
  }

  std::size_t deflated_data() {
    read_head();
    return uid_ == "1.2.840.10008.1.2.1.99" ? at_ : 0;
  }

 private:
  [[noreturn]] void fail(std::string_view message) const {
    input_.fail_at_byte(input_.bytes.data() + std::min(at_, input_.bytes.size()),
                        fmt::format("{}; the DICOM file is damaged or truncated: copy or export it again", message));
  }

  template <class T>
  T number(bool big_endian) {
    if (input_.bytes.size() - at_ < sizeof(T)) fail("the file ends inside an element");
    char raw[sizeof(T)];
    std::memcpy(raw, input_.bytes.data() + at_, sizeof(T));
    if (big_endian) std::reverse(raw, raw + sizeof(T));
    T value;
    std::memcpy(&value, raw, sizeof(T));
    at_ += sizeof(T);
    return value;
  }

  Tag next_tag() {
    const auto group = number<std::uint16_t>(syntax_.big_endian), element = number<std::uint16_t>(syntax_.big_endian);
    return tag(group, element);
  }

  std::string_view take(std::uint64_t length) {
    if (length > input_.bytes.size() - at_)
      fail(fmt::format("an element claims {} bytes, but the file has {} more", length, input_.bytes.size() - at_));
    const std::string_view value = input_.bytes.substr(at_, length);
    at_ += length;
    return value;
  }

  void read_head() {
    const bool has_preamble = input_.bytes.size() > kPreamble + 4 && input_.bytes.substr(kPreamble, 4) == "DICM";
    at_ = has_preamble ? kPreamble + 4 : 0;
    read_meta();
  }

  /// Group 2 is always explicit and little endian; it names the syntax of the rest.
  void read_meta() {
    while (input_.bytes.size() - at_ >= 8 && input_.bytes.substr(at_, 2) == "\x02\0"sv) {
      const Tag id = next_tag();
      const std::string_view vr = take(2);
      const std::uint64_t length =
          has_long_length(vr) ? (take(2), number<std::uint32_t>(false)) : number<std::uint16_t>(false);
      std::string_view value = take(length);
      while (!value.empty() && (value.back() == '\0' || value.back() == ' ')) value.remove_suffix(1);
      if (id == tag(2, 0x10)) uid_ = value;
    }
  }

  /// Without a header of its own a file is little endian; value representations are two letters.
  Syntax guessed() const {
    const std::string_view vr = input_.bytes.substr(std::min(at_ + 4, input_.bytes.size()), 2);
    const bool is_explicit = vr.size() == 2 && is_letter(vr[0]) && is_letter(vr[1]);
    return syntax_of(is_explicit ? "1.2.840.10008.1.2.1" : "1.2.840.10008.1.2");
  }

  /// Elements up to a byte, or to the end of an item.
  void read_until(std::size_t end, bool is_explicit, int depth) {
    constexpr int kMostDepth = 32;
    if (depth > kMostDepth) fail("sequences lie too deep inside one another");
    while (at_ < end) {
      // Zeros behind the last element are padding of some archives.
      if (depth == 0 && input_.bytes.find_first_not_of('\0', at_) == std::string_view::npos) return;
      progress_.reach(input_.bytes.data() + at_);
      const Tag id = next_tag();
      if (id == kItemEnd || id == kSequenceEnd) {
        number<std::uint32_t>(syntax_.big_endian);
        return;
      }
      read_element(id, is_explicit, depth);
    }
  }

  void read_element(Tag id, bool is_explicit, int depth) {
    std::string_view vr;
    std::uint32_t length = 0;
    if (is_explicit) {
      vr = take(2);
      if (has_long_length(vr)) {
        take(2);
        length = number<std::uint32_t>(syntax_.big_endian);
      } else {
        length = number<std::uint16_t>(syntax_.big_endian);
      }
    } else {
      length = number<std::uint32_t>(syntax_.big_endian);
    }
    if (id == kPixels && length == kUndefined) return read_fragments(depth);
    if (vr == "SQ" || length == kUndefined) return read_sequence(id, length, is_explicit && vr != "UN", depth);
    // Implicit sequences of known length look like any value; only these are of use.
    const bool is_groups = id == tag(0x5200, 0x9229) || id == tag(0x5200, 0x9230) || id == tag(0x0020, 0x9113) ||
                           id == tag(0x0020, 0x9116) || id == tag(0x0028, 0x9110) || id == tag(0x0028, 0x9145) ||
                           id == tag(0x0062, 0x0002) || id == tag(0x0062, 0x000a);
    if (!is_explicit && is_groups) return read_sequence(id, length, false, depth);
    visit_(levels_, {id, take(length)});
  }

  void read_sequence(Tag id, std::uint32_t length, bool is_explicit, int depth) {
    const std::size_t end =
        length == kUndefined ? input_.bytes.size() : at_ + std::min<std::size_t>(length, input_.bytes.size() - at_);
    levels_.push_back({id, 0});
    while (at_ < end) {
      const Tag item = next_tag();
      const auto size = number<std::uint32_t>(syntax_.big_endian);
      if (item == kSequenceEnd) break;
      if (item != kItem) fail("expected an item of a sequence");
      const std::size_t item_end = size == kUndefined ? end : at_ + std::min<std::size_t>(size, end - at_);
      read_until(item_end, is_explicit, depth + 1);
      ++levels_.back().item;
    }
    levels_.pop_back();
  }

  void read_fragments(int depth) {
    Element pixels{kPixels, {}, {}};
    for (bool is_table = true;; is_table = false) {
      const Tag item = next_tag();
      const auto size = number<std::uint32_t>(syntax_.big_endian);
      if (item == kSequenceEnd) break;
      if (item != kItem || size == kUndefined) fail("expected a fragment of pixels");
      const std::string_view fragment = take(size);
      if (!is_table) pixels.fragments.push_back(fragment);
    }
    if (depth == 0) visit_(levels_, pixels);
  }

  const io::Input& input_;
  const Visit& visit_;
  io::ReadingProgress progress_;
  std::size_t at_ = 0;
  std::string uid_;
  Syntax syntax_;
  std::vector<Level> levels_;
};

}  // namespace

bool is_dicom(std::string_view head) {
  if (head.size() > kPreamble + 4 && head.substr(kPreamble, 4) == "DICM") return true;
  // Old files begin with their first element right away: group 8, a low number, and a letters' pair or a short length.
  if (head.size() < 12 || head[0] != '\x08' || head[1] != '\0' || head[3] != '\0' || head[2] > 0x20) return false;
  const bool is_explicit = is_letter(head[4]) && is_letter(head[5]);
  const bool is_implicit = head[5] == '\0' && head[6] == '\0' && head[7] == '\0';
  return is_explicit || is_implicit;
}

std::size_t deflated_data_in(std::string_view bytes) {
  try {
    return DicomParser({"", bytes}, {}).deflated_data();
  } catch (const InputError&) {
    return 0;  // who reads all of it says what is wrong
  }
}

Syntax for_each_element(const io::Input& input,
                        const std::function<void(const std::vector<Level>&, const Element&)>& visit) {
  return DicomParser(input, visit).parse();
}

}  // namespace octafront::image
