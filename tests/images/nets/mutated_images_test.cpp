// Files of images, damaged by what happens to files and by what readers must not trust: every one ends, with a sound
// image, whose surface is made if it is small, or with a reason. bench/campaigns/mutated-images.sh runs more of them.

#include <octafront/image_surface.h>

#include "fuzz/image_oracle.h"
#include "support/random.h"

#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

namespace fs = std::filesystem;

struct Seed {
  std::string name, bytes;
};

/// The readers' corpus, in the order of names.
std::vector<Seed> seeds() {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(OCTAFRONT_CORPUS) / "image")) {
    std::ifstream in(entry.path(), std::ios::binary);
    files[entry.path().filename().string()] = {std::istreambuf_iterator<char>(in), {}};
  }
  std::vector<Seed> all;
  for (auto& [name, bytes] : files) all.push_back({name, std::move(bytes)});
  return all;
}

std::size_t place_in(const std::string& bytes, testing::Random& random) {
  return static_cast<std::size_t>(random.bits() % std::max<std::size_t>(bytes.size(), 1));
}

/// A number that headers should not have, or seldom have.
double odd_number(testing::Random& random) {
  constexpr std::array kOdd{0.0,
                            -0.0,
                            1.0,
                            -1.0,
                            2.0,
                            3.0,
                            0.5,
                            1e-3,
                            1e-300,
                            1e17,
                            1.8e19,
                            1e38,
                            1e300,
                            255.0,
                            256.0,
                            348.0,
                            1e9,
                            65536.0,
                            -1e12,
                            4e9,
                            2147483647.0,
                            4294967296.0,
                            std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()};
  return kOdd[random.bits() % kOdd.size()];
}

template <class T>
void overwrite(std::string& bytes, std::size_t at, T value, bool turned) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof(T));
  if (turned) std::reverse(raw.begin(), raw.end());
  for (std::size_t i = 0; i < raw.size() && at + i < bytes.size(); ++i) bytes[at + i] = raw[i];
}

/// A binary field, aligned as fields are.
void change_field(std::string& bytes, testing::Random& random) {
  const double value = odd_number(random);
  const bool turned = random.integer(0, 3) == 0;
  const std::size_t at = place_in(bytes, random) & ~std::size_t{1};
  const auto whole = std::isfinite(value) && std::abs(value) < 9e18 ? static_cast<std::int64_t>(value) : -1;
  switch (random.integer(0, 4)) {
    case 0:
      return overwrite(bytes, at, static_cast<std::int16_t>(whole), turned);
    case 1:
      return overwrite(bytes, at & ~std::size_t{3}, static_cast<std::int32_t>(whole), turned);
    case 2:
      return overwrite(bytes, at & ~std::size_t{7}, whole, turned);
    case 3:
      // Beyond the largest float the cast has no answer.
      return overwrite(bytes, at & ~std::size_t{3},
                       std::abs(value) > 1e38 ? std::numeric_limits<float>::infinity() : static_cast<float>(value),
                       turned);
    default:
      return overwrite(bytes, at & ~std::size_t{7}, value, turned);
  }
}

/// A number in a text, by another one; a bit where there is none.
void change_number(std::string& bytes, testing::Random& random) {
  const std::size_t from = place_in(bytes, random);
  const std::size_t at = bytes.find_first_of("0123456789", from);
  if (at == std::string::npos) return change_field(bytes, random);
  const std::size_t end = std::min(bytes.find_first_not_of("0123456789.eE+-", at), bytes.size());
  std::ostringstream text;
  text << odd_number(random);
  bytes.replace(at, end - at, text.str());
}

void flip_bits(std::string& bytes, testing::Random& random) {
  if (bytes.empty()) return;
  for (int n = random.integer(1, 4); n > 0; --n) {
    char& c = bytes[place_in(bytes, random)];
    c = static_cast<char>(static_cast<unsigned char>(c) ^ (1u << random.integer(0, 7)));
  }
}

