#include "io/formats.h"

#include "io/scanner.h"
#include "io/writers.h"

#include <array>

namespace octafront::io {
namespace {

constexpr bool kYes = true, kNo = false;

// name, ending, reads surface, writes surface, reads mesh, writes mesh, what it carries
constexpr std::array<Format, 7> kFormats{{
    {{"STL", ".stl", kYes, kYes, kNo, kNo,
      "read as text or binary, written binary: single precision, no shared vertices, no patches (read: named solids)"},
     write_stl,
     nullptr},
    {{"OBJ", ".obj", kYes, kYes, kNo, kNo, "double precision, patches by name as groups"}, write_obj, nullptr},
    {{"OFF", ".off", kYes, kYes, kNo, kNo, "double precision, no patches"}, write_off, nullptr},
    {{"PLY", ".ply", kYes, kYes, kNo, kNo,
      "read as text or binary, written binary: double precision, patches with names"},
     write_ply,
     nullptr},
    {{"VTU", ".vtu", kNo, kNo, kYes, kYes,
      "VTK unstructured grid, binary and compressed: double precision, region, patch with names, input face, beta"},
     nullptr,
     write_vtu},
    {{"Gmsh", ".msh", kNo, kNo, kYes, kYes,
      "Gmsh 4.1, written binary: double precision, regions and patches as physical groups with names"},
     nullptr,
     write_msh},
    {{"MEDIT", ".mesh", kNo, kNo, kYes, kYes, "text: double precision, regions and patches as references"},
     nullptr,
     write_medit},
}};

}  // namespace

std::span<const Format> formats() {
  return kFormats;
}

const Format* format_of(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  for (const Format& format : kFormats)
    if (equal_ignoring_case(ending, format.info.ending)) return &format;
  return nullptr;
}

std::string endings_that(bool FormatInfo::*can) {
  std::string endings;
  for (const Format& format : kFormats) {
    if (!(format.info.*can)) continue;
    if (!endings.empty()) endings += ", ";
    endings += format.info.ending;
  }
  return endings;
}

}  // namespace octafront::io

namespace octafront {

std::vector<FormatInfo> known_formats() {
  std::vector<FormatInfo> all;
  for (const io::Format& format : io::formats()) all.push_back(format.info);
  return all;
}

}  // namespace octafront
