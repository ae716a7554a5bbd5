#include "read.h"

#include "pipe.h"
#include "unpack.h"

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace octafront::cad {

namespace {

enum class Format { kStep, kIges, kBrep, kBinaryBrep, kUnknown };

std::string beginning_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string bytes(4096, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

bool ends_with(const std::string& name, std::initializer_list<const char*> endings) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const char* gz : {"", ".gz", "z"})
    for (const char* ending : endings)
      if (lower.ends_with(std::string(ending) + gz)) return true;
  return false;
}

/// An IGES file has lines of 80 characters, the first of its start section: S in column 73.
bool looks_like_iges(const std::string& head) {
  return head.size() >= 80 && head[72] == 'S' &&
         std::all_of(head.begin() + 73, head.begin() + 80, [](unsigned char c) { return c == ' ' || std::isdigit(c); });
}

Format format_of(const std::string& head, const std::string& file) {
  const auto holds = [&](const char* text) { return head.find(text) != std::string::npos; };
  if (holds("ISO-10303-21")) return Format::kStep;
  if (holds("Open CASCADE Topology V")) return Format::kBinaryBrep;
  if (holds("DBRep_DrawableShape") || holds("CASCADE Topology V")) return Format::kBrep;
  if (looks_like_iges(head)) return Format::kIges;
  if (ends_with(file, {".step", ".stp", ".p21"})) return Format::kStep;
  if (ends_with(file, {".iges", ".igs"})) return Format::kIges;
  if (ends_with(file, {".brep", ".brp"})) return Format::kBrep;
  return Format::kUnknown;
}

/// Where in the file a reading that failed had come to.
std::string place_of_end(std::ifstream& in, const std::string& path) {
  in.exceptions(std::ios::goodbit);
  in.clear();
  const auto at = in.tellg();
  std::error_code none;
  const auto size = std::filesystem::file_size(path, none);
  return fmt::format("it is {} {} of {}",
                     static_cast<double>(at) >= static_cast<double>(size) ? "cut off, at byte" : "damaged, near byte",
                     static_cast<long long>(at), size);
}

void read_brep(const std::string& path, const std::string& file, Format format, Part& part) {
  TopoDS_Shape shape;
  send_progress("reading", "its shapes");
  std::ifstream in(path, std::ios::binary);
  // The library's reader does not look whether a word was read: of a file that is cut off it waits for the next section
  // for ever.
  in.exceptions(std::ios::failbit | std::ios::badbit);
  try {
    if (format == Format::kBinaryBrep)
      BinTools::Read(shape, in, progress_of("reading", "its shapes"));
    else
      BRepTools::Read(shape, in, BRep_Builder(), progress_of("reading", "its shapes"));
  } catch (const std::ios::failure&) {
    throw Refusal(fmt::format("{} cannot be read as BREP: {}", file, place_of_end(in, path)));
  }
  if (shape.IsNull()) throw Refusal(fmt::format("{} holds no shape", file));
  take_shape(shape, part);
}

}  // namespace

void lost(const std::string& sentence, bool keep_going) {
  if (!keep_going) throw Refusal(sentence + "; `keep_going` goes on without");
  send_note(sentence + "; went on without");
}

Part read_part(const Arguments& arguments) {
  const std::string& file = arguments.file;
  struct stat about {};
  if (stat(file.c_str(), &about) != 0)
    throw Refusal(fmt::format("{} cannot be opened: {}", file, std::strerror(errno)));
  if (!S_ISREG(about.st_mode)) throw Refusal(fmt::format("{} is no file", file));
  if (access(file.c_str(), R_OK) != 0)
    throw Refusal(fmt::format("{} cannot be opened: {}", file, std::strerror(errno)));
  send_progress("reading", "");
  const std::string path = unpacked(file, arguments.memory), head = beginning_of(path);
  if (head.empty()) throw Refusal(fmt::format("{} is empty", file));
  Part part;
  switch (const Format format = format_of(head, file)) {
    case Format::kStep:
      part.format = "STEP", read_step(path, file, arguments.keep_going, part);
      break;
    case Format::kIges:
      part.format = "IGES", read_iges(path, file, arguments.keep_going, part);
      break;
    case Format::kBrep:
    case Format::kBinaryBrep:
      part.format = "BREP", read_brep(path, file, format, part);
      break;
    case Format::kUnknown:
      throw Refusal(fmt::format("{} is no STEP, IGES or BREP file", file));
  }
  if (part.solids.empty() && part.loose.empty())
    throw Refusal(fmt::format("{} holds no solid and no face: curves and points alone bound nothing", file));
  number_names(part);
  return part;
}

}  // namespace octafront::cad
