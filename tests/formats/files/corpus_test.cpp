// The seeds of the fuzzers, and what the fuzzers found: each file is read, or refused with an InputError.

#include <octafront/error.h>
#include <octafront/io.h>

#include <filesystem>

#include <gtest/gtest.h>

namespace octafront {
namespace {

namespace fs = std::filesystem;

template <class Read>
void expect_all_end(const char* kind, const Read& read) {
  int files = 0, refused = 0;
  for (const fs::directory_entry& file : fs::directory_iterator(fs::path(OCTAFRONT_CORPUS) / kind)) {
    SCOPED_TRACE(file.path().filename());
    ++files;
    try {
      read(file.path());
    } catch (const InputError&) {
      ++refused;
    }
  }
  // An empty corpus would test nothing; nor would readers that refuse all.
  EXPECT_GT(files, 5);
  EXPECT_LT(refused, files - 5);
}

TEST(Corpus, SurfacesAreReadOrRefused) {
  expect_all_end("surface", [](const fs::path& file) { read_surface(file); });
}

TEST(Corpus, MeshesAreReadOrRefused) {
  expect_all_end("mesh", [](const fs::path& file) { read_mesh(file); });
}

}  // namespace
}  // namespace octafront
