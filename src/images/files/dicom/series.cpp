#include "images/files/dicom/series.h"

#include <octafront/error.h>
#include <octafront/limits.h>

#include "base/core/elementary.h"
#include "base/core/parallel.h"
#include "base/core/thread_limit.h"
#include "base/core/wording.h"
#include "images/files/dicom/unpack.h"
#include "images/files/voxels.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <tuple>

#include <fmt/core.h>

namespace octafront::image {
namespace {

namespace fs = std::filesystem;

/// Directions and spacings that are as good as equal: headers round them to six digits.
constexpr double kSameDirection = 1e-4;
/// Slices may lie so much of their distance off, as scanners round it.
constexpr double kJitter = 0.01;

/// Slices that may be one volume.
struct Volume {
  std::string series, description, modality;
  std::int64_t number = 0;
  PixelFormat format;
  std::string syntax;
  std::vector<Slice> slices;
};

Vec3 normal_of(const Slice& s) {
  return cross(s.directions[0], s.directions[1]);
}

/// Its headers can be parsed.
KeptFile opened(const SliceFiles& files, std::size_t f) {
  return inflated(files.open(f));
}

bool same_plane(const Slice& a, const Slice& b) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (distance(a.directions[i], b.directions[i]) > kSameDirection) return false;
    if (std::abs(a.spacing[i] - b.spacing[i]) > kSameDirection * a.spacing[i]) return false;
  }
  return a.size == b.size;
}

class Collector {
 public:
  Collector(const SliceFiles& files, const RunContext& context) : files_(files), context_(context) {}

  std::vector<Volume> collect() {
    for (std::size_t f = 0; f < files_.names.size(); ++f) {
      context_.check();
      context_.report("reading", static_cast<double>(f) / static_cast<double>(files_.names.size()) / 2);
      add(f);
    }
    if (volumes_.empty()) throw InputError(first_refusal_.empty() ? "no file holds an image" : first_refusal_);
    std::vector<Volume> all;
    for (Volume& v : volumes_) divide_by_time(std::move(v), all);
    std::stable_sort(all.begin(), all.end(), [](const Volume& a, const Volume& b) {
      return std::tie(a.number, a.series) < std::tie(b.number, b.series);
    });
    return all;
  }

  std::vector<std::string> notes() const {
    std::vector<std::string> all;
    if (passed_over_ > 0)
      all.push_back(fmt::format("{} passed over; the first: {}",
                                octafront::counted(passed_over_, "file was", "files were"), first_refusal_));
    return all;
  }

 private:
  void add(std::size_t f) {
    try {
      const KeptFile kept = opened(files_, f);
      const SliceFile file = parse_slices(kept.input);
      refuse_pixels(kept.input, file);
      for (Slice slice : file.slices) {
        slice.file = static_cast<std::uint32_t>(f);
        if (!slice.has_place)
          kept.input.fail("does not say where its slices lie (position, orientation or pixel spacing is missing)");
        checked_sizes(kept.input, {slice.size[0], slice.size[1], 1});
        volume_for(file, slice).slices.push_back(slice);
      }
    } catch (const InputError& error) {
      if (!files_.skip_others) throw;
      if (passed_over_++ == 0) first_refusal_ = error.what();
    }
  }

  /// Series may hold localisers and other planes: those are volumes by themselves.
  Volume& volume_for(const SliceFile& file, const Slice& slice) {
    for (const std::size_t v : volumes_of_[file.series])
      if (volumes_[v].format == file.format && same_plane(volumes_[v].slices[0], slice)) return volumes_[v];
    volumes_of_[file.series].push_back(volumes_.size());
    volumes_.push_back(
        {file.series, file.description, file.modality, file.series_number, file.format, file.syntax.name, {}});
    return volumes_.back();
  }