void cut_or_repeat(std::string& bytes, testing::Random& random) {
  const std::size_t at = place_in(bytes, random), length = static_cast<std::size_t>(random.integer(1, 64));
  switch (random.integer(0, 3)) {
    case 0:
      bytes.resize(at);
      return;
    case 1:
      bytes.erase(at, length);
      return;
    case 2:
      bytes.insert(at, bytes.substr(at, length));
      return;
    default:
      bytes.insert(at, length, static_cast<char>(random.integer(0, 255)));
  }
}

/// The head of one file, the rest of another.
void splice(std::string& bytes, const std::string& other, testing::Random& random) {
  bytes = bytes.substr(0, place_in(bytes, random)) + other.substr(place_in(other, random));
}

/// A line of a text where another one was, or once more.
void move_line(std::string& bytes, testing::Random& random) {
  const auto line_at = [&](std::size_t at) {
    const std::size_t begin = bytes.rfind('\n', at), end = bytes.find('\n', at);
    return std::array{begin == std::string::npos ? 0 : begin + 1, end == std::string::npos ? bytes.size() : end + 1};
  };
  const auto [begin, end] = line_at(place_in(bytes, random));
  const std::string line = end > begin ? bytes.substr(begin, end - begin) : "";
  if (random.integer(0, 1) == 0 && end > begin) bytes.erase(begin, end - begin);
  bytes.insert(line_at(place_in(bytes, random))[0], line);
}

std::string mutated(const std::vector<Seed>& all, testing::Random& random) {
  std::string bytes = all[random.bits() % all.size()].bytes;
  for (int n = random.integer(1, 3); n > 0; --n) {
    const int kind = random.integer(0, 9);
    if (kind < 3)
      change_number(bytes, random);
    else if (kind < 6)
      change_field(bytes, random);
    else if (kind == 6)
      flip_bits(bytes, random);
    else if (kind == 7)
      cut_or_repeat(bytes, random);
    else if (kind == 8)
      move_line(bytes, random);
    else
      splice(bytes, all[random.bits() % all.size()].bytes, random);
  }
  return bytes;
}

/// The surface of a small image, of labels or of the upper half of its values; refusals are answers.
testing::Broken broken_by_surface(const Image& image) {
  if (testing::Broken broken = testing::broken_by_cleaning(image); !broken.empty()) return broken;
  if (image.grid.voxels() > 512) return {};
  const Complex complex = [&] {
    if (looks_like_labels(image)) return complex_of_image(image);
    ImageRegions regions;
    const double middle = std::visit(
        [](const auto& values) {
          const auto [least, largest] = std::minmax_element(values.begin(), values.end());
          return 0.5 * static_cast<double>(*least) + 0.5 * static_cast<double>(*largest);
        },
        image.values);
    regions.bands.push_back({middle, std::numeric_limits<double>::infinity(), ""});
    return complex_of_image(image, regions);
  }();
  if (complex.surface.triangles.empty()) return "a surface without triangles";
  for (const Vec3& p : complex.surface.points)
    if (!is_finite(p)) return "a vertex at no finite place";
  return {};
}

TEST(MutatedImages, EndSoundOrWithAReason) {
  const char* asked = std::getenv("OCTAFRONT_MUTATED_IMAGES");
  const int cases = asked != nullptr ? std::atoi(asked) : 1000;
  const std::vector<Seed> all = seeds();
  ASSERT_GT(all.size(), 40u);
  int read = 0;
  for (int number = 0; number < cases; ++number) {
    testing::Random random(static_cast<std::uint64_t>(number));
    const std::string bytes = mutated(all, random);
    testing::Broken broken;
    try {
      broken = testing::read_any(bytes, broken_by_surface, read);
    } catch (const std::exception& error) {
      broken = error.what();
    }
    EXPECT_EQ(broken, "") << "case " << number;
    if (!broken.empty()) std::ofstream("mutated_image_" + std::to_string(number), std::ios::binary) << bytes;
  }
  // Else they are damaged too much to say anything.
  EXPECT_GT(read, cases / 5);
}

}  // namespace
}  // namespace octafront
