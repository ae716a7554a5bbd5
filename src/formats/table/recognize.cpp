#include "formats/table/recognize.h"

#include "formats/containers/scanner.h"
#include "formats/table/formats.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <optional>

#include <fmt/core.h>

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

bool is_off_keyword(std::string_view word) {
  const std::size_t off = word.rfind("OFF");
  if (off == std::string_view::npos) return word == "off";
  // Some collections glue the first count to the keyword: "OFF8".
  const std::string_view before = word.substr(0, off), behind = word.substr(off + 3);
  return before.size() <= 6 && before.find_first_not_of("STCN4n") == std::string_view::npos &&
         behind.find_first_not_of("0123456789") == std::string_view::npos;
}

bool is_obj_keyword(std::string_view word) {
  constexpr std::array kWords{"v"sv,      "vt"sv,  "vn"sv,     "vp"sv,     "f"sv,   "fo"sv,   "g"sv,
                              "o"sv,      "s"sv,   "usemtl"sv, "mtllib"sv, "l"sv,   "p"sv,    "mg"sv,
                              "cstype"sv, "deg"sv, "usemap"sv, "maplib"sv, "lod"sv, "bevel"sv};
  return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
}

/// True if the first lines that are neither blank nor comments all begin with words of the format.
bool looks_like_obj(const Input& input) {
  Scanner scan(input, '#');
  int lines = 0;
  for (; lines < 16 && !scan.at_end(); ++lines) {
    if (!is_obj_keyword(scan.word())) return false;
    while (scan.rest_of_line().ends_with('\\')) scan.at_end();
  }
  return lines > 0;
}

bool is_plain_number(std::string_view word) {
  return !word.empty() && word.find_first_not_of("0123456789") == std::string_view::npos;
}

[[noreturn]] void fail_unknown(const Input& input, std::string_view wanted) {
  input.fail(fmt::format("is not a file of a kind that is known here ({}); it begins with {}", wanted,
                         in_quotes(head_of(input.bytes).substr(0, 24))));
}

[[noreturn]] void fail_other_kind(const Input& input, std::string_view kind, std::string_view wanted) {
  const std::string_view verb = kind.starts_with("compressed") ? "is " : "looks like ";
  input.fail(fmt::format("{}{}; expected {}", verb, kind, wanted));
}

bool claims_to_be_stl(const Input& input) {
  const Format* format = format_of(input.name);
  return format != nullptr && format->info.name == "stl";
}

constexpr std::string_view kSurfaces =
    "a surface as STL, OBJ, OFF, PLY, TetGen .poly or .smesh, or a mesh of one of the formats that are read";
constexpr std::string_view kMeshes =
    "a mesh as VTU, VTK, Gmsh .msh, Abaqus .inp, Nastran .bdf, I-deas .unv, MED, XDMF, MEDIT .mesh or .meshb, Netgen "
    ".vol "
    "or TetGen .ele";

/// A line of the first ones that begins with a word.
bool has_line(std::string_view bytes, std::string_view word) {
  constexpr std::size_t kHead = std::size_t{1} << 16;
  const std::string_view head = bytes.substr(0, kHead);
  for (std::size_t at = head.find(word); at != std::string_view::npos; at = head.find(word, at + 1))
    if (at == 0 || is_line_end(head[at - 1])) return true;
  return false;
}

bool ends_in(const Input& input, std::initializer_list<std::string_view> endings) {
  const std::string ending = std::filesystem::path(input.name).extension().string();
  return std::any_of(endings.begin(), endings.end(),
                     [&](std::string_view e) { return equal_ignoring_case(ending, e); });
}

bool is_binary_medit(std::string_view bytes) {
  // In either byte order: 1, and the version.
  constexpr std::string_view kOne("\x01\0\0\0"sv), kSwapped("\0\0\0\x01\0\0\0"sv);
  if (bytes.size() <= 8) return false;
  return (bytes.starts_with(kOne) && bytes[4] >= 1 && bytes[4] <= 4) ||
         (bytes.starts_with(kSwapped) && bytes[7] >= 1 && bytes[7] <= 4);
}

/// Whether well_known_kind() says that it is a mesh which is read here.
bool is_mesh(std::string_view kind) {
  return kind.find("unstructured grid") != std::string_view::npos ||
         kind.find("legacy VTK") != std::string_view::npos || kind == "an XDMF mesh" || kind == "an HDF5 file" ||
         kind == "a Netgen mesh";
}