  /// Sorted along the normal; where each place has as many slices as the others, they are as many volumes.
  void divide_by_time(Volume volume, std::vector<Volume>& out) const {
    const Vec3 normal = normal_of(volume.slices[0]);
    const auto height = [&](const Slice& s) { return dot(s.at, normal); };
    std::sort(volume.slices.begin(), volume.slices.end(), [&](const Slice& a, const Slice& b) {
      return std::tuple(height(a), a.acquisition, a.instance, a.file, a.frame) <
             std::tuple(height(b), b.acquisition, b.instance, b.file, b.frame);
    });
    // A thousandth of a pixel: no two slices are so near.
    const double same = 1e-3 * std::min(volume.slices[0].spacing[0], volume.slices[0].spacing[1]);
    std::vector<std::vector<Slice>> places;
    for (const Slice& s : volume.slices) {
      if (places.empty() || height(s) - height(places.back()[0]) > same) places.emplace_back();
      places.back().push_back(s);
    }
    std::size_t most = 0;
    for (auto& place : places) {
      // Heights within the tolerance are one: then the order is that of time.
      std::sort(place.begin(), place.end(), [](const Slice& a, const Slice& b) {
        return std::tie(a.acquisition, a.instance, a.file, a.frame) <
               std::tie(b.acquisition, b.instance, b.file, b.frame);
      });
      most = std::max(most, place.size());
    }
    for (std::size_t t = 0; t < most; ++t) {
      Volume one = volume;
      one.slices.clear();
      for (const auto& place : places)
        if (t < place.size()) one.slices.push_back(place[t]);
      if (most > 1)
        one.description += fmt::format("{}image {} of {}", one.description.empty() ? "" : ", ", t + 1, most);
      out.push_back(std::move(one));
    }
  }

  const SliceFiles& files_;
  const RunContext& context_;
  std::vector<Volume> volumes_;
  std::map<std::string, std::vector<std::size_t>> volumes_of_;
  std::uint64_t passed_over_ = 0;
  std::string first_refusal_;
};

std::string volume_in_words(const Volume& v) {
  return fmt::format("{} {}, {} of {} x {} pixels", v.modality, io::in_quotes(v.description),
                     octafront::counted(v.slices.size(), "slice"), v.slices[0].size[0], v.slices[0].size[1]);
}

const Volume& chosen(const std::vector<Volume>& volumes, const ImageChoice& choice) {
  if (choice.series == 0 && volumes.size() == 1) return volumes[0];
  if (choice.series != 0 && choice.series <= volumes.size()) return volumes[choice.series - 1];
  std::string list;
  for (std::size_t v = 0; v < volumes.size(); ++v)
    list += fmt::format("\n  {}: {}", v + 1, volume_in_words(volumes[v]));
  throw InputError(fmt::format("holds {}; choose one by its number (`series`):{}",
                               octafront::counted(volumes.size(), "series", "series"), list));
}

/// From slices that are in order to a grid.
class Stack {
 public:
  Stack(const Volume& volume, const SliceFiles& files) : volume_(volume), files_(files), slices_(volume.slices) {}

  ImageGrid grid(std::vector<std::string>& notes) {
    const Slice& first = slices_.front();
    ImageGrid g;
    g.size = {first.size[0], first.size[1], static_cast<std::uint32_t>(slices_.size())};
    g.axes[0] = first.directions[0] * first.spacing[0];
    g.axes[1] = first.directions[1] * first.spacing[1];
    g.origin = first.at;
    if (slices_.size() == 1) {
      if (!(first.thickness > 0)) throw InputError(name(0) + ": is a single slice without thickness: no volume");
      g.axes[2] = normal_of(first) * first.thickness;
      notes.push_back(fmt::format("a single slice, {:.6g} thick; give the folder for all slices", first.thickness));
      return g;
    }
    measure(g, notes);
    return g;
  }

 private:
  std::string name(std::size_t k) const { return files_.names[slices_[k].file]; }
  double height(std::size_t k) const { return dot(slices_[k].at, normal_of(slices_[0])); }

  void measure(ImageGrid& g, std::vector<std::string>& notes) {
    const std::size_t last = slices_.size() - 1;
    const double extent = height(last) - height(0);
    const Vec3 along = (slices_[last].at - slices_[0].at) / extent;  // of height 1, with the shear of a tilted gantry
    std::vector<double> gaps;
    for (std::size_t k = 0; k < last; ++k) gaps.push_back(height(k + 1) - height(k));
    std::vector<double> sorted = gaps;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
    const double usual = sorted[sorted.size() / 2];
    const bool is_even =
        std::all_of(gaps.begin(), gaps.end(), [&](double gap) { return std::abs(gap - usual) <= kJitter * usual; });
    if (is_even) {
      g.axes[2] = along * (extent / static_cast<double>(last));
    } else {
      g.axes[2] = along * usual;
      for (std::size_t k = 0; k <= last; ++k) g.slices.push_back((height(k) - height(0)) / usual);
      tell_gaps(gaps, usual, notes);
    }
    check_line(along);
    tell_tilt(along, notes);
  }

