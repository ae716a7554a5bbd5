#pragma once

#include <octafront/io.h>

#include "formats/containers/input.h"
#include "formats/containers/scanner.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace octafront::io {

/// Collects the points and faces of a file, in any order, and makes a SurfaceFile of them.
class SurfaceBuilder {
 public:
  std::vector<Vec3> points;
  std::vector<std::string> patch_names, region_names;
  std::vector<std::string> notes;

  /// A face of the file with its corners counted from 0; `at` is where it stands in the file. Faces of fewer than three
  /// corners are counted and left out.
  void add_face(std::span<const std::uint32_t> corners, const char* at, std::uint32_t patch = 0);
  /// The same of a format that knows the regions on both sides of every face.
  void add_face(std::span<const std::uint32_t> corners, const char* at, std::uint32_t patch, Sides sides);
  /// All faces of a file at once, where all are triangles on points that there are. `patch`: one each, or none.
  void set_triangles(std::vector<Triangle> triangles, std::vector<std::uint32_t> patch = {});
  void reserve_faces(std::size_t count);
  std::size_t faces() const { return faces_; }

  /// Checks all corners, divides the polygons. `first_index` is what the format counts vertices from (0 or 1), for
  /// messages; `is_text` says whether places are lines or bytes. Throws InputError also if there are no triangles.
  SurfaceFile finish(const Input& input, std::string format, bool is_text, int first_index);

 private:
  struct Polygon {
    std::size_t first_corner;
    std::size_t triangles_before;
    std::uint32_t face, patch, corners;
    const char* at;
  };

  void check_corners(const Input& input, bool is_text, int first_index) const;
  void divide_polygons(const Input& input, bool is_text);
  bool divide(const Polygon& polygon, SurfaceBuilder& divided, const Input& input, bool is_text);
  void add_triangle(const Triangle& t, std::uint32_t face, std::uint32_t patch);

  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> face_of_triangle_;
  std::vector<std::uint32_t> patch_;  ///< empty while all are 0
  std::vector<Polygon> polygons_;
  std::vector<std::uint32_t> polygon_corners_;
  std::vector<Sides> sides_of_face_;  ///< one per face, or empty
  std::uint64_t faces_ = 0, small_faces_ = 0;
  std::uint32_t largest_corner_ = 0;
  std::uint32_t largest_corner_face_ = 0;
  const char* largest_corner_at_ = nullptr;
};

/// What a header says will come: `count` records of at least `bytes_each` bytes; `what` they are, in the plural.
struct Claim {
  std::uint64_t count, bytes_each;
  std::string_view what;
};

/// Throws InputError unless what is claimed fits into the `bytes_left` behind `at`: a header is believed only as far as
/// the file can hold it. Also if the count exceeds 32-bit indices.
void check_claim(const Input& input, const char* at, const Claim& claim, std::uint64_t bytes_left);
/// Reads the number of what follows, of which each takes `least_bytes` or more.
std::uint64_t read_count(Scanner& scan, const Input& input, std::string_view what, std::uint64_t least_bytes);
/// The same, where something else is said to be expected.
std::uint64_t read_count(Scanner& scan, const Input& input, std::string_view expected, std::string_view what,
                         std::uint64_t least_bytes);

}  // namespace octafront::io
