// JPEG, JPEG-LS and JPEG 2000 by GDCM (BSD), behind our own logic of series: a file becomes one without compression.

#include "images/files/dicom/unpack.h"

#include <sstream>

#include <gdcmImageChangeTransferSyntax.h>
#include <gdcmImageReader.h>
#include <gdcmImageWriter.h>
#include <gdcmTrace.h>

namespace octafront::image {

bool has_gdcm() {
  return true;
}

KeptFile unpacked(const KeptFile& file) {
  gdcm::Trace::WarningOff(), gdcm::Trace::ErrorOff();
  std::istringstream in{std::string(file.input.bytes)};
  gdcm::ImageReader reader;
  reader.SetStream(in);
  gdcm::ImageChangeTransferSyntax change;
  change.SetTransferSyntax(gdcm::TransferSyntax::ExplicitVRLittleEndian);
  bool is_done = false;
  std::ostringstream out;
  try {
    is_done = reader.Read();
    if (is_done) change.SetInput(reader.GetImage());
    is_done = is_done && change.Change();
    gdcm::ImageWriter writer;
    writer.SetStream(out);
    writer.SetFile(reader.GetFile());
    if (is_done) writer.SetImage(change.GetOutput());
    is_done = is_done && writer.Write();
  } catch (const std::exception&) {
    is_done = false;
  }
  if (!is_done) file.input.fail("its compressed pixels cannot be unpacked; the DICOM file is damaged, or has colours");
  auto bytes = std::make_shared<const std::string>(std::move(out).str());
  io::Input input = file.input;
  input.bytes = *bytes;
  return {input, bytes};
}

}  // namespace octafront::image