  /// Gaps of two, three and more usual distances lack slices; others are how it was scanned.
  void tell_gaps(const std::vector<double>& gaps, double usual, std::vector<std::string>& notes) const {
    constexpr double kWhole = 0.05;
    std::uint64_t missing = 0;
    std::string places;
    constexpr int kNamed = 5;
    int named = 0;
    double least = usual, most = usual;
    for (std::size_t k = 0; k < gaps.size(); ++k) {
      const double n = std::round(gaps[k] / usual);
      least = std::min(least, gaps[k]);
      most = std::max(most, gaps[k]);
      if (n < 2 || std::abs(gaps[k] / usual - n) > kWhole) continue;
      missing += static_cast<std::uint64_t>(n) - 1;
      if (named++ < kNamed)
        places += fmt::format("{}{:.0f} between {} and {}", places.empty() ? "" : ", ", n - 1, name(k), name(k + 1));
    }
    if (missing > 0)
      notes.push_back(fmt::format("{} missing: {}{}; the neighbours are taken to reach into the gaps",
                                  octafront::counted(missing, "slice is", "slices are"), places,
                                  named > kNamed ? ", ..." : ""));
    notes.push_back(fmt::format("slices are {:.6g} to {:.6g} apart; each is kept where it lies", least, most));
  }

  void check_line(Vec3 along) const {
    const double pixel = std::min(slices_[0].spacing[0], slices_[0].spacing[1]);
    for (std::size_t k = 0; k < slices_.size(); ++k) {
      const Vec3 expected = slices_[0].at + along * (height(k) - height(0));
      // More than half a pixel aside is no rounding.
      if (distance(expected, slices_[k].at) > 0.5 * pixel)
        throw InputError(
            fmt::format("{}: lies {:.4g} beside the line of its series' first and last slices; such a stack "
                        "is no volume: choose its files by hand",
                        name(k), distance(expected, slices_[k].at)));
    }
  }

  void tell_tilt(Vec3 along, std::vector<std::string>& notes) const {
    const double tilt = elementary::acos(std::clamp(1 / length(along), -1.0, 1.0)) * 180 / M_PI;
    constexpr double kSaid = 0.05;  // degrees
    if (tilt > kSaid)
      notes.push_back(fmt::format("slices are sheared by {:.4g} degrees (a tilted gantry); that is kept", tilt));
  }

  const Volume& volume_;
  const SliceFiles& files_;
  const std::vector<Slice>& slices_;
};

bool is_whole(double x) {
  return x == std::floor(x) && std::abs(x) < 0x1p31;
}

/// The files of several frames that have to be unpacked, each once, by their numbers.
std::map<std::uint32_t, KeptFile> unpacked_files(const Volume& volume, const SliceFiles& files) {
  std::map<std::uint32_t, std::size_t> frames;
  for (const Slice& s : volume.slices) ++frames[s.file];
  std::map<std::uint32_t, KeptFile> all;
  for (const auto& [f, n] : frames) {
    if (n == 1) continue;
    const KeptFile kept = opened(files, f);
    if (!parse_slices(kept.input).syntax.is_readable) all[f] = unpacked(kept);
  }
  return all;
}

/// The voxels of a volume, each file read once more.
Image::Values values_of(const Volume& volume, const SliceFiles& files, const RunContext& context,
                        std::vector<std::string>& notes) {
  const std::size_t each = std::size_t{volume.slices[0].size[0]} * volume.slices[0].size[1];
  bool whole = true;
  for (const Slice& s : volume.slices) whole = whole && is_whole(s.slope) && is_whole(s.intercept);
  std::vector<std::int32_t> numbers(whole ? each * volume.slices.size() : 0);
  std::vector<float> reals(whole ? 0 : each * volume.slices.size());
  const std::map<std::uint32_t, KeptFile> ready = unpacked_files(volume, files);
  // Frames of one file lie behind one another in the order of places: the same file is opened for each.
  parallel_for(
      volume.slices.size(),
      [&](std::size_t k) {
        context.check();
        const Slice& s = volume.slices[k];
        const auto found = ready.find(s.file);
        KeptFile kept = found != ready.end() ? found->second : opened(files, s.file);
        SliceFile file = parse_slices(kept.input);
        if (!file.syntax.is_readable) {
          kept = unpacked(kept);
          file = parse_slices(kept.input);
        }
        std::vector<std::int32_t> stored(each);
        read_pixels(kept.input, file, s, stored.data());
        for (std::size_t i = 0; i < each; ++i) {
          const double v = s.slope * stored[i] + s.intercept;
          if (whole) {
            constexpr double kMost = std::numeric_limits<std::int32_t>::max();
            numbers[k * each + i] = static_cast<std::int32_t>(std::clamp(v, -kMost, kMost));
          } else {
            constexpr double kMost = std::numeric_limits<float>::max();
            reals[k * each + i] = static_cast<float>(std::clamp(v, -kMost, kMost));
          }
        }
      },
      Split::kSingly);
  if (!whole) return reals;
  return narrowed(numbers, notes);
}

