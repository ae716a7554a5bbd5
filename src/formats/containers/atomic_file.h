#pragma once

#include <octafront/run_context.h>

#include "base/core/function_ref.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace octafront::io {

/// A file that appears under its name only when it is complete. It is written without a name where the file system can
/// do that (so that even a killed process leaves nothing), else under a temporary name beside the target; commit()
/// flushes it to the disk and renames it into place. Whatever goes wrong before, an older file stays as it was, and the
/// temporary one is removed. All members throw OutputError with the reason of the operating system, or Cancelled.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& target, const RunContext& context = {});
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* bytes, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Writes `count` records of `size` bytes each. form(begin, end, to) puts some of them at `to`; several threads do
  /// that at a time, while another one gives those that are ready to the system.
  void write_records(std::size_t count, std::size_t size,
                     FunctionRef<void(std::size_t begin, std::size_t end, char* to)> form);
  /// Where a library that makes files by itself writes this one instead of us; it is to replace what is there.
  std::filesystem::path path_for_library() const;
  /// Bytes written so far.
  std::uint64_t position() const { return flushed_ + filled_; }
  /// Forgets what was written from there on.
  void restart(std::uint64_t position);
  /// Replaces bytes written before.
  void overwrite(std::uint64_t position, const void* bytes, std::size_t size);
  /// Writes all to the disk; what can fail for lack of room has failed then.
  void flush_to_disk();
  void commit();

  /// As given, for messages.
  const std::string& name() const { return name_; }

 private:
  void open_named();
  void flush();
  void write_out(const char* bytes, std::size_t size);
  void give_name();  // where there are nameless files
  void copy_to_named();
  [[noreturn]] void fail(std::string_view what, int error) const;

  static constexpr std::size_t kBuffer = std::size_t{1} << 18;
  static constexpr std::size_t kBatch = std::size_t{1} << 20;  ///< of records, in bytes

  RunContext context_;
  std::string name_;
  std::filesystem::path target_;     ///< links followed
  std::filesystem::path temporary_;  ///< empty while the file has no name
  std::unique_ptr<char[]> buffer_{new char[kBuffer]};
  std::size_t filled_ = 0;
  std::uint64_t flushed_ = 0;
  unsigned mode_ = 0666;
  int fd_ = -1;
};

/// Where writing to `file` ends up: links are followed, also to what does not exist yet. Throws OutputError for links
/// in a circle.
std::filesystem::path links_followed(const std::filesystem::path& file);

/// A name in the folder of `target` that no other writer uses. What killed processes of this machine left there goes.
std::filesystem::path temporary_beside(const std::filesystem::path& target);

/// Throws OutputError if `target` cannot be a new file or replace an old one: folder missing or not writable, or the
/// name taken by something that is no file.
void check_writable(const std::filesystem::path& target);
/// The same for a folder that is written anew as a whole: what is there must be empty, or one of OpenFOAM's polyMesh.
void check_folder_writable(const std::filesystem::path& target);
/// The same for a folder of pieces: what is there must be files STEM_0000.EXTENSION and the like alone.
void check_folder_of_pieces(const std::filesystem::path& target, const std::string& stem, const std::string& extension);

}  // namespace octafront::io
