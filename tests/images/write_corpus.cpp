// Writes the seeds of the fuzzer of images: write_image_corpus FOLDER. Files beside others follow four bytes 255.

#include "images/files/label_names.h"
#include "small_images.h"

#include <filesystem>
#include <fstream>

int main(int count, char** arguments) {
  using namespace octafront::testing;
  if (count != 2) return 2;
  const std::filesystem::path folder = arguments[1];
  std::filesystem::create_directories(folder);
  const auto write = [&](const std::string& name, const std::string& bytes) {
    std::ofstream(folder / name, std::ios::binary) << bytes;
  };
  for (const SmallImage& file : sheared_images()) {
    std::string bytes = file.bytes;
    for (const auto& [name, beside] : file.beside)
      if (bytes.size() == file.bytes.size()) bytes += "\xff\xff\xff\xff" + beside;
    write(file.name, bytes);
  }
  using Syntax = DicomSlice::Syntax;
  for (const auto& [syntax, name] : {std::pair{Syntax::kImplicit, "implicit"},
                                     {Syntax::kExplicit, "explicit"},
                                     {Syntax::kBigEndian, "big"},
                                     {Syntax::kRle, "rle"},
                                     {Syntax::kJpeg, "jpeg"}}) {
    DicomSlice slice = dicom_slice(0);
    slice.syntax = syntax;
    slice.thickness = 2;
    write(std::string(name) + ".dcm", slice.bytes());
    slice.with_preamble = false;
    write(std::string(name) + "_bare.dcm", slice.bytes());
  }
  write("names.txt", "# colours\n1 left lung 255 0 0 255\n3 liver 0 255 0 255\n");
  write("names.json", "{\"labels\": {\"left lung\": 1, \"liver\": 3}}");
  write("snap.txt", "    1   255    0    0        1  1  1    \"left lung\"\n");
}