/// A frame takes a byte per 64 pixels at least: nothing is allocated for what no file can hold. What the JPEG families
/// pack, where a slice of air is a few bytes, is compared with the memory that there is.
void check_room(const Volume& volume, const SliceFiles& files) {
  const std::uint64_t each = std::uint64_t{volume.slices[0].size[0]} * volume.slices[0].size[1];
  std::map<std::uint32_t, std::uint64_t> frames;
  for (const Slice& s : volume.slices) ++frames[s.file];
  for (const auto& [f, n] : frames) {
    const KeptFile kept = opened(files, f);
    if (!parse_slices(kept.input).syntax.is_readable) {
      require_memory_for(kept.input, each * volume.slices.size(), VoxelType::kInt32);
      continue;
    }
    if (each * n > 64 * std::uint64_t{kept.input.bytes.size()})
      kept.input.fail(fmt::format(
          "claims {} of {} x {} pixels, more than its {} bytes can hold; it is truncated or damaged",
          octafront::counted(n, "frame"), volume.slices[0].size[0], volume.slices[0].size[1], kept.input.bytes.size()));
  }
}

}  // namespace

Image read_series(const SliceFiles& files, const ImageChoice& choice, const RunContext& context) {
  const ThreadLimit limit(context.threads);
  Collector collector(files, context);
  const std::vector<Volume> volumes = collector.collect();
  const Volume& volume = chosen(volumes, choice);
  check_room(volume, files);
  Image image;
  image.notes = collector.notes();
  image.format = fmt::format("DICOM, {}, {}", volume.syntax, volume_in_words(volume));
  image.unit = "mm";
  image.frame = "LPS";
  image.grid = Stack(volume, files).grid(image.notes);
  const KeptFile first = opened(files, volume.slices[0].file);
  checked_sizes(first.input, {image.grid.size[0], image.grid.size[1], image.grid.size[2]});
  check_grid(first.input, image.grid);
  context.report("reading", 0.5);
  image.values = values_of(volume, files, context, image.notes);
  return image;
}

Image read_dicom(const Reading& reading) {
  const KeptFile plain = inflated({reading.input, nullptr});
  if (const SliceFile file = parse_slices(plain.input); file.is_segmentation())
    return read_segmentation(plain.input, file);
  const SliceFiles one{{reading.input.name}, [&](std::size_t) { return plain; }};
  try {
    return read_series(one, reading.choice, reading.input.context);
  } catch (const InputError& error) {
    const std::string what = error.what();
    throw InputError(what.starts_with(reading.input.name) ? what : reading.input.name + ": " + what);
  }
}

std::vector<std::string> dicom_files_in(const std::string& folder, const RunContext& context) {
  require_in_folders(folder);
  std::vector<std::string> files;
  std::uint64_t seen = 0;
  constexpr std::uint64_t kMostFiles = 200000;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, fs::directory_options::skip_permission_denied, error), end;
       it != end; it.increment(error)) {
    if (error) break;
    context.check();
    if (++seen > kMostFiles)
      throw InputError(fmt::format("{}: holds more than {} files; give the folder of one study", folder, kMostFiles));
    std::error_code ignored;
    if (!it->is_regular_file(ignored)) continue;
    std::array<char, 256> head{};
    require_in_folders(it->path().string());
    std::ifstream stream(it->path(), std::ios::binary);
    stream.read(head.data(), head.size());
    if (is_dicom({head.data(), static_cast<std::size_t>(stream.gcount())})) files.push_back(it->path().string());
  }
  if (error) throw InputError(fmt::format("{}: cannot be read: {}", folder, error.message()));
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace octafront::image
