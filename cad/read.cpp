#include "read.h"

#include "pipe.h"

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

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

namespace octafront::cad {

namespace {

enum class Format { kStep, kIges, kBrep, kBinaryBrep, kUnknown };

/// What the compressed file holds, in memory, under a path that is gone when the process is.
std::string inflated(const std::string& file, double most_bytes) {
  const int memory = memfd_create("octafront-cad", MFD_CLOEXEC);
  const gzFile in = gzopen(file.c_str(), "rb");
  if (memory < 0 || in == nullptr) throw Refusal(fmt::format("{} cannot be opened", file));
  char buffer[1 << 16];
  double total = 0;
  int n = 0;
  while ((n = gzread(in, buffer, sizeof buffer)) > 0) {
    total += n;
    if (most_bytes > 0 && total > most_bytes)
      throw Refusal(fmt::format("{} unpacks to more than the memory that it may take", file));
    for (int at = 0; at < n;) {
      const ssize_t written = write(memory, buffer + at, static_cast<std::size_t>(n - at));
      if (written <= 0) throw Refusal(fmt::format("{} cannot be unpacked: {}", file, std::strerror(errno)));
      at += static_cast<int>(written);
    }
  }
  const bool whole = n == 0 && gzclose(in) == Z_OK;
  if (!whole) throw Refusal(fmt::format("{} is damaged: it cannot be unpacked to its end", file));
  return fmt::format("/proc/self/fd/{}", memory);
}

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

void lost(const std::string& sentence, bool keep_going, Part& part) {
  if (!keep_going) throw Refusal(sentence + "; use --keep-going to go on without");
  part.notes.push_back(sentence + "; went on without");
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
  std::string path = file, head = beginning_of(file);
  if (head.starts_with("\x1f\x8b")) path = inflated(file, arguments.memory), head = beginning_of(path);
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