/// Formats that are told by their text; none of them has a magic word.
std::optional<MeshKind> text_kind(const Input& input, std::string_view first, std::string_view second) {
  if (first == "mesh3d") return MeshKind::kNetgen;
  if (first == "-1" && is_plain_number(second) && second.size() <= 5) return MeshKind::kUnv;
  if (input.bytes.starts_with("*KEYWORD")) return std::nullopt;
  if (ends_in(input, {".ele", ".node"})) return MeshKind::kTetgen;
  if (ends_in(input, {".bdf", ".nas"}) || has_line(input.bytes, "BEGIN BULK") || has_line(input.bytes, "GRID") ||
      has_line(input.bytes, "CTETRA"))
    return MeshKind::kNastran;
  if (first.starts_with('*') && first.size() > 1) return MeshKind::kAbaqus;
  return std::nullopt;
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

SurfaceKind recognize_surface(const Input& input) {
  const std::string_view bytes = input.bytes;
  // Before words: many binary STL files begin with "solid" all the same.
  if (is_binary_stl(bytes, bytes.size())) return SurfaceKind::kBinaryStl;
  if (bytes.starts_with("ply") && (bytes.size() == 3 || is_blank(bytes[3]))) return SurfaceKind::kPly;
  Scanner scan(input, '#');
  const std::string_view first = scan.word();
  if (first == "$MeshFormat") return SurfaceKind::kMsh;
  if (first.starts_with("MeshVersionFormatted")) return SurfaceKind::kMedit;
  if (is_binary_medit(bytes)) return SurfaceKind::kMeditBinary;
  if (const std::string_view kind = well_known_kind(bytes); !kind.empty()) {
    if (is_mesh(kind)) return SurfaceKind::kOtherMesh;
    fail_other_kind(input, kind, kSurfaces);
  }
  if (ends_in(input, {".poly", ".smesh"})) return SurfaceKind::kPoly;
  if (is_off_keyword(first)) return SurfaceKind::kOff;
  const bool binary = looks_binary(bytes);
  if (!binary && equal_ignoring_case(first, "solid")) return SurfaceKind::kAsciiStl;
  if (!binary && looks_like_obj(input)) return SurfaceKind::kObj;
  // Binary STL of a wrong size: the reader says what is missing, or that bytes follow.
  if (binary && (claims_to_be_stl(input) || equal_ignoring_case(first, "solid"))) return SurfaceKind::kBinaryStl;
  // The keyword OFF may be missing.
  const Format* format = format_of(input.name);
  if (!binary && format != nullptr && format->info.name == "off" && is_plain_number(first)) return SurfaceKind::kOff;
  if (first.empty()) input.fail("holds nothing but blanks and comments; export it again");
  if (!binary && text_kind(input, first, scan.word())) return SurfaceKind::kOtherMesh;
  fail_unknown(input, kSurfaces);
}

MeshKind recognize_mesh(const Input& input) {
  Scanner scan(input, '#');
  const std::string_view first = scan.word();
  if (first == "$MeshFormat") return MeshKind::kMsh;
  if (first.starts_with("MeshVersionFormatted")) return MeshKind::kMedit;
  const std::string_view kind = well_known_kind(input.bytes);
  if (kind.find("unstructured grid") != std::string_view::npos) return MeshKind::kVtu;
  if (kind.find("legacy VTK") != std::string_view::npos) return MeshKind::kVtk;
  if (kind == "an XDMF mesh") return MeshKind::kXdmf;
  if (kind == "an HDF5 file") return MeshKind::kHdf5;
  if (is_binary_medit(input.bytes)) return MeshKind::kMeditBinary;
  if (const auto text = text_kind(input, first, scan.word())) return *text;
  if (!kind.empty()) fail_other_kind(input, kind, kMeshes);
  if (scan.at_end() && first.empty()) input.fail("holds nothing but blanks and comments; export it again");
  // Comments of Gmsh are sections like any other and may come first.
  if (first.starts_with('$') && input.bytes.find("$MeshFormat") != std::string_view::npos) return MeshKind::kMsh;
  fail_unknown(input, kMeshes);
}

}  // namespace octafront::io
