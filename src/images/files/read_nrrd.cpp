// NRRD: lines "field: value" and "key:=value", an empty line, voxels; or the voxels in files that the header names.
// https://teem.sourceforge.net/nrrd/format.html. Names of segments are read as 3D Slicer writes them (.seg.nrrd).

#include "formats/containers/scanner.h"
#include "images/files/image_readers.h"
#include "images/files/masks.h"
#include "images/files/slice_files.h"
#include "images/files/voxels.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/core.h>

namespace octafront::image {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), io::to_lower);
  return out;
}

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  for (text = io::trimmed(text); !text.empty(); text = io::trimmed(text)) {
    std::size_t end = 0;
    while (end < text.size() && !io::is_blank(text[end])) ++end;
    words.emplace_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return words;
}

std::optional<VoxelType> type_of_nrrd(std::string_view name) {
  static const std::vector<std::pair<VoxelType, std::vector<std::string_view>>> kNames{
      {VoxelType::kInt8, {"signed char", "int8", "int8_t"}},
      {VoxelType::kUInt8, {"uchar", "unsigned char", "uint8", "uint8_t"}},
      {VoxelType::kInt16, {"short", "short int", "signed short", "signed short int", "int16", "int16_t"}},
      {VoxelType::kUInt16, {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}},
      {VoxelType::kInt32, {"int", "signed int", "int32", "int32_t"}},
      {VoxelType::kUInt32, {"uint", "unsigned int", "uint32", "uint32_t"}},
      {VoxelType::kInt64,
       {"longlong", "long long", "long long int", "signed long long", "signed long long int", "int64", "int64_t"}},
      {VoxelType::kUInt64, {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"}},
      {VoxelType::kFloat32, {"float"}},
      {VoxelType::kFloat64, {"double"}}};
  for (const auto& [type, names] : kNames)
    if (std::ranges::find(names, name) != names.end()) return type;
  return std::nullopt;
}

/// Fields and keys up to the empty line, or the end.
class NrrdHeader {
 public:
  struct Field {
    std::string value;
    const char* at = nullptr;
  };

  explicit NrrdHeader(const io::Input& input) : input_(input) { read_lines(); }

  const std::map<std::string, std::string>& keys() const { return keys_; }
  /// Names of files below "data file: LIST", which is the last field.
  const std::vector<std::string>& listed_files() const { return listed_; }
  bool lists_files() const { return lists_files_; }
  /// The first byte behind the empty line; 0: there is none.
  std::size_t end() const { return end_; }

  const Field* field(const std::string& name) const {
    const auto found = fields_.find(name);
    return found == fields_.end() ? nullptr : &found->second;
  }
  const Field& required(const std::string& name) const {
    const Field* f = field(name);
    if (f == nullptr) input_.fail(fmt::format("has no field \"{}\" in its NRRD header; export it again", name));
    return *f;
  }
  std::string text(const std::string& name) const {
    const Field* f = field(name);
    return f == nullptr ? "" : f->value;
  }

  double number(const Field& f, std::string_view word) const {
    double value = 0;
    if (!io::parse_number(word, value))
      input_.fail_at_line(f.at, fmt::format("expected a number, found {}", io::in_quotes(word)));
    return value;
  }
  std::int64_t whole(const Field& f, std::string_view word) const {
    const double value = number(f, word);
    if (!(std::abs(value) < 1e15) || value != std::floor(value))
      input_.fail_at_line(f.at, fmt::format("expected a whole number, found {}", io::in_quotes(word)));
    return static_cast<std::int64_t>(value);
  }

  /// Takes "(x,y,z)" from the front of a text.
  Vec3 vector(const Field& f, std::string_view& rest) const {
    const std::size_t end = rest.find(')');
    if (!rest.starts_with('(') || end == std::string_view::npos)
      input_.fail_at_line(f.at, fmt::format("expected a vector such as (1,0,0), found {}", io::in_quotes(rest)));
    std::string inside(rest.substr(1, end - 1));
    std::replace(inside.begin(), inside.end(), ',', ' ');
    const std::vector<std::string> words = words_of(inside);
    if (words.size() != 3)
      input_.fail_at_line(f.at, fmt::format("expected three coordinates, found {}", io::in_quotes(rest)));
    rest = io::trimmed(rest.substr(end + 1));
    return {number(f, words[0]), number(f, words[1]), number(f, words[2])};
  }

 private:
  void read_lines() {
    std::size_t at = input_.bytes.find('\n') + 1;
    if (at == 0) input_.fail("ends behind the first line of an NRRD header; it is truncated: copy or export it again");
    constexpr std::size_t kMostHeader = std::size_t{1} << 24;
    for (;;) {
      if (at >= input_.bytes.size() || at > kMostHeader) break;
      const std::size_t end = std::min(input_.bytes.find('\n', at), input_.bytes.size());
      std::string_view line = input_.bytes.substr(at, end - at);
      if (line.ends_with('\r')) line.remove_suffix(1);
      const char* const begin = input_.bytes.data() + at;
      at = end + 1;
      if (line.empty()) {
        end_ = std::min(at, input_.bytes.size());
        break;
      }
      read_line(line, begin);
    }
  }

  void read_line(std::string_view line, const char* at) {
    if (line.starts_with('#') || lists_files_) {
      if (lists_files_ && !line.starts_with('#')) listed_.emplace_back(io::trimmed(line));
      return;
    }
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos)
      input_.fail_at_line(
          at, fmt::format("expected \"field: value\" in the NRRD header, found {}", io::in_quotes(line.substr(0, 60))));
    if (line.substr(colon).starts_with(":=")) {
      keys_.insert_or_assign(std::string(line.substr(0, colon)), std::string(line.substr(colon + 2)));
      return;
    }
    std::string name = lower(io::trimmed(line.substr(0, colon)));
    std::erase(name, ' ');  // "data file" is "datafile" too
    std::erase(name, '-');
    const std::string value(io::trimmed(line.substr(colon + 1)));
    fields_.insert_or_assign(name, Field{value, at});
    if (name == "datafile" && value.starts_with("LIST")) lists_files_ = true;
  }

  const io::Input& input_;
  std::map<std::string, Field> fields_;
  std::map<std::string, std::string> keys_;
  bool lists_files_ = false;
  std::vector<std::string> listed_;
  std::size_t end_ = 0;
};

class Nrrd {
 public:
  explicit Nrrd(const Reading& reading) : reading_(reading), input_(reading.input), header_(reading.input) {}

  Image read() {
    read_sizes();
    image_.format = "NRRD";
    place();
    check_grid(input_, image_.grid);
    read_values();
    name_segments();
    return std::move(image_);
  }

 private:
  /// One value per axis of the file.
  std::vector<std::string> per_axis(const std::string& name) const {
    const NrrdHeader::Field* f = header_.field(name);
    if (f == nullptr) return {};
    std::vector<std::string> words = words_of(f->value);
    if (words.size() != dimension_)
      input_.fail_at_line(f->at,
                          fmt::format("has {} values for {} axes; the file is damaged", words.size(), dimension_));
    return words;
  }

  void read_sizes() {
    const NrrdHeader::Field& f = header_.required("dimension");
    const std::int64_t dimension = header_.whole(f, f.value);
    if (dimension >= 0 && dimension < 3) fail_flat(input_);
    if (dimension > 4 || dimension < 0)
      input_.fail_at_line(f.at,
                          fmt::format("has {} dimensions; three are read here, or four with `series`", dimension));
    dimension_ = static_cast<std::size_t>(dimension);
    const NrrdHeader::Field& sizes = header_.required("sizes");
    for (const std::string& word : per_axis("sizes")) sizes_.push_back(header_.whole(sizes, word));
    vectors_ = vectors();
    find_extra_axis();
    Sizes space{};
    for (std::size_t i = 0; i < 3; ++i) space[i] = sizes_[axes_[i]];
    image_.grid.size = checked_sizes(input_, space);
    if (extra_) checked_sizes(input_, {sizes_[*extra_], 1, 1});
  }

  /// Of four axes one is none of space: the one without direction, of a kind that says so, or else the last.
  void find_extra_axis() {
    if (dimension_ == 4) {
      extra_ = 3;
      const std::vector<std::string> kinds = per_axis("kinds");
      for (std::size_t i = 0; i < 4; ++i) {
        const bool has_direction = vectors_.empty() || vectors_[i].has_value();
        const bool is_space = kinds.empty() || lower(kinds[i]) == "domain" || lower(kinds[i]) == "space";
        if (!has_direction || !is_space) {
          extra_ = i;
          break;
        }
      }
      if (*extra_ != 0 && *extra_ != 3)
        input_.fail("has its list of values on an axis in the middle; export it with that axis first or last");
    }
    for (std::size_t i = 0, n = 0; i < dimension_; ++i)
      if (i != extra_) axes_[n++] = i;
    for (const std::size_t axis : axes_)
      if (!vectors_.empty() && !vectors_[axis])
        input_.fail(fmt::format("has no space direction for axis {}; export it with directions", axis));
  }

  /// "(1,0,0) none (0,1,0)": one per axis, nullopt for none. Empty if the header has no directions.
  std::vector<std::optional<Vec3>> vectors() const {
    const NrrdHeader::Field* f = header_.field("spacedirections");
    std::vector<std::optional<Vec3>> all;
    if (f == nullptr) return all;
    std::string_view rest = io::trimmed(f->value);
    while (!rest.empty()) {
      if (rest.starts_with("none")) {
        all.emplace_back(std::nullopt);
        rest = io::trimmed(rest.substr(4));
        continue;
      }
      all.emplace_back(header_.vector(*f, rest));
    }
    if (all.size() != dimension_)
      input_.fail_at_line(f->at,
                          fmt::format("has {} directions for {} axes; the file is damaged", all.size(), dimension_));
    return all;
  }

  void place() {
    ImageGrid& grid = image_.grid;
    if (!vectors_.empty()) {
      for (std::size_t i = 0; i < 3; ++i) grid.axes[i] = *vectors_[axes_[i]];
      if (const NrrdHeader::Field* f = header_.field("spaceorigin")) {
        std::string_view value = f->value;
        grid.origin = header_.vector(*f, value);
      }
    } else {
      const std::vector<std::string> spacings = per_axis("spacings"), mins = per_axis("axismins");
      for (std::size_t i = 0; i < 3; ++i) {
        const int axis = static_cast<int>(i);
        if (!spacings.empty())
          grid.axes[i][axis] = finite_or(header_.number(header_.required("spacings"), spacings[axes_[i]]), 1);
        if (!mins.empty())
          grid.origin[axis] = finite_or(header_.number(header_.required("axismins"), mins[axes_[i]]), 0);
      }
      if (spacings.empty()) image_.notes.emplace_back("the header has no spacing; 1 is taken");
    }
    set_frame();
  }

  static double finite_or(double value, double otherwise) { return std::isfinite(value) ? value : otherwise; }

  void set_frame() {
    const std::string space = lower(header_.text("space"));
    for (const auto& [prefix, short_name] : {std::pair{"right-anterior-superior", "RAS"},
                                             {"ras", "RAS"},
                                             {"left-anterior-superior", "LAS"},
                                             {"las", "LAS"},
                                             {"left-posterior-superior", "LPS"},
                                             {"lps", "LPS"}})
      if (space.starts_with(prefix)) image_.frame = short_name;
    const std::vector<std::string> units =
        words_of(header_.text(header_.field("spaceunits") != nullptr ? "spaceunits" : "units"));
    if (!units.empty()) {
      std::string unit = units[header_.field("spaceunits") != nullptr ? 0 : std::min(axes_[0], units.size() - 1)];
      std::erase(unit, '"');
      if (unit == "mm" || unit == "m" || unit == "um" || unit == "cm") image_.unit = unit;
    }
  }

  StoredVoxels stored() const {
    const NrrdHeader::Field& f = header_.required("type");
    const std::optional<VoxelType> type = type_of_nrrd(lower(f.value));
    if (!type)
      input_.fail_at_line(f.at, fmt::format("{} is no type of voxels that is read here", io::in_quotes(f.value)));
    StoredVoxels s;
    s.type = *type;
    const std::string endian = lower(header_.text("endian"));
    if (endian == "big") {
      s.big_endian = true;
    } else if (endian != "little" && bytes_of(s.type) > 1 && !is_text()) {
      input_.fail("does not say \"endian: little\" or \"endian: big\" in its NRRD header; export it again");
    }
    return s;
  }

  std::string encoding() const { return lower(header_.required("encoding").value); }
  bool is_text() const { return encoding() == "ascii" || encoding() == "text" || encoding() == "txt"; }

  void read_values() {
    const std::string how = encoding();
    if (how == "gzip" || how == "gz") {
      files_.packing = Packing::kZlib;
      image_.format += ", compressed";
    } else if (how != "raw" && !is_text()) {
      input_.fail_at_line(
          header_.required("encoding").at,
          fmt::format("the encoding {} is not read here; export it as raw or gzip", io::in_quotes(how)));
    }
    if (const NrrdHeader::Field* f = header_.field("lineskip"))
      files_.skipped_lines = static_cast<std::uint64_t>(std::max<std::int64_t>(0, header_.whole(*f, f->value)));
    if (const NrrdHeader::Field* f = header_.field("byteskip")) {
      const std::int64_t skip = header_.whole(*f, f->value);
      files_.at_end = skip < 0;
      files_.skipped_bytes = static_cast<std::uint64_t>(std::max<std::int64_t>(0, skip));
    }
    const std::uint64_t lists = extra_ ? static_cast<std::uint64_t>(sizes_[*extra_]) : 1;
    if (has_layers()) return read_layers(lists);
    series_ = chosen_series(reading_, lists, "values per voxel");
    if (is_text()) return read_text();
    find_files();
    image_.values = values_of_list(series_, lists);
  }

  /// One of the values that each voxel has.
  Image::Values values_of_list(std::uint64_t list, std::uint64_t lists) {
    const std::uint64_t voxels = image_.grid.voxels();
    const bool interleaved = extra_ == 0;
    const Picked picked{interleaved ? list : list * voxels, voxels, interleaved ? lists : 1};
    return files_.names.empty()
               ? read_attached(reading_, header_.end(), files_, voxels * lists, picked, stored(), image_.notes)
               : read_data_files(reading_, files_, voxels * lists, picked, stored(), image_.notes);
  }

  /// 3D Slicer's segments that overlap lie in several layers, the values of a voxel.
  bool has_layers() const {
    return extra_ && reading_.choice.series == 0 && !is_text() &&
           std::ranges::any_of(header_.keys(), [](const auto& k) { return k.first.ends_with("_Layer"); });
  }

  void read_layers(std::uint64_t lists) {
    find_files();
    Layers layers;
    for (std::uint64_t list = 0; list < lists; ++list) layers.values.push_back(values_of_list(list, lists));
    for (std::size_t n = 0; header_.keys().contains(fmt::format("Segment{}_Layer", n)); ++n) {
      const auto key = [&](const char* what) {
        const auto found = header_.keys().find(fmt::format("Segment{}_{}", n, what));
        return found == header_.keys().end() ? std::string() : found->second;
      };
      double layer = 0, value = 0;
      if (!io::parse_number(key("Layer"), layer) || !io::parse_number(key("LabelValue"), value) || !(layer >= 0) ||
          !(layer < static_cast<double>(lists)) || !(std::abs(value) < 1e15))
        input_.fail(fmt::format("its segment {} has no layer or value that the file has; export it again", n));
      const std::string name = key("Name");
      layers.segments.push_back({static_cast<std::size_t>(layer), static_cast<std::int64_t>(value),
                                 name.empty() ? fmt::format("segment {}", n + 1) : name});
    }
    put_together(layers, image_);
  }

  void read_text() {
    if (extra_ || header_.field("datafile") != nullptr)
      input_.fail("holds text that is not one volume in the file itself; export it as raw or gzip");
    image_.format += ", text";
    image_.values =
        read_text_voxels(input_, input_.bytes.data() + header_.end(), image_.grid.size, stored().type, image_.notes);
  }

  void find_files() {
    const NrrdHeader::Field* f = header_.field("datafile");
    if (f == nullptr) {
      if (header_.end() == 0)
        input_.fail("its header has no end (an empty line) and names no data file; it is truncated");
      return;
    }
    if (header_.lists_files()) {
      files_.names = header_.listed_files();
      return;
    }
    const std::vector<std::string> words = words_of(f->value);
    if (words.size() >= 3 && words[0].find('%') != std::string::npos) {
      const std::int64_t step = words.size() > 3 ? header_.whole(*f, words[3]) : 1;
      files_.names = numbered_names(input_, words[0], header_.whole(*f, words[1]), header_.whole(*f, words[2]), step);
    } else {
      files_.names = {f->value};
    }
  }

  /// Segment3_Name:=liver, Segment3_LabelValue:=7, Segment3_Layer:=0
  void name_segments() {
    if (!image_.names.empty()) return;
    for (const auto& [key, name] : header_.keys()) {
      if (!key.starts_with("Segment") || !key.ends_with("_Name")) continue;
      const std::string prefix = key.substr(0, key.size() - 4);
      const auto value = header_.keys().find(prefix + "LabelValue"), layer = header_.keys().find(prefix + "Layer");
      double number = 0;
      if (value == header_.keys().end() || !io::parse_number(value->second, number) || !(std::abs(number) < 1e15))
        continue;
      if (layer != header_.keys().end() && extra_ && layer->second != std::to_string(series_)) continue;
      image_.names.push_back({static_cast<std::int64_t>(number), name});
    }
    std::sort(image_.names.begin(), image_.names.end(),
              [](const LabelName& a, const LabelName& b) { return a.value < b.value; });
  }

  const Reading& reading_;
  const io::Input& input_;
  NrrdHeader header_;
  DataFiles files_;
  std::size_t dimension_ = 0;
  std::vector<std::int64_t> sizes_;  ///< of all axes
  std::vector<std::optional<Vec3>> vectors_;
  std::array<std::size_t, 3> axes_{};  ///< of space
  std::optional<std::size_t> extra_;   ///< the axis of a list of values
  std::uint32_t series_ = 0;
  Image image_;
};

}  // namespace

bool is_nrrd(std::string_view head) {
  return head.starts_with("NRRD00");
}

Image read_nrrd(const Reading& reading) {
  return Nrrd(reading).read();
}

}  // namespace octafront::image
