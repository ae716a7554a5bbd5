#include "formats/containers/atomic_file.h"

#include <octafront/error.h>
#include <octafront/io.h>

#include "formats/small_files.h"
#include "support/rich_mesh.h"

#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace octafront::io {
namespace {

namespace fs = std::filesystem;
using testing::file_bytes;
using testing::TemporaryFolder;

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

// Even a process that is killed meanwhile leaves nothing behind.
TEST(AtomicFile, ALibraryWritesItWithoutAName) {
  const testing::TemporaryFolder folder;
  io::AtomicFile file(folder / "a.med");
  std::ofstream(file.path_for_library()) << "by a library";
  const bool has_no_name = file.path_for_library().string().starts_with("/proc");
  EXPECT_EQ(std::filesystem::is_empty(folder.path()), has_no_name);
  file.commit();
  EXPECT_EQ(testing::file_bytes(folder / "a.med"), "by a library");
}

TEST(AtomicFile, AppearsOnlyWhenCommitted) {
  const TemporaryFolder folder;
  const auto target = folder / "a.txt";
  testing::write_bytes(target, "old");
  {
    AtomicFile file(target);
    file.write("new");
    EXPECT_EQ(file_bytes(target), "old");
  }
  EXPECT_EQ(file_bytes(target), "old");
  EXPECT_EQ(files_in(folder.path()), 1U);
  AtomicFile file(target);
  file.write("new");
  file.commit();
  EXPECT_EQ(file_bytes(target), "new");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

/// A name of a temporary file, of this process, as of another one.
fs::path as_of(const fs::path& temporary, pid_t process) {
  std::string name = temporary.string();
  const std::string ours = "-" + std::to_string(::getpid()) + "-";
  return name.replace(name.rfind(ours), ours.size(), "-" + std::to_string(process) + "-");
}

TEST(AtomicFile, WhatKilledProcessesLeftGoes) {
  const TemporaryFolder folder;
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  const fs::path mine = temporary_beside(folder / "a.txt");
  fs::create_directory(folder / "next");  // folders are looked at once
  const auto there = [&](const fs::path& name) { return folder / "next" / name.filename().string(); };
  for (const fs::path& file : {as_of(mine, child), as_of(mine, ::getppid()), mine}) fs::create_directory(there(file));
  testing::write_bytes(there(as_of(mine, child)) / "piece.vtu", "half");
  testing::write_bytes(there(".octafront-other-" + std::to_string(child) + "-0.tmp"), "of another machine");
  testing::write_bytes(there(".octafront-notes"), "the user's");
  temporary_beside(there("a.txt"));
  EXPECT_FALSE(fs::exists(there(as_of(mine, child))));
  EXPECT_EQ(files_in(folder / "next"), 4U);
}

TEST(AtomicFile, OverwritesWhatWasWritten) {
  const TemporaryFolder folder;
  const std::string large(1 << 20, 'x');
  AtomicFile file(folder / "a");
  file.write("0000");
  file.write(large);
  file.write("end");
  file.overwrite(1, "12", 2);
  EXPECT_EQ(file.position(), large.size() + 7);
  file.commit();
  EXPECT_EQ(file_bytes(folder / "a"), "0120" + large + "end");
}

TEST(AtomicFile, KeepsModeAndFollowsLinks) {
  const TemporaryFolder folder;
  testing::write_bytes(folder / "real", "old");
  ::chmod((folder / "real").c_str(), 0640);
  fs::create_symlink("real", folder / "link");
  AtomicFile file(folder / "link");
  file.write("new");
  file.commit();
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(file_bytes(folder / "real"), "new");
  EXPECT_EQ(static_cast<unsigned>(fs::status(folder / "real").permissions()), 0640U);
}

TEST(AtomicFile, GoesThroughLinksToWhatIsNotThereYet) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "sub");
  fs::create_symlink("sub/next", folder / "link");
  fs::create_symlink("real", folder / "sub/next");
  AtomicFile file(folder / "link");
  file.write("new");
  file.commit();
  EXPECT_TRUE(fs::is_symlink(folder / "link") && fs::is_symlink(folder / "sub/next"));
  EXPECT_EQ(file_bytes(folder / "sub/real"), "new");
}

