#include "formats/containers/file_head.h"

#include "formats/containers/scanner.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

namespace octafront::io {
namespace {

using namespace std::string_view_literals;

struct Magic {
  std::size_t offset;
  std::string_view bytes;
  std::string_view what;
};

constexpr std::array kMagics{
    Magic{0, "\x89PNG"sv, "a PNG image"},
    Magic{0, "\xff\xd8\xff"sv, "a JPEG image"},
    Magic{0, "GIF8"sv, "a GIF image"},
    Magic{0, "II*\0"sv, "a TIFF image"},
    Magic{0, "MM\0*"sv, "a TIFF image"},
    Magic{0, "%PDF"sv, "a PDF document"},
    Magic{0, "\x1f\x8b"sv, "compressed by gzip: unpack it first (gunzip)"},
    Magic{0, "BZh"sv, "compressed by bzip2: unpack it first (bunzip2)"},
    Magic{0,
          "\xfd"
          "7zXZ"sv,
          "compressed by xz: unpack it first (unxz)"},
    Magic{0, "\x28\xb5\x2f\xfd"sv, "compressed by zstd: unpack it first (unzstd)"},
    Magic{0, "7z\xbc\xaf"sv, "a 7-Zip archive: unpack it first"},
    Magic{0, "PK\x03\x04"sv, "a ZIP archive (or 3MF, which is one): unpack it, or export STL, OBJ, OFF or PLY"},
    Magic{0, "\x89HDF"sv, "an HDF5 file"},
    Magic{0, "CDF\x01"sv, "a NetCDF file"},
    Magic{0,
          "\x7f"
          "ELF"sv,
          "a program"},
    Magic{0, "glTF"sv, "a glTF model: export it as STL, OBJ, OFF or PLY"},
    Magic{0, "Kaydara FBX"sv, "an FBX model: export it as STL, OBJ, OFF or PLY"},
    Magic{0, "BLENDER"sv, "a Blender file: export it as STL, OBJ or PLY"},
    Magic{0, "ISO-10303-21"sv, "a STEP model: it is read where a whole input is (`octafront mesh`), not as a surface"},
    Magic{0, "DBRep_DrawableShape"sv,
          "an OpenCASCADE BREP model: it is read where a whole input is (`octafront mesh`), not as a surface"},
    Magic{0, "CASCADE Topology"sv,
          "an OpenCASCADE BREP model: it is read where a whole input is (`octafront mesh`), not as a surface"},
    Magic{0, "#VRML"sv, "a VRML scene: export it as STL, OBJ, OFF or PLY"},
    Magic{0, "# vtk DataFile"sv, "a legacy VTK file: convert it to PLY or STL (ParaView does it)"},
    Magic{0, "version https://git-lfs"sv, "a Git LFS pointer, not the file itself: fetch it with `git lfs pull`"},
    Magic{0, "$MeshFormat"sv, "a Gmsh mesh"},
    Magic{0, "MeshVersionFormatted"sv, "a MEDIT mesh"},
    Magic{0, "mesh3d"sv, "a Netgen mesh"},
    Magic{0, "*KEYWORD"sv, "an LS-DYNA file"},
    Magic{0, "CDF\x02"sv, "a NetCDF file"},
    Magic{0, "CDF\x05"sv, "a NetCDF file"},
    Magic{128, "DICM"sv, "a DICOM image"},
    Magic{344, "n+1\0"sv, "a NIfTI image"},
    Magic{0, "NRRD"sv, "an NRRD image"},
    Magic{0, "\xff\xfe"sv, "a text in UTF-16: save it as UTF-8"},
    Magic{0, "\xfe\xff"sv, "a text in UTF-16: save it as UTF-8"},
};

std::string_view head_of(std::string_view bytes) {
  return bytes.substr(0, 4096);
}

std::string_view without_byte_order_mark(std::string_view bytes) {
  return bytes.starts_with("\xef\xbb\xbf") ? bytes.substr(3) : bytes;
}

std::string_view xml_kind(std::string_view head) {
  if (head.find("<VTKFile") != std::string_view::npos) {
    return head.find("UnstructuredGrid") != std::string_view::npos
               ? "a VTK unstructured grid (.vtu)"
               : "a VTK XML file of another type than UnstructuredGrid";
  }
  for (const std::string_view tag : {"<!DOCTYPE html", "<!doctype html", "<html", "<HTML", "<head", "<body"})
    if (head.find(tag) != std::string_view::npos) return "a web page (was the download an error page?)";
  if (head.find("<Xdmf") != std::string_view::npos) return "an XDMF mesh";
  if (head.find("<febio_spec") != std::string_view::npos) return "an FEBio file";
  if (head.find("<COLLADA") != std::string_view::npos) return "a COLLADA scene: export it as STL, OBJ, OFF or PLY";
  if (head.find("<amf") != std::string_view::npos) return "an AMF model: export it as STL, OBJ, OFF or PLY";
  if (head.find("<X3D") != std::string_view::npos) return "an X3D scene: export it as STL, OBJ, OFF or PLY";
  return "an XML file";
}

/// IGES has fixed lines of 80 columns with a section letter and a number at the end.
bool looks_like_iges(std::string_view bytes) {
  return bytes.size() >= 81 && bytes.substr(72, 8) == "S      1" && (is_line_end(bytes[80]) || bytes[80] == ' ');
}

std::uint32_t stl_count(std::string_view bytes) {
  const auto at = [&](std::size_t i) { return std::uint32_t{static_cast<unsigned char>(bytes[80 + i])}; };
  return at(0) | at(1) << 8 | at(2) << 16 | at(3) << 24;
}

}  // namespace

bool looks_binary(std::string_view bytes) {
  return std::any_of(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(head_of(bytes).size()), [](char c) {
    const auto u = static_cast<unsigned char>(c);
    return u < 0x20 && !is_blank(c) && u != 0x1a && u != 0x1b;
  });
}

std::string_view well_known_kind(std::string_view bytes) {
  for (const Magic& magic : kMagics)
    if (bytes.size() >= magic.offset && bytes.substr(magic.offset).starts_with(magic.bytes)) return magic.what;
  const std::string_view text = without_byte_order_mark(bytes);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first != std::string_view::npos && text[first] == '<') return xml_kind(head_of(text));
  if (looks_like_iges(bytes))
    return "an IGES model: it is read where a whole input is (`octafront mesh`), not as a surface";
  return {};
}

bool is_binary_stl(std::string_view head, std::uint64_t size) {
  return head.size() >= 84 && size == 84 + std::uint64_t{50} * stl_count(head);
}

FileHead::FileHead(const Input& file)
    : input(file), kind(well_known_kind(file.bytes)), is_binary(looks_binary(file.bytes)) {
  Scanner scan(file, '#');
  first = scan.word();
  second = scan.word();
}

bool FileHead::ends_in(std::initializer_list<std::string_view> endings) const {
  const std::string ending = std::filesystem::path(input.name).extension().string();
  return std::any_of(endings.begin(), endings.end(),
                     [&](std::string_view e) { return equal_ignoring_case(ending, e); });
}

bool FileHead::has_line(std::string_view word) const {
  constexpr std::size_t kHead = std::size_t{1} << 16;
  const std::string_view head = input.bytes.substr(0, kHead);
  for (std::size_t at = head.find(word); at != std::string_view::npos; at = head.find(word, at + 1))
    if (at == 0 || is_line_end(head[at - 1])) return true;
  return false;
}

bool is_plain_number(std::string_view word) {
  return !word.empty() && word.find_first_not_of("0123456789") == std::string_view::npos;
}

}  // namespace octafront::io