TEST(SameFile, IsToldThroughLinksAndBeforeItIsThere) {
  const TemporaryFolder folder;
  testing::write_bytes(folder / "a", "a");
  testing::write_bytes(folder / "b", "a");
  fs::create_hard_link(folder / "a", folder / "hard");
  fs::create_symlink("a", folder / "soft");
  fs::create_symlink("later", folder / "lost");
  EXPECT_TRUE(same_file(folder / "a", folder / "hard"));
  EXPECT_TRUE(same_file(folder / "a", folder / "soft"));
  EXPECT_TRUE(same_file(folder / "a", folder / "./a"));
  EXPECT_TRUE(same_file(folder / "lost", folder / "later"));
  EXPECT_FALSE(same_file(folder / "a", folder / "b"));
  EXPECT_FALSE(same_file(folder / "a", folder / "later"));
}

std::string error_of(const std::function<void()>& write) {
  try {
    write();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

TEST(AtomicFile, SaysWhyItCannotWrite) {
  const TemporaryFolder folder;
  EXPECT_NE(error_of([&] { AtomicFile(folder / "none/a"); }).find("no folder"), std::string::npos);
  EXPECT_NE(error_of([&] { AtomicFile{folder.path()}; }).find("it is a folder"), std::string::npos);
  fs::create_symlink("none/a", folder / "lost");
  EXPECT_NE(error_of([&] { AtomicFile(folder / "lost"); }).find("no folder"), std::string::npos);
  fs::create_symlink("ring", folder / "ring");
  EXPECT_NE(error_of([&] { AtomicFile(folder / "ring"); }).find("in a circle"), std::string::npos);
  EXPECT_NE(error_of([&] { AtomicFile("/dev/null"); }).find("not a plain file"), std::string::npos);
  EXPECT_NE(error_of([&] { check_mesh_target(folder / "a.docx"); }).find(".vtu, .msh, .inp"), std::string::npos);
  EXPECT_NE(error_of([&] { check_surface_target(folder / "a"); }).find(".stl, .obj, .off, .ply"), std::string::npos);
}

/// Every file below a folder and what is in it.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) all[fs::relative(entry.path(), folder)] = file_bytes(entry.path());
  return all;
}

fs::path target_in(const TemporaryFolder& folder, const FormatInfo& info) {
  const std::string ending(info.endings.substr(0, info.endings.find(' ')));
  return folder / ("a" + (ending.empty() ? "." + std::string(info.name) : ending));
}

TEST(AllFormats, AFullDiskLeavesTheOldFiles) {
  const TetMesh mesh = testing::rich_mesh(4);
  std::signal(SIGXFSZ, SIG_IGN);
  for (const FormatInfo& info : known_formats()) {
    if (!info.writes_mesh) continue;
    SCOPED_TRACE(info.name);
    const TemporaryFolder folder;
    const std::string name(info.name);
    write_mesh(target_in(folder, info), testing::two_tets(), {}, {.format = name});
    const auto before = contents(folder.path());
    // A limit on the size of files fails like a full disk.
    rlimit limit{};
    getrlimit(RLIMIT_FSIZE, &limit);
    rlimit small = limit;
    small.rlim_cur = 1000;
    setrlimit(RLIMIT_FSIZE, &small);
    const std::string message = error_of([&] { write_mesh(target_in(folder, info), mesh, {}, {.format = name}); });
    setrlimit(RLIMIT_FSIZE, &limit);
    EXPECT_NE(message.find("unchanged"), std::string::npos) << message;
    EXPECT_EQ(contents(folder.path()), before);
  }
}

TEST(AllFormats, AnInterruptLeavesTheOldFiles) {
  const TetMesh mesh = testing::rich_mesh(2);
  const std::atomic<bool> cancel{true};
  RunContext context;
  context.cancel = &cancel;
  for (const FormatInfo& info : known_formats()) {
    if (!info.writes_mesh) continue;
    SCOPED_TRACE(info.name);
    const TemporaryFolder folder;
    const std::string name(info.name);
    write_mesh(target_in(folder, info), testing::two_tets(), {}, {.format = name});
    const auto before = contents(folder.path());
    EXPECT_THROW(write_mesh(target_in(folder, info), mesh, context, {.format = name}), Cancelled);
    EXPECT_EQ(contents(folder.path()), before);
  }
}

TEST(PolyMesh, ReplacesItsOwnFolderAndNoOther) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "polyMesh");
  testing::write_bytes(folder / "polyMesh/letters", "mine");
  EXPECT_NE(error_of([&] { write_mesh(folder / "polyMesh", testing::two_tets()); }).find("would be lost"),
            std::string::npos);
  EXPECT_EQ(file_bytes(folder / "polyMesh/letters"), "mine");
  fs::remove(folder / "polyMesh/letters");
  for (int i = 0; i < 2; ++i) write_mesh(folder / "polyMesh", testing::rich_mesh(2));
  EXPECT_EQ(files_in(folder.path()), 1U);
}

}  // namespace
}  // namespace octafront::io
